// algo/metrics.cpp: the metrics of one run.
#include "algo/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/driving.hpp"

namespace algo {
namespace {

constexpr double kResample = 0.050;    // [m] between kept positions
constexpr double kViaSpacing = 0.500;  // [m] of the pass point, per axis

// In the order of their enumerators.
constexpr std::array<std::string_view, 10> kOutcomes{"running",
                                                     "reached",
                                                     "stuck",
                                                     "out_of_time",
                                                     "collided",
                                                     "stopped",
                                                     "end_of_log",
                                                     "failed",
                                                     "overturned",
                                                     "fallen"};
static_assert(kOutcomes.size() == static_cast<std::size_t>(Outcome::Fallen) + 1);

}  // namespace

std::string_view name(Outcome outcome) {
  return kOutcomes[static_cast<std::size_t>(outcome)];
}

std::optional<ResampledPath::Bend> ResampledPath::add(const Vec2& position_W) {
  if (!kept_W_) {
    kept_W_ = position_W;
    return std::nullopt;
  }
  const Vec2 segment = position_W - *kept_W_;
  const double length = segment.norm();
  if (length < kResample) return std::nullopt;
  const double direction = std::atan2(segment.y(), segment.x());
  std::optional<Bend> bend;
  if (direction_) bend = Bend{wrap_angle(direction - *direction_), length};
  direction_ = direction;
  kept_W_ = position_W;
  return bend;
}

void MetricsRecorder::reset(const RobotSpec& spec) {
  *this = {};
  radius_ = spec.radius;
  period_ = spec.period;
}

void MetricsRecorder::add(const Telemetry& t, const Parameters& parameters) {
  if (!first_stamp_) first_stamp_ = t.observation.stamp;
  ++metrics_.ticks;
  metrics_.time = t.observation.stamp - *first_stamp_;

  const Pose2& pose = t.ground_truth ? t.ground_truth->pose : t.observation.odometry.pose;
  const double distance =
      t.ground_truth ? t.ground_truth->obstacle_distance : t.clearance + radius_;
  const double d_safe = parameters[kSafetyDistance];
  const double clearance = t.ground_truth ? t.ground_truth->clearance : t.clearance;
  metrics_.min_clearance = std::min(metrics_.min_clearance, clearance);
  metrics_.intrusion = std::max(metrics_.intrusion, d_safe - distance);
  // A tick is the time since the previous one; the first has no duration.
  if (distance < d_safe && metrics_.ticks > 1) metrics_.infringed_time += period_;
  if (t.ground_truth && t.ground_truth->collided) metrics_.collided = true;

  follow_path(pose.position());
  count_via(t, d_safe + radius_);
}

void MetricsRecorder::follow_path(const Vec2& position_W) {
  if (last_W_) metrics_.path_length += (position_W - *last_W_).norm();
  last_W_ = position_W;
  if (const auto bend = path_.add(position_W)) metrics_.turning += std::abs(bend->change);
}

void MetricsRecorder::count_via(const Telemetry& t, double influence) {
  const double left = t.scene.left ? t.scene.left->distance : influence;
  const double right = t.scene.right ? t.scene.right->distance : influence;
  const std::optional<Vec2>& pass_W = t.output.pass_W;
  if (!pass_W || !t.output.measure("strip.length") || std::min(left, right) >= influence) return;
  if (counted_pass_W_) {
    const Vec2 step = *pass_W - *counted_pass_W_;
    if (step.cwiseAbs().maxCoeff() < kViaSpacing) return;
  }
  counted_pass_W_ = pass_W;
  ++metrics_.via_points;
}

}  // namespace algo
