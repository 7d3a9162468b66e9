// sim/drive_errors.cpp: delayed commands, and pose increments with scale errors, slip and noise.
#include "sim/drive_errors.hpp"

#include <array>
#include <cmath>

namespace sim {
namespace {

enum class Purpose : std::uint64_t { Scale = 0x0d01, Noise };  // distinct from the scanners'

Random stream(std::uint64_t seed, Purpose purpose) {
  return Random(seed, static_cast<std::uint64_t>(purpose));
}

}  // namespace

std::optional<std::string> defect(const DriveConfig& config) {
  const auto good = [](const std::optional<double>& limit) {
    return !limit || (std::isfinite(*limit) && *limit > 0);
  };
  if (!good(config.max_v) || !good(config.max_omega) || !good(config.max_acceleration) ||
      !good(config.max_angular_acceleration)) {
    return "limits must be above 0";
  }
  if (config.delay_ticks > 100) return "delay_ticks must be 0 to 100";
  if (!(config.yaw_slip >= 0 && config.yaw_slip < 1)) return "yaw_slip must be 0 to below 1";
  if (!(config.odometry_slip >= 0 && config.odometry_slip < 1)) {
    return "odometry_slip must be 0 to below 1";
  }
  if (!(std::abs(config.odometry_scale) < 1)) return "odometry_scale must be within -1 and 1";
  if (!(config.odometry_noise >= 0 && config.odometry_noise < 1)) {
    return "odometry_noise must be 0 to below 1";
  }
  return std::nullopt;
}

DriveErrors::DriveErrors(const DriveConfig& config, std::uint64_t seed)
    : config_(config), noise_(stream(seed, Purpose::Noise)), under_way_(config.delay_ticks) {
  Random scale = stream(seed, Purpose::Scale);
  distance_scale_ = 1 + (scale.uniform() < 0.5 ? -1 : 1) * config.odometry_scale;
  angle_scale_ = 1 + (scale.uniform() < 0.5 ? -1 : 1) * config.odometry_scale;
}

void DriveErrors::reset(const algo::Pose2& start_W) {
  under_way_.assign(config_.delay_ticks, {});
  next_ = 0;
  sound_W_ = start_W;
  reported_W_ = start_W;
}

algo::Twist2 DriveErrors::act(const algo::Twist2& command) {
  algo::Twist2 acting = command;
  if (!under_way_.empty()) {
    std::swap(acting, under_way_[next_]);
    next_ = (next_ + 1) % under_way_.size();
  }
  if (config_.yaw_slip > 0) acting.omega *= 1 - config_.yaw_slip;
  return acting;
}

algo::Odometry DriveErrors::report(const algo::Odometry& sound) {
  const bool drifts =
      config_.odometry_scale != 0 || config_.odometry_noise != 0 || config_.odometry_slip != 0;
  if (!drifts) return sound;
  const algo::Pose2 step = algo::pose_step(sound_W_, sound.pose);
  algo::Vec2 way = step.position();
  // The encoders count slipped turns like all others.
  const double counted = 1 / (1 - config_.odometry_slip);
  double turn = step.heading * counted;
  std::array<double, 2> draws{};
  if (config_.odometry_noise > 0) noise_.fill_normal(draws);
  // Noise of a random walk: its variance, not its deviation, grows with the distance.
  const double length = way.norm();
  way *= distance_scale_;
  if (length > 0) way += way / length * std::sqrt(length) * config_.odometry_noise * draws[0];
  turn = turn * angle_scale_ + std::sqrt(std::abs(turn)) * config_.odometry_noise * draws[1];

  reported_W_ = algo::compose(reported_W_, {way.x(), way.y(), turn});
  sound_W_ = sound.pose;
  algo::Odometry out = sound;
  out.pose = reported_W_;
  out.twist = {sound.twist.v * distance_scale_, sound.twist.omega * counted * angle_scale_};
  return out;
}

std::vector<algo::Pose2> reported_path(std::span<const algo::Pose2> path_W,
                                       const DriveConfig& config,
                                       std::uint64_t seed) {
  std::vector<algo::Pose2> reported_W;
  if (path_W.empty()) return reported_W;
  DriveErrors errors(config, seed);
  errors.reset(path_W.front());
  reported_W.reserve(path_W.size());
  for (const algo::Pose2& pose_W : path_W) {
    reported_W.push_back(errors.report({.pose = pose_W}).pose);
  }
  return reported_W;
}

}  // namespace sim
