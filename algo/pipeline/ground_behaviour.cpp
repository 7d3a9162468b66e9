// algo/pipeline/ground_behaviour.cpp: the survey as a behaviour.
#include "algo/pipeline/ground_behaviour.hpp"

#include <cmath>

#include "algo/geometry.hpp"

namespace algo {
namespace {

constexpr double kSilence = 0.3;  // [s] without a reading of the floor: eight periods

constexpr LayerInfo kEdge{.name = "ground.edge",
                          .label = "Edge on the ground, and refused ones",
                          .kind = LayerKind::Polyline,
                          .tone = Tone::Refused};
constexpr LayerInfo kVerdict{
    .name = "ground.verdict", .label = "The ground ahead", .kind = LayerKind::Text};
constexpr std::size_t kLongestVerdict = 80;

/// [m] x in R of the nearest return that the beams at `y` [m] of `sensors` may end on.
double obstacle_at(const LaserScan& scan, const FloorSensors& sensors, double y) {
  constexpr double kBeside = 0.05;  // [m] of a beam
  constexpr double kBeyond = 0.10;  // [m] of the foot of the far beam
  const double reach = sensors.x + kBeyond + sensors.height / std::tan(sensors.angle) +
                       sensors.separation / std::sin(sensors.angle);
  double nearest = reach;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok || scan.ranges[i] > reach + kBeyond) continue;
    const Vec2 p = beam_point_R(scan.mount_R, scan.angle(i), scan.ranges[i]);
    if (p.x() > 0 && p.x() < nearest && std::abs(p.y() - y) < kBeside) nearest = p.x();
  }
  return nearest < reach ? nearest : std::numeric_limits<double>::infinity();
}

}  // namespace

void GroundBehaviour::reset(const Pose2& /*start_W*/) {
  survey_.reset();
  verdict_.reserve(kLongestVerdict);
  pitch_ = 0;
  read_at_ = 0;
  has_read_ = false;
}

Proposal GroundBehaviour::propose(const Resource& in, ControlOutput& /*output*/) {
  const Observation& o = *in.observation;
  if (o.inclinometer && std::isfinite(o.inclinometer->pitch)) pitch_ = o.inclinometer->pitch;
  if (o.floor) {
    read_at_ = o.floor->stamp;
    has_read_ = true;
  }
  SurveyInput input{.stamp = in.stamp,
                    .dt = in.dt,
                    .pose_W = in.odometry.pose,
                    .pitch = pitch_,
                    .ranges = o.floor ? &*o.floor : nullptr};
  if (o.floor) {
    const FloorSensors& sensors = *in.spec->floor;
    input.obstacle_left = obstacle_at(in.scene->scan, sensors, sensors.half_spacing);
    input.obstacle_right = obstacle_at(in.scene->scan, sensors, -sensors.half_spacing);
  }
  const bool to_goal = in.goal && in.mission != Mission::Arrived;
  if (in.manual) {
    input.driver = SurveyDriver::Hand;
  } else if (to_goal) {
    input.driver = SurveyDriver::Goal;
  }
  if (!finite(input.pose_W)) return {};
  const SurveyAnswer answer = survey_.step(input, *in.parameters);
  Proposal out;
  out.limits.reason = {limits::kGround.name, answer.why};
  // Written so that a NaN stamp counts as silence.
  if (!has_read_ || !(in.stamp - read_at_ < kSilence)) {
    out.limits = {.v_min = 0, .v_max = 0, .omega_min = 0, .omega_max = 0};
    out.limits.reason = limits::kFloorSilent;
    return out;
  }
  out.limits.v_max = answer.v_max;
  out.limits.omega_min = answer.omega_min;
  out.limits.omega_max = answer.omega_max;
  if (answer.twist) {
    out.active = true;
    out.twist = *answer.twist;
    out.limit = out.limits.reason;
  }
  return out;
}

void GroundBehaviour::show(Telemetry& t) {
  const GroundFinding& finding = survey_.finding();
  verdict_.clear();
  say_ground(finding, verdict_);
  const bool open = finding.kind == GroundClass::Flat || finding.kind == GroundClass::Pending;
  if (!open) verdict_ += survey_.can_pass() ? ": can drive over it" : ": goes round it";

  Layer& edge = add_layer(t.layers, kEdge, 6 * RefusedEdges::kMost + 4);
  Vec2 at_W = t.observation.odometry.pose.position();
  if (const auto& ends = survey_.edge_W()) {
    put(edge, (*ends)[0], (*ends)[1]);
    at_W = ((*ends)[0] + (*ends)[1]) / 2;
  }
  survey_.refused().show(edge);
  Layer& text = add_layer(t.layers, kVerdict, 2);
  put(text, at_W);
  text.text = verdict_;

  auto& out = t.output.measures;
  out.push_back({"ground.class", "", static_cast<double>(finding.kind)});
  out.push_back({"ground.height", "m", finding.height});
  out.push_back({"ground.slope", "rad", finding.slope});
  out.push_back({"ground.width", "m", finding.width});
  out.push_back({"ground.confidence", "", finding.confidence});
}

}  // namespace algo
