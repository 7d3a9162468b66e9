// algo/elastic_strip_controller.cpp: one tick of the strip.
#include "algo/elastic_strip_controller.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kHeadingReach = 0.05;  // [rad] a wanted heading counts as reached within this

bool finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading);
}

bool finite(const std::optional<Nearest>& nearest) {
  return !nearest || (nearest->point_W.allFinite() && std::isfinite(nearest->distance));
}

bool finite(const LaserScan& scan) {
  if (!finite(scan.mount_R) || !std::isfinite(scan.angle_min) ||
      !std::isfinite(scan.angle_increment) || !std::isfinite(scan.range_max)) {
    return false;
  }
  unsigned wrong = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    wrong |= static_cast<unsigned>(scan.status[i] == Beam::Ok && !std::isfinite(scan.ranges[i]));
  }
  return wrong == 0;
}

/// Turns in place to a wanted heading; at rest when there is none or it is reached.
Twist2 turn_to(const Pose2& pose_W, const SetGoal& goal, const Parameters& parameters) {
  if (!goal.heading) return {};
  const double error = wrap_angle(*goal.heading - pose_W.heading);
  if (std::abs(error) < kHeadingReach) return {};
  const double limit = parameters[Parameter::MaxTurnRate];
  return {0, std::clamp(parameters[Parameter::HeadingGain] * error, -limit, limit)};
}

}  // namespace

struct ElasticStripController::Strip {
  Vec2 start_W{0, 0};  // P^{j-1}
  Vec2 via_W{0, 0};    // P^j
  Vec2 end_W{0, 0};    // P^{j+1}
};

bool all_finite(const ControlInput& in, const Parameters& parameters) {
  for (const ParameterInfo& about : parameter_table()) {
    if (!std::isfinite(parameters[about.id])) return false;
  }
  if (in.goal && !in.goal->position_W.allFinite()) return false;
  if (in.goal && in.goal->heading && !std::isfinite(*in.goal->heading)) return false;
  const Odometry& odometry = in.odometry;
  return std::isfinite(in.stamp) && std::isfinite(in.dt) && std::isfinite(in.spec->radius) &&
         std::isfinite(odometry.stamp) && finite(odometry.pose) &&
         std::isfinite(odometry.twist.v) && std::isfinite(odometry.twist.omega) &&
         finite(in.scene->left) && finite(in.scene->right) && finite(in.scene->scan);
}

Twist2 drive_to(const Pose2& pose_W, const Vec2& pass_W, const Parameters& parameters) {
  const Vec2 e = pass_W - pose_W.position();
  const double length = e.norm();
  if (!(length > 0)) return {};
  const double v_max = parameters[Parameter::MaxSpeed];
  const double w_max = parameters[Parameter::MaxTurnRate];
  const double turn = wrap_angle(std::atan2(e.y(), e.x()) - pose_W.heading);
  const double v = std::min(v_max, length * v_max / parameters[Parameter::StripStep]);
  const double w = parameters[Parameter::HeadingGain] * turn;
  return {v * std::max(0.0, std::cos(turn)), std::clamp(w, -w_max, w_max)};
}

void ElasticStripController::reset(const Pose2& /*start_W*/) {
  side_.reset();
  goal_.reset();
  kept_via_W_.reset();
}

/// Side and kept via belong to one goal: with another the line to it is another.
void ElasticStripController::follow_goal(const SetGoal& goal) {
  if (goal_ && goal_->position_W == goal.position_W) return;
  side_.reset();
  kept_via_W_.reset();
  goal_ = goal;
}

/// Half a step to the via and half a step on, so that |end - start| = min(S, D).
ElasticStripController::Strip ElasticStripController::lay_strip(
    const Vec2& start_W, const Vec2& goal_W, const Parameters& parameters) const {
  const double half_step = parameters[Parameter::StripStep] / 2;
  Strip strip;
  strip.start_W = start_W;
  strip.via_W = get_posi(start_W, goal_W, half_step, 1.0).position();
  strip.end_W = get_posi(strip.via_W, goal_W, half_step, 1.0).position();
  if (reading_.keep_via) strip.via_W = kept_via_W_.value_or(strip.via_W);
  return strip;
}

/// The external force of each side, from the present pose. False when the robot stands on an
/// obstacle point: then there is no direction away from it.
bool ElasticStripController::push(const ControlInput& in,
                                  const ForceSettings& settings,
                                  ControlOutput& out) const {
  const Vec2 p = in.odometry.pose.position();
  const std::optional<Nearest>& left = in.scene->left;
  const std::optional<Nearest>& right = in.scene->right;
  const bool both = reading_.sides == Sides::Both;
  const double d_left = left ? (p - left->point_W).norm() : 0;
  const double d_right = right ? (p - right->point_W).norm() : 0;
  if ((left && d_left == 0) || (right && d_right == 0)) return false;
  // The lower beam of equals, which is on the right.
  if (left && (both || !right || d_left < d_right)) {
    out.external_left_W = external_force(settings, p, left->point_W);
  }
  if (right && (both || !left || d_right <= d_left)) {
    out.external_right_W = external_force(settings, p, right->point_W);
  }
  return true;
}

void ElasticStripController::choose(const ControlInput& in,
                                    const Vec2& goal_W,
                                    double reach,
                                    ControlOutput& out) {
  const SideInput input{
      in.stamp, in.odometry.pose, goal_W, reach, in.spec->radius, &in.scene->scan};
  const SidePush push = side_.update(input, out.external_left_W + out.external_right_W);
  out.elastic_W += push.force_W;
  out.side = side_.state().side;
  out.side_since = side_.state().since;
  out.side_alpha = push.alpha;
  out.blocked_beam = push.blocked_beam ? static_cast<std::int32_t>(*push.blocked_beam) : -1;
}

void ElasticStripController::update(const ControlInput& in,
                                    const Parameters& parameters,
                                    ControlOutput& out) {
  out.clear();
  if (!all_finite(in, parameters)) return;
  if (!in.goal) {
    reset(in.odometry.pose);
    return;
  }
  const SetGoal& goal = *in.goal;
  follow_goal(goal);
  const Pose2& pose = in.odometry.pose;
  const double reach = parameters[Parameter::SafetyDistance] + in.spec->radius;
  const ForceSettings settings{
      reading_.law, reach, parameters[Parameter::RepulsionGain], parameters[Parameter::StripStep]};

  const Strip strip = lay_strip(pose.position(), goal.position_W, parameters);
  const double k_c = parameters[Parameter::ContractionGain];
  out.internal_W = internal_force(strip.start_W, strip.via_W, strip.end_W, k_c);
  const bool free_to_move = push(in, settings, out);
  out.elastic_W = out.internal_W + out.external_left_W + out.external_right_W;
  if (reading_.choose_side) choose(in, goal.position_W, reach, out);
  out.pass_W = update_strip(pose, strip.end_W, out.elastic_W).updated.position();
  kept_via_W_ = out.pass_W;

  out.strip.push_back({strip.start_W, {0, 0}, {0, 0}});
  out.strip.push_back({out.pass_W, out.internal_W, out.elastic_W - out.internal_W});
  out.strip.push_back({strip.end_W, {0, 0}, {0, 0}});

  const double to_goal = (goal.position_W - pose.position()).norm();
  if (!free_to_move) return;
  out.twist = to_goal < parameters[Parameter::GoalReach] ? turn_to(pose, goal, parameters)
                                                         : drive_to(pose, out.pass_W, parameters);
}

}  // namespace algo
