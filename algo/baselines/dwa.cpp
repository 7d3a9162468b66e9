// algo/baselines/dwa.cpp: the room on an arc, the window, the objective, and one tick.
#include "algo/baselines/dwa.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algo/baselines/returns.hpp"
#include "algo/common_layers.hpp"
#include "algo/diff_drive.hpp"

namespace algo {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kInterval = 0.25;  // [s] control interval of the paper
constexpr int kSpeeds = 9;          // [D] samples of the window
constexpr int kTurns = 21;          // [D]
constexpr int kMotions = kSpeeds * kTurns;
constexpr double kFarthest = 3.0;  // [m] [D] more room is no better
constexpr double kShown = 1.5;     // [s] [D] drawn length of each candidate
constexpr std::size_t kBearings = 180;
constexpr std::uint8_t kWindow = 1;
constexpr std::uint8_t kNoWindow = 2;

constexpr ParameterInfo kMargin{.name = "dwa.margin",
                                .label = "Margin",
                                .unit = "m",
                                .max = 0.5,
                                .step = 0.01,
                                .initial = 0.05,
                                .help = "Room that the window keeps beyond the hull."};
constexpr ParameterInfo kHeadingWeight{.name = "dwa.heading_weight",
                                       .label = "Heading weight",
                                       .max = 1,
                                       .step = 0.05,
                                       .initial = 0.4,
                                       .help = "What a heading towards the goal is worth."};
constexpr ParameterInfo kRoomWeight{.name = "dwa.room_weight",
                                    .label = "Room weight",
                                    .max = 1,
                                    .step = 0.05,
                                    .initial = 0.4,
                                    .help = "What free way ahead is worth."};
constexpr ParameterInfo kSpeedWeight{.name = "dwa.speed_weight",
                                     .label = "Speed weight",
                                     .max = 1,
                                     .step = 0.05,
                                     .initial = 0.2,
                                     .help = "What speed is worth."};
constexpr auto kDwaParameters = std::to_array<const ParameterInfo*>({&kHeadingWeight,
                                                                     &kRoomWeight,
                                                                     &kSpeedWeight,
                                                                     &kMargin,
                                                                     &kMaxSpeed,
                                                                     &kMaxTurnRate,
                                                                     &kHeadingGain,
                                                                     &kGoalReach});

double full_turn(double angle) {
  const double wrapped = wrap_angle(angle);
  return wrapped < 0 ? wrapped + 2 * std::numbers::pi : wrapped;
}

bool inside(const Hull& hull, const Vec2& p) {
  if (hull.is_disc()) return p.norm() < hull.radius;
  return std::abs(p.x()) < hull.half_length && std::abs(p.y()) < hull.half_width;
}

/// The room straight ahead.
double straight_room(const Hull& hull, const Vec2& p) {
  const double half = hull.is_disc() ? hull.radius : hull.half_width;
  if (!(std::abs(p.y()) < half) || p.x() < 0) return kInf;
  const double front = hull.is_disc() ? std::sqrt(half * half - p.y() * p.y()) : hull.half_length;
  return std::max(0.0, p.x() - front);
}

/// The turn until a disc whose centre circles about `c` meets a point. Seen from c, the disc is 2
/// beta wide at the point's distance.
double disc_turn(double radius, const Vec2& c, const Vec2& q, double sign) {
  const double way = c.norm();
  const double rho = q.norm();
  if (!(std::abs(rho - way) < radius) || !(rho > 0) || !(way > 0)) return kInf;
  const double cosine = (rho * rho + way * way - radius * radius) / (2 * rho * way);
  const double beta = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double ahead = full_turn(sign * (std::atan2(q.y(), q.x()) - std::atan2(-c.y(), -c.x())));
  return std::max(0.0, ahead - beta);
}

/// The turn until a rectangle that circles about `c` = (0, c_y) meets a point: the least turn to a
/// crossing of the point's circle with the rectangle's edges.
double box_turn(const Hull& hull, const Vec2& c, const Vec2& q, double sign) {
  const double square = q.squaredNorm();
  double least = kInf;
  const auto cross = [&](double x, double y) {  // (x, y) seen from c
    const bool on_edge = std::abs(x) <= hull.half_length && std::abs(y + c.y()) <= hull.half_width;
    if (!on_edge) return;
    least = std::min(least, full_turn(sign * (std::atan2(q.y(), q.x()) - std::atan2(y, x))));
  };
  const double end_square = square - hull.half_length * hull.half_length;
  if (end_square >= 0) {
    const double y = std::sqrt(end_square);
    for (const double x : {-hull.half_length, hull.half_length}) {
      cross(x, y);
      cross(x, -y);
    }
  }
  for (const double side : {-hull.half_width, hull.half_width}) {
    const double y = side - c.y();
    if (square < y * y) continue;
    const double x = std::sqrt(square - y * y);
    cross(x, y);
    cross(-x, y);
  }
  return least;
}

/// Sample `k` of `count` over [from, to]. The sample nearest to zero is set to zero, so that a
/// window about zero includes going straight.
double sample(double from, double to, int k, int count) {
  const double step = (to - from) / (count - 1);
  const double value = from + k * step;
  return from <= 0 && to >= 0 && std::abs(value) < step / 2 ? 0 : value;
}

}  // namespace

