// sim/sonar_model.hpp: the model of a ring of sonars: one ping after the other, each the nearest
// echo in its cone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algo/hull.hpp"
#include "sim/random.hpp"
#include "sim/sensor.hpp"
#include "sim/space_pose.hpp"

namespace sim {

/// Axis of sonar `k` of the ring [rad, in R], spaced evenly over its field. A whole turn: from
/// straight ahead leftwards, without its end. Part of a turn: from its right to its left border.
double axis(const SonarConfig& config, std::uint32_t k);

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const SonarConfig& config);

/// Sensor k pings at (k + count n) x ping [s, run clock], n = 0, 1, ...: never two at once, so that
/// none hears another's echo. An echo comes from the nearest surface in the cone that is not too
/// oblique; without one the reading is Free (sensors.md 3).
///
/// With config.crosstalk, a sensor takes the ping before for its own while that one's sound is
/// still on its way, if the two look in nearly the same direction. The obstacle then seems nearer,
/// by half the way of the sound from one ping to the next.
class SonarModel final : public CastingSensor {
 public:
  /// Mounted on the outline of `hull`. Throws std::invalid_argument with the defect.
  SonarModel(const SonarConfig& config, const algo::Hull& hull, std::uint64_t seed);

  void sense(const Surroundings& around, algo::Observation& observation) override {
    sense(around.stamp, around.trail, observation.sonar, around.solids);
  }
  double memory() const override { return (config_.crosstalk ? 2 : 1) * config_.ping; }

  /// Appends the readings of all pings up to `now` [s, run clock] that were not reported before,
  /// oldest first. With `solids`, the ground is not level, and the cone tilts with the robot.
  void sense(double now,
             const PoseTrail& trail,
             algo::Recycled<algo::RangeReading>& readings,
             const SolidCaster* solids = nullptr);

 private:
  const algo::Pose2& mount_of(std::uint64_t ping) const;
  std::optional<double> echo_at(double fired,
                                const algo::Pose2& mount_R,
                                double beyond,
                                const PoseTrail& trail,
                                const SolidCaster* solids);
  std::optional<double> nearest_echo(const algo::Pose2& sensor_W, double beyond);
  std::optional<double> nearest_echo(const SpacePose& sensor,
                                     double beyond,
                                     const SolidCaster& solids) const;
  std::optional<double> late_echo(const PoseTrail& trail, const SolidCaster* solids);

  SonarConfig config_{};
  BeamPattern cone_{};
  Random noise_;
  std::vector<algo::Pose2> mounts_R_{};
  std::uint64_t pings_ = 0;  // number reported
  std::vector<double> ranges_{};
  std::vector<std::uint32_t> hits_{};
};

}  // namespace sim
