// algo/full_strip/velocity_stage.cpp: speed profile, pursuit, proofs.
#include "algo/full_strip/velocity_stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace algo {
namespace {

constexpr double kCreep = 0.35;         // [m/s] where the hull barely fits
constexpr double kCreepRoom = 0.055;    // [m] room beside the hull there
constexpr double kSpeedPerRoom = 3.0;   // [1/s] more speed per metre more
constexpr double kSlowest = 0.25;       // [m/s]
constexpr double kLateral = 2.0;        // [m/s2] in curves
constexpr double kTurnShare = 0.8;      // of the turn rate that the profile assumes
constexpr double kBrakeShare = 0.7;     // of the deceleration
constexpr double kTurnOnSpot = 1.2;     // [rad] heading error above which the robot turns first
constexpr double kTurnGain = 2.5;       // [1/s]
constexpr double kFacing = 0.05;        // [rad] heading error with which a disc faces the strip
constexpr double kArc = 0.1;            // [rad] heading error that an arc removes by itself,
constexpr double kArcPerSpeed = 1.0;    // [rad per m/s] and more with speed
constexpr double kCloseMargin = 0.022;  // [m] a motion close to the strip needs less room
constexpr double kCloseAhead = 0.16;    // [m] ahead on the strip, its point to steer for
constexpr double kFloor = 0.02;  // [m] below it only an escape is tried; above a scanner's error
constexpr double kStepSlack = 0.002;    // [m] a position may be this much nearer than the last
constexpr double kClosest = 0.022;      // [m] from a return: the scanner may err by 15 mm
constexpr double kReverseSpeed = 0.24;  // [m/s]

/// The ways to follow the strip, the best first.
constexpr std::array<VelocityStage::Pace, 6> kPaces{
    {{1, false}, {0.75, false}, {0.5, false}, {0.75, true}, {0.3, true}, {0.15, true}}};

/// [m] Distance ahead of the robot of the point it steers for, at speed `v` [m/s]. Close to the
/// strip it cuts no corner.
double lookahead(double v, bool close) {
  if (close) return kCloseAhead;
  return std::clamp(0.3 + 0.4 * std::abs(v), 0.35, 1.0);
}

Twist2 within(const Twist2& twist, const MotionLimits& limits) {
  return {std::clamp(twist.v, -limits.max_v, limits.max_v),
          std::clamp(twist.omega, -limits.max_omega, limits.max_omega)};
}

/// [m] From the hull to the return next to the nearest one, which may be an outlier.
double seen_room(const HullCheck& hull, const Recycled<Vec2>& returns_W, const Pose2& pose_W) {
  double nearest = std::numeric_limits<double>::infinity();
  double next = nearest;
  for (const Vec2& return_W : returns_W) {
    const double room = hull.distance(pose_W, return_W);
    next = std::min(next, std::max(nearest, room));
    nearest = std::min(nearest, room);
  }
  return next;
}

}  // namespace

/// Whether the way to `next_W` leads nearer to what is almost touched.
bool VelocityStage::nears_return(const StageInput& in, const Pose2& next_W) const {
  if (in.close_W == nullptr) return false;
  const double then = seen_room(hull_, *in.close_W, next_W);
  return then < kClosest && then < seen_room(hull_, *in.close_W, in.state.pose_W);
}

/// The highest speed at each node: by room, curvature and turn rate, then such that the robot can
/// brake for the nodes ahead.
void VelocityStage::profile(const StageInput& in) {
  const Recycled<Node>& nodes = in.strip->nodes();
  profiled_ = std::min(kProfile, nodes.size());
  const double spacing = NodeStrip::kSpacing;
  const double deceleration = kBrakeShare * in.limits.acceleration;
  const double narrow = hull_.half_width() + kCreepRoom;
  const double end = in.stop_at >= 0 ? in.stop_at : in.strip->length();
  for (std::size_t i = 0; i < profiled_; ++i) {
    const Vec2& p = nodes[i].position_W;
    double v = in.limits.max_v;
    v = std::min(v, kCreep + kSpeedPerRoom * (in.map->distance(p) - narrow));
    if (i > 0 && i + 1 < nodes.size()) {
      const Vec2 a = p - nodes[i - 1].position_W;
      const Vec2 b = nodes[i + 1].position_W - p;
      const double turn = std::abs(std::atan2(cross(a, b), a.dot(b)));
      const double curvature = turn / std::max(0.5 * (a.norm() + b.norm()), 0.02);
      v = std::min({v,
                    std::sqrt(kLateral / std::max(curvature, 1e-3)),
                    kTurnShare * in.limits.max_omega / std::max(curvature, 1e-3)});
    }
    v = std::min(std::max(v, kSlowest), in.limits.max_v);
    const double s = static_cast<double>(i) * spacing;
    v = std::min(v, std::sqrt(2 * deceleration * std::max(0.0, end - s)));
    speed_[i] = v;
  }
  for (std::size_t i = profiled_; i-- > 1;) {
    const double reachable = std::sqrt(speed_[i] * speed_[i] + 2 * deceleration * spacing);
    speed_[i - 1] = std::min(speed_[i - 1], reachable);
  }
}

