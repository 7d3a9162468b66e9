// algo/pipeline/turnover_guard.hpp: keeps a robot with a high centre of mass on its tracks, under
// every driver.
//
// Source: Park et al. 2005, section 2.2; equations.md G. Ours: the rule along the track, the limit
// on backing, and the room for a centre of mass that is higher than the robot's file says.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "algo/gate.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/teleop/reflected_force.hpp"
#include "algo/terrain/tilt_prediction.hpp"
#include "algo/terrain/tilt_trend.hpp"
#include "algo/terrain/turnover.hpp"

namespace algo {

inline constexpr ParameterInfo kTurnoverShare{
    .name = "turnover.share",
    .label = "Share of the turnover bound",
    .min = 0.1,
    .max = 1.0,
    .step = 0.05,
    .initial = 0.9,
    .help =
        "The robot uses this share of the turn rate and of the braking that would lift a track."};
inline constexpr ParameterInfo kTurnoverPreview{
    .name = "turnover.preview",
    .label = "Turnover preview",
    .unit = "m",
    .min = 0.1,
    .max = 2.0,
    .step = 0.05,
    .initial = 0.5,
    .help = "The robot already drives as the ground this far ahead of its centre demands: D_tp."};
inline constexpr ParameterInfo kMassMargin{
    .name = "turnover.mass_margin",
    .label = "Room for a higher mass",
    .max = 0.5,
    .step = 0.05,
    .initial = 0.1,
    .help = "The centre of mass may be higher than the robot's file says by this share."};
/// The guard's parameters.
inline constexpr auto kTurnoverParameters = std::to_array<const ParameterInfo*>(
    {&kTurnoverShare, &kTurnoverPreview, &kMassMargin, &kTiltTimeout});

namespace limits {

inline constexpr Limit kTurnover{"turnover", "On this slope it would turn over in a faster turn."};
inline constexpr Limit kTooSteepAhead{"turnover_ahead",
                                      "The ground ahead is too steep to stand on."};
inline constexpr Limit kTooSteepHere{
    "turnover_here", "It may turn over where it stands: back away slowly, or turn on the spot."};
inline constexpr Limit kBlindBack{
    "turnover_back", "Nothing looks at the ground behind: so tall a robot backs slowly."};

}  // namespace limits

/// Sets limits for every behaviour and never drives. For a robot with RobotSpec::stance. Reads the
/// inclinometer and, where there is one, the laser line's camera. The turn rate stays within Eq. 26
/// for the measured attitude, the one that its trend leads to, and every predicted one up to D_tp
/// ahead. Where the robot could not even stand, its speed is zero: it may only back away slowly,
/// and turn, but not uphill while it still moves.
class TurnoverGuard final : public Behaviour {
 public:
  static constexpr double kRetreat = 0.1;    // [m/s] backwards, off ground that is too steep
  static constexpr double kBlindBack = 0.2;  // [m/s] backwards by a stick without a guard

  explicit TurnoverGuard(const RobotSpec& spec);
  Name name() const override { return "turnover"; }
  void reset(const Pose2& start_W) override;
  /// Never active; its limits are those of this tick.
  Proposal propose(const Resource& in, ControlOutput& output) override;

  /// The robot's spec, with the acceleration that this slope allows: for planning a brake.
  const RobotSpec& spec() const { return spec_; }
  /// [m/s] The speed to command in this tick, towards `wanted` no faster than the slope allows. A
  /// brake begins at the real speed where the robot has not reached the commanded one.
  double eased(double wanted, const Odometry& odometry);
  /// Adds the laser's line and the measures of this tick to `t`.
  void show(Telemetry& t) const;

 private:
  void sense(const Resource& in);
  void take_line(const LineImage& image);
  void bound(const Resource& in);
  void narrow(const TurnRange& range, double v);
  void reflect(const Resource& in);
  TurnRange turns(const Attitude& attitude, double v, double share) const;
  TurnRange turns_uphill(const Attitude& attitude, double v, double share) const;
  Proposal limits_of_tick(const Resource& in) const;

  RobotSpec spec_{};
  double max_acceleration_ = 0;  // [m/s2] of the robot itself
  TiltPrediction prediction_;
  std::vector<Vec3> line_R_{};  // of the newest image
  std::vector<Vec3> line_W_{};  // the same, for the page
  Attitude measured_{};
  TiltTrend trend_{};
  double sent_ = 0;  // [m/s] the speed last commanded

  // Of this tick.
  Stance stance_{};       // with room for a higher centre of mass
  TurnRange turn_{};      // for all attitudes up to D_tp ahead
  ForceBand band_{};      // of the stick's turn, Eq. 28, 29
  double force_ = 0;      // about X, in stick units
  Attitude predicted_{};  // at D_tp
  double margin_ = 0;     // [rad] the least one
  double along_ = 0;      // [m/s2]
  bool here_ = true;      // it can stand here
  bool ahead_ = true;     // and ahead
};

}  // namespace algo