ArcRoom arc_room(const Hull& hull, const Twist2& twist, const Vec2& point_R) {
  if (inside(hull, point_R)) return {0, 0};
  if (twist.omega == 0) return {twist.v > 0 ? straight_room(hull, point_R) : kInf, kInf};
  const double sign = twist.omega > 0 ? 1 : -1;
  const Vec2 c{0, twist.v / twist.omega};
  const Vec2 q = point_R - c;
  const double angle =
      hull.is_disc() ? disc_turn(hull.radius, c, q, sign) : box_turn(hull, c, q, sign);
  // A disc turning in place meets nothing, and the room of a way of no length is infinite.
  const double distance = twist.v > 0 ? angle * c.norm() : kInf;
  return {distance, angle};
}

ArcRoom arc_room(const Hull& hull, const Twist2& twist, std::span<const Vec2> points_R) {
  ArcRoom least;
  for (const Vec2& point : points_R) {
    const ArcRoom room = arc_room(hull, twist, point);
    least.distance = std::min(least.distance, room.distance);
    least.angle = std::min(least.angle, room.angle);
  }
  return least;
}

bool admissible(const Twist2& twist, const ArcRoom& room, const RobotSpec& spec, double reaction) {
  const double w = std::abs(twist.omega);
  const double distance = room.distance - twist.v * reaction;
  const double angle = room.angle - w * reaction;
  const bool stops = twist.v == 0 || twist.v * twist.v <= 2 * spec.max_acceleration * distance;
  return stops && (w == 0 || w * w <= 2 * spec.max_angular_acceleration * angle);
}

DynamicWindow dynamic_window(const Twist2& now,
                             const RobotSpec& spec,
                             const Parameters& parameters) {
  const double v_max = parameters[kMaxSpeed];
  const double w_max = parameters[kMaxTurnRate];
  const double dv = spec.max_acceleration * kInterval;
  const double dw = spec.max_angular_acceleration * kInterval;
  return {std::clamp(now.v - dv, 0.0, v_max),
          std::clamp(now.v + dv, 0.0, v_max),
          std::clamp(now.omega - dw, -w_max, w_max),
          std::clamp(now.omega + dw, -w_max, w_max)};
}

double dwa_objective(const Pose2& pose_W,
                     const Vec2& goal_W,
                     const Twist2& twist,
                     const ArcRoom& room,
                     double v_max,
                     const RobotSpec& spec,
                     const DwaWeights& weights) {
  const Pose2 there = integrate_arc(pose_W, twist, kInterval);
  const double brake = spec.max_angular_acceleration > 0
                           ? twist.omega * std::abs(twist.omega) / 2 / spec.max_angular_acceleration
                           : 0;
  const double off = wrap_angle(bearing_W(there.position(), goal_W) - there.heading - brake);
  const double heading = 1 - std::abs(off) / std::numbers::pi;
  const double dist = std::min(room.distance, kFarthest) / kFarthest;
  return weights.heading * heading + weights.room * dist + weights.speed * twist.v / v_max;
}