double VelocityStage::speed_at(double s) const {
  if (profiled_ == 0) return 0;
  const double at = std::max(0.0, s / NodeStrip::kSpacing);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= profiled_) return speed_[profiled_ - 1];
  return speed_[i] + (at - static_cast<double>(i)) * (speed_[i + 1] - speed_[i]);
}

/// The command at `state`, `s` [m] along the strip.
Twist2 VelocityStage::pursue(const StageInput& in,
                             const MotionState& state,
                             double s,
                             const Pace& pace) const {
  const double ahead = lookahead(state.twist.v, pace.close);
  const Vec2 aim = to_child(state.pose_W, in.strip->at(s + ahead));
  const double length = aim.norm();
  if (length < 1e-6) return {};
  const double error = std::atan2(aim.y(), aim.x());
  const double w_max = in.limits.max_omega;
  if (std::abs(error) > kTurnOnSpot) {
    return {0, pace.share * std::clamp(kTurnGain * error, -w_max, w_max)};
  }
  double v = speed_at(s) * pace.share;
  const double curvature = 2 * aim.y() / (length * length);
  // A slow robot first turns by what its arc would take metres to turn.
  const double least = kTurnGain * (std::abs(error) - kArc - kArcPerSpeed * v);
  double omega = std::copysign(std::max(std::abs(curvature) * v, least), error);
  if (std::abs(omega) > w_max) {
    v *= w_max / std::abs(omega);
    omega = std::clamp(omega, -w_max, w_max);
  }
  return {v, omega};
}

bool VelocityStage::admissible(const StageInput& in,
                               const Pace& pace,
                               Twist2& first,
                               Vec2& aim_W) const {
  MotionState state = in.state;
  double s = 0;
  // The robot's distance along the strip when its command begins to act.
  s += (state.pose_W.position() - in.strip->nodes()[0].position_W).norm();
  // Already too close: no step may lead closer until there is room again.
  const double wanted = pace.close ? kCloseMargin : kMargin;
  double margin = std::min(wanted, hull_.clearance(*in.map, state.pose_W) - kStepSlack);
  if (margin < kFloor) return false;
  const int ticks = std::max(1, static_cast<int>(std::lround(kHorizon / in.dt)));
  CommandCourse course = in.course;
  for (int k = 0; k < ticks; ++k) {
    Twist2 command = pursue(in, state, s, pace);
    if (command.v > 0) command = steadied(course, command, in.dt);
    course = followed(course, command, in.dt);
    if (k == 0) {
      first = command;
      aim_W = in.strip->at(s + lookahead(state.twist.v, pace.close));
    }
    const Vec2 before = state.pose_W.position();
    state = advanced(state, command, in.limits, in.dt);
    s += (state.pose_W.position() - before).norm();
    if (k == 0 && nears_return(in, state.pose_W)) return false;
    if (hull_.enters_unseen(in.map->seen(), state.pose_W, state.twist)) return false;
    const double room = hull_.clearance(*in.map, state.pose_W);
    if (room < margin) return false;
    margin = std::max(margin, std::min(wanted, room - kStepSlack));
    // The strip may change at the next tick, or a person may press Stop.
    if (k == 0 && !rests_clear(*in.map, hull_, state, in.limits, in.dt, margin)) return false;
    if (state.twist == Twist2{} && command == Twist2{}) return true;
  }
  return rests_clear(*in.map, hull_, state, in.limits, in.dt, margin);
}

std::optional<Twist2> VelocityStage::follow(const StageInput& in, Weighing& out) {
  profile(in);
  const auto attempt = [&](const Pace& pace) -> std::optional<Twist2> {
    Twist2 first;
    Vec2 aim_W{0, 0};
    const bool allowed = admissible(in, pace, first, aim_W);
    out.candidates.push_back({first, kHorizon, allowed, allowed});
    if (!allowed) return std::nullopt;
    out.pass_W = aim_W;
    return first;
  };
  for (const Pace& pace : kPaces) {
    if (const auto twist = attempt(pace)) return twist;
  }
  return turned_in_place(in);
}

