// server/emulate/mirror.cpp: laser models for each variant and each part of an interlaced scan.
#include "server/emulate/mirror.hpp"

#include <algorithm>
#include <cmath>

#include "algo/units.hpp"
#include "sim/obstacle_set.hpp"

namespace server::emulate {
namespace {

using algo::units::kRadiansPerDegree;
/// [m] The largest distance of a packed beam. The device applies the limit of its measuring mode.
constexpr double kFarthest = 65.5;

}  // namespace

Mirror::Mirror(const sim::Scenario& scenario, std::uint64_t seed, std::uint32_t index)
    : scenario_(scenario), seed_(seed), index_(index) {}

double Mirror::memory() {
  constexpr double kSweep = 4.0 / 75;  // [s] the longest
  return 2 * kSweep;
}

/// [rad] From the middle of a scan to the middle of a part: all parts but the first lack one beam.
double Mirror::offset(std::uint8_t part) {
  return part == 0 ? 0 : (part * 0.25 - 0.5) * kRadiansPerDegree;
}

std::uint64_t Mirror::turn_of(const algo::LaserScan& scan) const {
  constexpr double kRounding = 1e-6;
  const double period = scenario_.robot.sensors.lasers[index_].mirror_period;
  return static_cast<std::uint64_t>(scan.stamp / period + kRounding);
}

sim::LaserConfig Mirror::config_for(const drivers::lms200::Variant& variant,
                                    std::optional<std::uint8_t> part) const {
  sim::LaserConfig config = scenario_.robot.sensors.lasers[index_];
  config.rolling = true;
  config.range_max = kFarthest;
  config.field_of_view = variant.angle_degrees * kRadiansPerDegree;
  config.angle_increment = variant.step_centidegrees / 100.0 * kRadiansPerDegree;
  config.turns = variant.turns();
  if (part) {
    config.turns = 1;
    config.angle_increment = kRadiansPerDegree;
    if (*part > 0) config.field_of_view -= kRadiansPerDegree;
    config.mount_R.heading += offset(*part);
  }
  return config;
}

void Mirror::follow(const drivers::lms200::Sweep& sweep, double now) {
  if (models_.empty() || sweep != sweep_) {
    sweep_ = sweep;
    models_.clear();
    if (sweep.parts.empty()) {
      models_.emplace_back(config_for(sweep.variant, {}), seed_, index_);
    }
    for (const std::uint8_t part : sweep.parts) {
      models_.emplace_back(config_for(sweep.variant, part), seed_, index_);
    }
    for (sim::LaserModel& model : models_) {
      for (const algo::Obstacle& obstacle : scenario_.obstacles) model.add(obstacle);
    }
  }
  for (const algo::Obstacle& obstacle : scenario_.obstacles) {
    if (!obstacle.path) continue;
    const algo::Pose2 pose_W = sim::pose_at(obstacle, now);
    for (sim::LaserModel& model : models_) model.move(obstacle.id, pose_W);
  }
}

}  // namespace server::emulate
