// sim/infrared_model.cpp: a fan of beams, one scan at a time.
#include "sim/infrared_model.hpp"

#include <algorithm>
#include <cmath>

#include "sim/space_pose.hpp"

namespace sim {
namespace {

constexpr std::uint64_t kInfraredPurpose = 0x4952;  // of its noise: unlike any other sensor's
constexpr double kInfraredOnTime = 1e-9;            // [s] below any period, above rounding
constexpr std::uint32_t kMostBeams = 361;

BeamPattern fan_of(const InfraredConfig& config) {
  if (config.beams == 1) return {0, config.field, 1};
  return {-config.field / 2, config.field / (config.beams - 1), config.beams};
}

}  // namespace

std::optional<std::string> defect(const InfraredConfig& config) {
  if (!finite(config.mount_R)) return "mount must be finite numbers";
  if (config.beams < 1 || config.beams > kMostBeams) return "beams must be 1 to 361";
  if (!within(config.field, 0.001, 6.2832)) return "field must be above 0 to 360 degrees";
  if (!within(config.period, 1e-3, 1)) return "period must be 0.001 to 1 s";
  if (!within(config.range_max, 0.1, 20)) return "range_max must be 0.1 to 20 m";
  if (!within(config.range_min, 0, config.range_max)) return "range_min must be 0 to range_max";
  if (!within(config.noise, 0, 1)) return "noise must be 0 to 1 m";
  if (!within(config.height, 0, 5)) return "height must be 0 to 5 m";
  return std::nullopt;
}

InfraredModel::InfraredModel(const InfraredConfig& config, std::uint64_t seed, std::uint32_t index)
    : CastingSensor(config.height),
      config_(checked(config, "Infrared scanner")),
      fan_(fan_of(config)),
      noise_(seed, (kInfraredPurpose << 8U) + index),
      ranges_(config.beams),
      hits_(config.beams),
      errors_(config.beams) {
  phase_ = noise_.uniform(0, config_.period);
  for (std::size_t i = 0; i < fan_.beams; ++i) {
    const algo::Pose2& mount = config_.mount_R;
    mounts_R_.push_back({mount.x, mount.y, algo::wrap_angle(mount.heading + fan_.angle(i))});
  }
}

void InfraredModel::cast_in_space(double stamp, const PoseTrail& trail, const SolidCaster& solids) {
  const SpacePose robot = space_pose(trail.at(stamp), trail.tilt_at(stamp));
  const SpacePose sensor = mounted(robot, config_.mount_R, config_.height);
  for (std::size_t i = 0; i < fan_.beams; ++i) {
    const auto hit = solids.cast(sensor.origin_W, beam_W(sensor, fan_.angle(i)), config_.range_max);
    hits_[i] = hit ? 0 : RangeCaster::kNothing;
    ranges_[i] = hit ? hit->range : config_.range_max;
  }
}

void InfraredModel::sense(double now,
                          const PoseTrail& trail,
                          algo::Recycled<algo::RangeReading>& readings,
                          const SolidCaster* solids) {
  const double taken = std::floor((now - phase_ + kInfraredOnTime) / config_.period) + 1;
  const auto scans = static_cast<std::int64_t>(std::max(0.0, taken));
  if (scans <= scans_) return;
  scans_ = scans;
  const double stamp = phase_ + static_cast<double>(scans - 1) * config_.period;
  if (solids != nullptr) {
    cast_in_space(stamp, trail, *solids);
  } else {
    const algo::Pose2 sensor_W = algo::compose(trail.at(stamp), config_.mount_R);
    caster().cast(sensor_W, fan_, config_.range_max, ranges_, hits_);
  }
  noise_.fill_normal(errors_);
  for (std::size_t i = 0; i < fan_.beams; ++i) {
    algo::RangeReading& reading = readings.append();
    reading = {mounts_R_[i], stamp, config_.range_max, config_.range_max, algo::Beam::Free};
    if (hits_[i] == RangeCaster::kNothing) continue;
    measure(reading, std::max(config_.range_min, ranges_[i] + config_.noise * errors_[i]));
  }
}

}  // namespace sim
