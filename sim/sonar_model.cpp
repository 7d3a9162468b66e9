// sim/sonar_model.cpp: pings, cones and echoes.
#include "sim/sonar_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace sim {
namespace {

constexpr std::uint64_t kSonarPurpose = 0x534f4e4152;  // of its noise: unlike any scanner's
constexpr std::size_t kRays = 31;                      // per cone
constexpr double kRounding = 1e-9;                     // [rad] error of degrees to radians and back
constexpr double kSonarOnTime = 1e-9;                  // [s] below any period, above rounding

constexpr double kSound = 343;  // [m/s] in air

}  // namespace

double axis(const SonarConfig& config, std::uint32_t k) {
  const double turn = 2 * std::numbers::pi;
  if (config.field >= turn - kRounding) return algo::wrap_angle(turn * k / config.count);
  if (config.count == 1) return 0;
  return -config.field / 2 + config.field * k / (config.count - 1);
}

std::optional<std::string> defect(const SonarConfig& config) {
  if (config.count < 1 || config.count > 64) return "count must be 1 to 64";
  if (!within(config.field, 0, 2 * std::numbers::pi + kRounding))
    return "field must be 0 to 360 degrees";
  if (!within(config.cone, 0.01, std::numbers::pi / 2)) return "cone must be 0.6 to 90 degrees";
  if (!within(config.ping, 1e-3, 1)) return "ping must be 0.001 to 1 s";
  if (!within(config.range_min, 0, config.range_max)) return "range_min must be 0 to range_max";
  if (!within(config.range_max, 0.1, 20)) return "range_max must be 0.1 to 20 m";
  if (!within(config.noise, 0, 1)) return "noise must be 0 to 1 m";
  if (!within(config.incidence, 0, std::numbers::pi / 2))
    return "incidence must be 0 to 90 degrees";
  if (!within(config.height, 0, 5)) return "height must be 0 to 5 m";
  return std::nullopt;
}

SonarModel::SonarModel(const SonarConfig& config, const algo::Hull& hull, std::uint64_t seed)
    : CastingSensor(config.height),
      config_(checked(config, "Sonar")),
      cone_{-config.cone / 2, config.cone / (kRays - 1), kRays},
      noise_(seed, kSonarPurpose),
      ranges_(kRays),
      hits_(kRays) {
  for (std::uint32_t k = 0; k < config_.count; ++k) {
    const double heading = axis(config_, k);
    const algo::Vec2 place = algo::outline_at(hull, heading) * algo::direction(heading);
    mounts_R_.push_back({place.x(), place.y(), heading});
  }
}

const algo::Pose2& SonarModel::mount_of(std::uint64_t ping) const {
  return mounts_R_[ping % mounts_R_.size()];
}

/// [m] Distance of the nearest surface in the cone, farther than `beyond` [m], that is not more
/// oblique than config_.incidence.
std::optional<double> SonarModel::nearest_echo(const algo::Pose2& sensor_W, double beyond) {
  caster().cast(sensor_W, cone_, config_.range_max, ranges_, hits_);
  const double least_cosine = std::cos(config_.incidence) - 1e-9;
  std::optional<double> nearest;
  for (std::size_t i = 0; i < kRays; ++i) {
    if (hits_[i] == RangeCaster::kNothing || (nearest && ranges_[i] >= *nearest)) continue;
    if (ranges_[i] < beyond) continue;
    const double right = sensor_W.heading + cone_.angle_min;
    const algo::Vec2 ray = algo::direction(right + static_cast<double>(i) * cone_.angle_increment);
    const algo::Vec2 normal = caster().normal_W(hits_[i], sensor_W.position() + ranges_[i] * ray);
    if (-ray.dot(normal) >= least_cosine) nearest = ranges_[i];
  }
  return nearest;
}

/// The same in space. The fan of rays lies in the ring's plane, as if it were level.
std::optional<double> SonarModel::nearest_echo(const SpacePose& sensor,
                                               double beyond,
                                               const SolidCaster& solids) const {
  const double least_cosine = std::cos(config_.incidence) - 1e-9;
  std::optional<double> nearest;
  for (std::size_t i = 0; i < kRays; ++i) {
    const algo::Vec3 way_W = beam_W(sensor, cone_.angle(i));
    const auto hit = solids.cast(sensor.origin_W, way_W, nearest.value_or(config_.range_max));
    if (!hit || hit->range < beyond) continue;
    if (-way_W.dot(hit->normal_W) >= least_cosine) nearest = hit->range;
  }
  return nearest;
}

/// The echo of the ping that the sensor at `mount_R` fired at `fired` [s].
std::optional<double> SonarModel::echo_at(double fired,
                                          const algo::Pose2& mount_R,
                                          double beyond,
                                          const PoseTrail& trail,
                                          const SolidCaster* solids) {
  const algo::Pose2 robot_W = trail.at(fired);
  if (solids == nullptr) return nearest_echo(algo::compose(robot_W, mount_R), beyond);
  const SpacePose robot = space_pose(robot_W, trail.tilt_at(fired));
  return nearest_echo(mounted(robot, mount_R, config_.height), beyond, *solids);
}

/// [m] Distance that the next ping's sensor takes the echo of the ping before for.
std::optional<double> SonarModel::late_echo(const PoseTrail& trail, const SolidCaster* solids) {
  if (!config_.crosstalk || pings_ == 0 || mounts_R_.size() == 1) return std::nullopt;
  const algo::Pose2& before = mount_of(pings_ - 1);
  const double apart = algo::wrap_angle(mount_of(pings_).heading - before.heading);
  if (std::abs(apart) > config_.cone) return std::nullopt;
  const double head_start = kSound * config_.ping / 2;
  if (head_start + config_.range_min >= config_.range_max) return std::nullopt;
  const double fired = static_cast<double>(pings_ - 1) * config_.ping;
  const auto echo = echo_at(fired, before, head_start + config_.range_min, trail, solids);
  if (!echo) return std::nullopt;
  return *echo - head_start;
}

void SonarModel::sense(double now,
                       const PoseTrail& trail,
                       algo::Recycled<algo::RangeReading>& readings,
                       const SolidCaster* solids) {
  for (;; ++pings_) {
    const double fired = static_cast<double>(pings_) * config_.ping;
    if (fired > now + kSonarOnTime) return;
    const algo::Pose2& mount = mount_of(pings_);
    auto echo = echo_at(fired, mount, 0, trail, solids);
    const auto late = late_echo(trail, solids);
    if (late && (!echo || *late < *echo)) echo = late;
    double error = 0;
    noise_.fill_normal(std::span(&error, 1));
    algo::RangeReading& reading = readings.append();
    reading = {mount, fired, config_.range_max, config_.range_max, algo::Beam::Free};
    if (echo) measure(reading, std::max(config_.range_min, *echo + config_.noise * error));
  }
}

}  // namespace sim
