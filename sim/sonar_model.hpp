// sim/sonar_model.hpp: the model of a ring of sonars: one ping after the other, each the nearest
// echo in its cone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const SonarConfig& config);

/// Sensor k pings at (k + count n) x ping [s, run clock], n = 0, 1, ...: never two at once, so that
/// none hears another's echo. An echo comes from the nearest surface in the cone that is not too
/// oblique; without one the reading is Free (sensors.md 3).
class SonarModel final : public CastingSensor {
 public:
  /// Mounted on a hull of `radius` [m]. Throws std::invalid_argument with the defect.
  SonarModel(const SonarConfig& config, double radius, std::uint64_t seed);

  void sense(const Surroundings& around, algo::Observation& observation) override {
    sense(around.stamp, around.trail, observation.sonar);
  }
  double memory() const override { return config_.ping; }

  /// Appends the readings of all pings up to `now` [s, run clock] that were not reported before,
  /// oldest first.
  void sense(double now, const PoseTrail& trail, algo::Recycled<algo::RangeReading>& readings);

 private:
  std::optional<double> nearest_echo(const algo::Pose2& sensor_W);

  SonarConfig config_{};
  BeamPattern cone_{};
  Random noise_;
  std::vector<algo::Pose2> mounts_R_{};
  std::uint64_t pings_ = 0;  // number reported
  std::vector<double> ranges_{};
  std::vector<std::uint32_t> hits_{};
};

}  // namespace sim
