// sim/sonar_model.hpp: what a ring of sonars reports of a world: one ping after the other, each the
// nearest echo of its cone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// What is wrong with the configuration as a sentence part, or nothing.
std::optional<std::string> defect(const SonarConfig& config);

/// Sensor k pings at (k + count n) x ping [s, run clock], n = 0, 1, ...: no two at once, so that no
/// one hears another's echo. An echo comes from the nearest surface of the cone that is not met too
/// obliquely; without one the reading is Free (sensors.md 3).
class SonarModel final : public CastingSensor {
 public:
  /// Mounted on a hull of `radius` [m]. Throws std::invalid_argument with the defect.
  SonarModel(const SonarConfig& config, double radius, std::uint64_t seed);

  void sense(const Surroundings& around, algo::Observation& observation) override {
    sense(around.stamp, around.trail, observation.sonar);
  }
  double memory() const override { return config_.ping; }

  /// Appends the readings of all pings up to `now` [s, run clock] that were not reported before,
  /// the oldest first.
  void sense(double now, const PoseTrail& trail, algo::Recycled<algo::RangeReading>& readings);

 private:
  std::optional<double> nearest_echo(const algo::Pose2& sensor_W);

  SonarConfig config_{};
  BeamPattern cone_{};
  Random noise_;
  std::vector<algo::Pose2> mounts_R_{};
  std::uint64_t pings_ = 0;  // reported
  std::vector<double> ranges_{};
  std::vector<std::uint32_t> hits_{};
};

}  // namespace sim