/// A disc at rest may turn towards the strip however close things are: its outline stays the same.
/// Beside a wall that it may not come nearer to, it first has to face the point that close motions
/// steer for.
std::optional<Twist2> VelocityStage::turned_in_place(const StageInput& in) const {
  if (!hull_.is_round() || in.state.twist.v != 0) return std::nullopt;
  const Vec2 aim = to_child(in.state.pose_W, in.strip->at(kCloseAhead));
  const double error = std::atan2(aim.y(), aim.x());
  if (std::abs(error) < kFacing) return std::nullopt;
  const double w_max = in.limits.max_omega;
  return Twist2{0, std::clamp(kTurnGain * error, -w_max, w_max)};
}

std::optional<Twist2> VelocityStage::proven(const StageInput& in,
                                            const Twist2& wanted,
                                            Weighing& out) const {
  const double here = hull_.clearance(*in.map, in.state.pose_W);
  const double margin = std::min(kMargin, here) - kStepSlack;
  MotionState state = in.state;
  bool allowed = margin >= kFloor;
  for (int k = 0; allowed && k < 2; ++k) {
    state = advanced(state, wanted, in.limits, in.dt);
    allowed = !(k == 0 && nears_return(in, state.pose_W)) &&
              !hull_.enters_unseen(in.map->seen(), state.pose_W, state.twist) &&
              hull_.clearance(*in.map, state.pose_W) >= margin;
  }
  allowed = allowed && rests_clear(*in.map, hull_, state, in.limits, in.dt, margin);
  out.candidates.push_back({wanted, 2 * in.dt, allowed, allowed});
  if (!allowed) return std::nullopt;
  return wanted;
}

/// True if `twist` may be held for `horizon` and braked. `gain` [m] is the increase of room at its
/// end.
bool VelocityStage::holds(const StageInput& in,
                          const Twist2& twist,
                          double horizon,
                          double& gain) const {
  MotionState state = in.state;
  const double start = hull_.clearance(*in.map, state.pose_W);
  double least = start;
  const int ticks = std::max(1, static_cast<int>(std::lround(horizon / in.dt)));
  for (int k = 0; k < ticks + 400; ++k) {
    state = advanced(state, k < ticks ? twist : Twist2{}, in.limits, in.dt);
    if (k == 0 && nears_return(in, state.pose_W)) return false;
    if (hull_.enters_unseen(in.map->seen(), state.pose_W, state.twist)) return false;
    const double room = hull_.clearance(*in.map, state.pose_W);
    // Already too close: every step must lead away.
    const double floor = std::min(least, kMargin) - 1e-3;
    if (room < floor) return false;
    least = std::max(least, room);
    if (k >= ticks && state.twist == Twist2{}) {
      gain = room - start;
      return true;
    }
  }
  return false;
}

std::optional<Twist2> VelocityStage::escape(const StageInput& in, Weighing& out) const {
  constexpr double kV = 0.25;  // [m/s]
  constexpr double kW = 1.0;   // [rad/s]
  constexpr std::array<Twist2, 8> kPrimitives{
      {{kV, 0}, {-kV, 0}, {kV, kW}, {kV, -kW}, {-kV, kW}, {-kV, -kW}, {0, kW}, {0, -kW}}};
  std::optional<Twist2> best;
  double most = 0.003;  // [m] less is no way out
  for (const Twist2& primitive : kPrimitives) {
    const Twist2 twist = within(primitive, in.limits);
    double gain = 0;
    const bool allowed = holds(in, twist, kEscape, gain);
    out.candidates.push_back({twist, kEscape, allowed, false});
    if (!allowed || gain <= most) continue;
    most = gain;
    best = twist;
  }
  return best;
}

bool VelocityStage::still_escapes(const StageInput& in,
                                  const Twist2& twist,
                                  double horizon,
                                  Weighing& out) const {
  double gain = 0;
  const bool allowed = holds(in, twist, horizon, gain);
  out.candidates.push_back({twist, horizon, allowed, allowed});
  return allowed;
}

std::optional<Twist2> VelocityStage::back_off(const StageInput& in, Weighing& out) const {
  for (const double turn : {0.0, 0.8, -0.8}) {
    double gain = 0;
    const Twist2 twist = within({-kReverseSpeed, turn}, in.limits);
    const bool allowed = holds(in, twist, 0.5, gain);
    out.candidates.push_back({twist, 0.5, allowed, allowed});
    if (allowed) return twist;
  }
  return std::nullopt;
}

}  // namespace algo