ParameterList Dwa::parameters() {
  return kDwaParameters;
}

void Dwa::forget() {
  points_R_.reserve(kBearings);
}

/// Keeps the returns within `reach` [m], the nearest in every two degrees.
void Dwa::gather(const ControlInput& in, double reach) {
  std::array<double, kBearings> least{};
  least.fill(reach);
  std::array<Vec2, kBearings> nearest{};
  const Pose2& pose = in.odometry.pose;
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  for_each_return(in, [&](const Vec2& point_W) {
    const Vec2 way = point_W - pose.position();
    const Vec2 p{c * way.x() + s * way.y(), c * way.y() - s * way.x()};
    const double share = full_turn(std::atan2(p.y(), p.x())) / (2 * std::numbers::pi);
    const auto k = std::min(kBearings - 1, static_cast<std::size_t>(share * kBearings));
    if (!(p.norm() < least[k])) return;
    least[k] = p.norm();
    nearest[k] = p;
  });
  points_R_.clear();
  for (std::size_t k = 0; k < kBearings; ++k) {
    if (least[k] < reach) points_R_.push_back(nearest[k]);
  }
}

void Dwa::steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) {
  const RobotSpec& spec = *in.spec;
  const double margin = parameters[kMargin];
  const double length = spec.half_length > 0 ? spec.half_length + margin : 0;
  const Hull hull{spec.radius + margin, length, spec.half_width + margin};
  gather(in, kFarthest + hull.radius + hull.half_length + hull.half_width);
  const double v_max = parameters[kMaxSpeed];
  const DynamicWindow window = dynamic_window(in.odometry.twist, spec, parameters);
  const DwaWeights weights{
      parameters[kHeadingWeight], parameters[kRoomWeight], parameters[kSpeedWeight]};
  const double reaction = in.dt + spec.command_delay;

  // Reserve room for all candidates in each: references to a layer do not outlive the next
  // add_layer().
  for (const LayerInfo* info : {&layers::kRefused, &layers::kAllowed, &layers::kChosen}) {
    add_layer(out.layers, *info, std::size_t{2} * kMotions);
  }
  Layer& refused = *(out.layers.end() - 3);
  Layer& allowed = *(out.layers.end() - 2);
  Layer& chosen = out.layers.back();
  const auto show = [](Layer& layer, const Twist2& twist) {
    put(layer, kShown * twist.v, kShown * twist.omega);
  };
  std::optional<Twist2> best;
  double least = kInf;
  int stoppable = 0;
  for (int i = 0; i < kSpeeds; ++i) {
    for (int k = 0; k < kTurns; ++k) {
      const Twist2 twist{sample(window.v_from, window.v_to, i, kSpeeds),
                         sample(window.omega_from, window.omega_to, k, kTurns)};
      const ArcRoom room = arc_room(hull, twist, points_R_);
      if (!admissible(twist, room, spec, reaction)) {
        show(refused, twist);
        continue;
      }
      show(allowed, twist);
      ++stoppable;
      const double cost =
          1 - dwa_objective(in.odometry.pose, goal_W(in), twist, room, v_max, spec, weights);
      if (best && !(cost < least)) continue;
      best = twist;
      least = cost;
    }
  }
  out.measures.push_back({"window.allowed", "", static_cast<double>(stoppable)});
  out.pass_W = goal_W(in);
  out.state = best ? kWindow : kNoWindow;
  out.waits = !best;
  if (!best) return;  // no twist can be stopped in time: brake
  show(chosen, *best);
  out.twist = *best;
  out.pass_W = integrate_arc(in.odometry.pose, out.twist, kShown).position();
}

void Dwa::tell(const Telemetry& t, Explanation& words) const {
  if (t.output.state == kNoWindow) {
    words.what = "Braking";
    words.why = "No motion in reach could be stopped in time.";
    return;
  }
  words.what = "Choosing among the speeds in reach";
  say(words.why,
      "%.0f of %d motions can be stopped in time; the best is %.2f m/s, %.2f rad/s.",
      t.output.measure("window.allowed").value_or(0),
      kMotions,
      t.output.twist.v,
      t.output.twist.omega);
}

}  // namespace algo
