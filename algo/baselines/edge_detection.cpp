// algo/baselines/edge_detection.cpp: edges, and the states drive, stand, pass.
#include "algo/baselines/edge_detection.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "algo/geometry.hpp"

namespace algo {
namespace {

constexpr double kJump = 0.3;          // [m] [D]
constexpr double kAside = 0.45;        // [m] [D]
constexpr double kStandingTime = 0.5;  // [s] [D]
constexpr double kViaReach = 0.1;      // [m] [D] reach of the via point

constexpr auto kEdgeParameters = std::to_array<const ParameterInfo*>(
    {&kSafetyDistance, &kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});

/// The first edge from `beam` on, going left (step +1) or right (step -1).
std::optional<Edge> first_edge(const LaserScan& scan, std::size_t beam, int step) {
  Edge edge{beam, scan.ranges[beam]};
  // Unsigned, so that a step below beam 0 also ends the loop.
  for (std::size_t i = beam + static_cast<std::size_t>(step); i < scan.size();
       i += static_cast<std::size_t>(step)) {
    if (scan.status[i] == Beam::Invalid) continue;
    const double range = scan.status[i] == Beam::Ok ? scan.ranges[i] : scan.range_max;
    if (std::abs(range - edge.range) > kJump) return range < edge.range ? Edge{i, range} : edge;
    edge = {i, range};
  }
  return std::nullopt;
}

}  // namespace

ParameterList EdgeDetection::parameters() {
  return kEdgeParameters;
}

EdgePair bounding_edges(const LaserScan& scan, std::size_t beam) {
  return {first_edge(scan, beam, 1), first_edge(scan, beam, -1)};
}

Vec2 beside_edge(const Pose2& pose_W, const LaserScan& scan, const Edge& edge, Side side) {
  const Vec2 point = beam_point_W(pose_W, scan.mount_R, scan.angle(edge.beam), edge.range);
  const double sight = bearing_W(pose_W.position(), point);
  const double outward = sight + static_cast<double>(side) * std::numbers::pi / 2;
  return point + kAside * direction(outward);
}

void EdgeDetection::forget() {
  lane_.reset();
  standing_since_.reset();
  via_W_.reset();
}

/// The beam that hits an obstacle in the lane to the goal, if any.
std::optional<std::size_t> EdgeDetection::blocking_beam(const ControlInput& in,
                                                        const Parameters& parameters) {
  const double reach = parameters[kSafetyDistance] + in.spec->radius;
  const SideInput input{
      in.stamp, in.odometry.pose, goal_W(in), reach, in.spec->radius, &in.scene->scan};
  return lane_.update(input, {0, 0}).blocked_beam;
}

/// True if the robot must still stand for its scan.
bool EdgeDetection::wait(double stamp) {
  if (!standing_since_) standing_since_ = stamp;
  return stamp - *standing_since_ < kStandingTime;
}

void EdgeDetection::choose(const ControlInput& in, std::size_t beam) {
  const Pose2& pose = in.odometry.pose;
  const EdgePair edges = bounding_edges(in.scene->scan, beam);
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const std::optional<Edge>& edge, Side side) {
    if (!edge) return;
    const Vec2 via = beside_edge(pose, in.scene->scan, *edge, side);
    const double way = (via - pose.position()).norm() + (goal_W(in) - via).norm();
    if (way >= least) return;
    least = way;
    via_W_ = via;
  };
  offer(edges.left, Side::Left);
  offer(edges.right, Side::Right);
}

void EdgeDetection::steer(const ControlInput& in,
                          const Parameters& parameters,
                          ControlOutput& out) {
  const Pose2& pose = in.odometry.pose;
  if (via_W_ && (*via_W_ - pose.position()).norm() < kViaReach) via_W_.reset();
  if (!via_W_) {
    if (const auto beam = blocking_beam(in, parameters)) {
      if (wait(in.stamp)) {
        out.state = kTakingScan;
        out.pass_W = goal_W(in);
        return;
      }
      choose(in, *beam);
    }
    standing_since_.reset();
  }
  out.state = via_W_ ? kToEdge : kToGoal;
  const Vec2 target = via_W_.value_or(goal_W(in));
  const double bearing = bearing_W(pose.position(), target);
  steer_along(in, bearing, parameters[kMaxSpeed], parameters, out);
  out.pass_W = target;
}

void EdgeDetection::tell(const Telemetry& t, Explanation& words) const {
  const Vec2 p = t.observation.odometry.pose.position();
  switch (t.output.state) {
    case kTakingScan:
      words.what = "Standing still to take a scan";
      words.why = "Something is in the lane to the goal; its edges are looked for at rest.";
      break;
    case kToEdge:
      words.what = "Driving past an edge";
      say(words.why,
          "The point beside the obstacle's edge is %.2f m away.",
          (t.output.pass_W.value_or(p) - p).norm());
      break;
    default:
      say_driving(t, words);
      words.what = "Driving straight to the goal";
  }
}

}  // namespace algo
