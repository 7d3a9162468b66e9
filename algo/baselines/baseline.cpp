// algo/baselines/baseline.cpp: the common frame of the baseline controllers.
#include "algo/baselines/baseline.hpp"

#include <algorithm>
#include <cmath>

#include "algo/baselines/returns.hpp"
#include "algo/driving.hpp"

namespace algo {
namespace {

constexpr double kShownStep = 0.5;  // [m] from the robot to the displayed pass point

/// On an obstacle point, no direction leads away from it.
bool on_obstacle(const Scene& scene) {
  const auto touches = [](const auto& side) { return side && !(side->distance > 0); };
  return touches(scene.left) || touches(scene.right);
}

}  // namespace

void Baseline::reset(const Pose2& /*start_W*/) {
  goal_W_.reset();
  forget();
}

void Baseline::update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) {
  out.clear();
  if (!all_finite(in, parameters) || !finite_sonar(*in.observation)) return;
  if (!in.goal) {
    if (goal_W_) reset(in.odometry.pose);
    return;
  }
  if (goal_W_ && *goal_W_ != goal_W(in)) retarget();
  goal_W_ = goal_W(in);
  const Pose2& pose = in.odometry.pose;
  if ((*goal_W_ - pose.position()).norm() < parameters[algo::kGoalReach]) {
    out.pass_W = goal_W_;
    out.twist = turn_to(pose, *in.goal, parameters);
    return;
  }
  steer(in, parameters, out);
  if (on_obstacle(*in.scene)) out.twist = {};
}

void Baseline::explain(const Telemetry& t, Explanation& words) const {
  if (t.output.state == 0) {
    say_driving(t, words);
  } else {
    tell(t, words);
  }
}

double bearing_W(const Vec2& from_W, const Vec2& to_W) {
  const Vec2 way = to_W - from_W;
  return std::atan2(way.y(), way.x());
}

void tell_pushed(const Telemetry& t, Explanation& words) {
  words.what = "Driving where pull and pushes lead";
  say(words.why, "That is %.0f degrees off the goal. ", off_goal(t));
  say_surroundings(t, words.why);
}

void steer_along(const ControlInput& in,
                 double bearing,
                 double speed,
                 const Parameters& parameters,
                 ControlOutput& out) {
  const Pose2& pose = in.odometry.pose;
  const double to_goal = (goal_W(in) - pose.position()).norm();
  out.pass_W = pose.position() + std::min(kShownStep, to_goal) * direction(bearing);
  out.twist = drive_along(pose, bearing, speed, parameters);
}

}  // namespace algo
