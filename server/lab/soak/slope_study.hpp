// server/lab/soak/slope_study.hpp: `tautline soak --slopes`: whether a robot with a high centre of
// mass stays on its tracks under a driver at full stick, with its turnover guard and without.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/request.hpp"
#include "server/experiment/pool.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/soak/slope_world.hpp"
#include "sim/random.hpp"

namespace server::soak {

/// [rad] A world with less between its steepest slope and the standing limit is not counted against
/// the guard.
inline constexpr double kSlopeMargin = 3 * 0.017453292519943295;

struct SlopeOptions {
  std::uint64_t worlds = 200;
  std::uint64_t first_seed = 1;
  double seconds = 30;  // of each drive
  experiment::PoolOptions pool{};
};

/// One drive.
struct SlopeDrive {
  double seconds = 0;   // until it ended or the robot turned over
  double way = 0;       // [m] driven, by the true pose
  double steepest = 0;  // [rad] the true roll or pitch it had while it stood on its tracks
  bool overturned = false;
  std::uint64_t hash = 0;  // of every true pose and attitude
};

struct SlopeRow {
  std::uint64_t seed = 0;
  SlopeKind kind = SlopeKind::Slope;
  double slope = 0;  // [rad]
  double friction = 0;
  double mass_height = 0;  // [m] true
  double margin = 0;       // [rad]
  SlopeDrive guarded{};
  SlopeDrive unguarded{};
  bool counts() const { return margin > kSlopeMargin; }
};

/// A driver who always gives full stick: straight, in a curve or on the spot, mostly ahead.
class FullStick {
 public:
  explicit FullStick(std::uint64_t seed);
  algo::Joystick at(double stamp);

 private:
  sim::Random random_;
  algo::Joystick stick_{.mode = algo::StickMode::Raw};
  double until_ = 0;  // [s] run clock
};

/// Drives `world` for `seconds`. Senses by the robot's own line camera and inclinometer.
SlopeDrive drive_on_slopes(const SlopeWorld& world,
                           std::uint64_t seed,
                           double seconds,
                           bool with_guard);

/// The same options give the same rows with any number of threads.
std::vector<SlopeRow> run_slopes(const SlopeOptions& options);

/// The worlds that count, those that do not, and all, by kind.
experiment::Table slopes_table(const std::vector<SlopeRow>& rows);
experiment::Table slope_rows(const std::vector<SlopeRow>& rows);

/// Drives that count and turned over in spite of the guard.
int turned_over(const std::vector<SlopeRow>& rows);
/// The way driven with the guard as a share of that without, where the latter stays upright.
double way_share(const std::vector<SlopeRow>& rows);

}  // namespace server::soak
