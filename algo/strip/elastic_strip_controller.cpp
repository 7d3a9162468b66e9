// algo/strip/elastic_strip_controller.cpp: one tick of the strip.
#include "algo/strip/elastic_strip_controller.hpp"

#include "algo/strip/strip_law.hpp"

namespace algo {

struct ElasticStripController::Strip {
  Vec2 start_W{0, 0};  // P^{j-1}
  Vec2 via_W{0, 0};    // P^j
  Vec2 end_W{0, 0};    // P^{j+1}
};

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
  const double half_step = parameters[kStripStep] / 2;
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
  const double reach = parameters[kSafetyDistance] + in.spec->radius;
  const ForceSettings settings{
      reading_.law, reach, parameters[kRepulsionGain], parameters[kStripStep]};

  const Strip strip = lay_strip(pose.position(), goal.position_W, parameters);
  const double k_c = parameters[kContractionGain];
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
  out.twist = to_goal < parameters[kGoalReach] ? turn_to(pose, goal, parameters)
                                               : drive_to(pose, out.pass_W, parameters);
}

}  // namespace algo
