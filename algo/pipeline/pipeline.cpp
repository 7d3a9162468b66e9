// algo/pipeline/pipeline.cpp: the steps of every period, in order.
#include "algo/pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "algo/dazzle.hpp"
#include "algo/gate.hpp"
#include "algo/geometry.hpp"
#include "algo/hull.hpp"
#include "algo/perceive.hpp"
#include "algo/pipeline/driver_link.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/teleop/teleop_parameters.hpp"

namespace algo {
namespace {

/// [m] Distance from a rectangular hull to the nearest return of all beams.
double rectangle_clearance(const LaserScan& scan, const RobotSpec& spec) {
  double least = scan.range_max - spec.radius;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok) continue;
    const Vec2 p = to_parent(scan.mount_R, scan.ranges[i] * direction(scan.angle(i)));
    least = std::min(least, to_rectangle(p, spec.half_length, spec.half_width));
  }
  return least;
}

constexpr LayerInfo kNearest{.name = "scan.nearest",
                             .label = "Nearest return of each side",
                             .kind = LayerKind::Points,
                             .tone = Tone::External,
                             .style = LayerStyle::Dashed};

/// [m] Distance to the nearest return of all beams. An obstacle abeam, outside both sides, counts
/// too, though it exerts no force.
double nearest_distance(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&least](const auto& found) {
    if (found) least = std::min(least, found->distance);
  };
  take(scene.right);
  take(scene.left);
  take(nearest_beam(scene.scan, {0, right_beams(scene.scan).begin}));
  take(nearest_beam(scene.scan, {left_beams(scene.scan).end, scene.scan.size()}));
  return std::isfinite(least) ? least : scene.scan.range_max;
}

constexpr const char* kNotFound =
    "Where the robot is on the map is not known: give an initial pose.";
constexpr const char* kNoArm = "This robot has no arm.";
constexpr double kUnitError = 1e-3;  // of a quaternion's length

bool within_unit(double axis) {
  return axis >= -1.0 && axis <= 1.0;
}  // false for NaN

/// [m] Of the hand's way from its goal on.
double path_length(const SetHandGoal& goal) {
  double length = 0;
  Vec3 last = goal.position_W;
  for (const Vec3& point : goal.path_W) {
    length += (point - last).norm();
    last = point;
  }
  return length;
}

}  // namespace

Pipeline::Pipeline(const PipelineConfig& config,
                   const RobotSpec& spec,
                   const ControllerCatalogue& controllers)
    : spec_(spec),
      by_hand_(config.by_hand),
      controller_(controllers.at(config.controller)),
      initial_parameters_(config.parameters),
      sensing_(config.filter) {
  if (spec.drives && spec.stance) {
    auto turnover = std::make_unique<TurnoverGuard>(spec);
    turnover_ = turnover.get();
    coordinator_.add(std::move(turnover));
  }
  auto avoid = std::make_unique<AvoidBehaviour>(controller_.make());
  avoid->begin(config.run);
  avoiding_ = &avoid->controller();
  if (spec.drives && spec.floor) {
    auto ground = std::make_unique<GroundBehaviour>(spec);
    ground_ = ground.get();
    coordinator_.add(std::move(ground));
  }
  if (spec.drives && by_hand_) {
    auto manual = std::make_unique<ManualBehaviour>(*avoid);
    manual_ = manual.get();
    coordinator_.add(std::move(manual));
  }
  if (spec.drives && spec.arm) {
    auto thinker = config.thinker ? config.thinker() : std::make_unique<LateThinker>();
    auto arm = std::make_unique<ArmBehaviour>(spec, config.declared, std::move(thinker));
    arm_ = arm.get();
    coordinator_.add(std::move(arm));
  }
  coordinator_.add(std::move(avoid));
  by_sonar_ = !spec.has_laser && controller_.by_sonar;
  const double delay = spec.period > 0 ? std::round(spec.command_delay / spec.period) : 0;
  under_way_.resize(static_cast<std::size_t>(delay));
  reset({});
}

void Pipeline::reset(const Pose2& start_W) {
  intent_ = {.parameters = initial_parameters_};
  intent_.reserve();
  coordinator_.reset(start_W);
  sequencer_.reset(spec_.period);
  scene_ = {};
  sensing_.reset();
  scan_stamp_.reset();
  tilt_stamp_.reset();
  blinded_ = false;
  clearance_ = 0;
  map_pose_.reset();
  joystick_ticks_ = 0;
  driver_ = behaviours::kRest;
  std::ranges::fill(under_way_, Twist2{});
  grids_.reset();
  narrator_.reset();
  by_ramps_ = spec_.uneven && !spec_.line && !spec_.floor;
  tick_ = 0;
}

std::optional<std::string> Pipeline::refusal(const Request& request) const {
  if (const auto* set = std::get_if<SetParameter>(&request)) {
    return refusal(intent_.parameters, *set);
  }
  const auto* add = std::get_if<AddGoal>(&request);
  if (add != nullptr && intent_.goals_ahead.size() >= kMostGoalsAhead) {
    return "There are " + std::to_string(kMostGoalsAhead) + " goals ahead; more are not kept.";
  }
  if (add != nullptr) return refusal_of(add->goal);
  if (const auto* goal = std::get_if<SetGoal>(&request)) return refusal_of(*goal);
  if (const auto* list = std::get_if<SetGoals>(&request)) return refusal_of(*list);
  if (const auto* joints = std::get_if<SetJoints>(&request)) return refusal_of(*joints);
  if (const auto* hand = std::get_if<SetHandGoal>(&request)) return refusal_of(*hand);
  const auto* at = std::get_if<SetInitialPose>(&request);
  if (at != nullptr && at->pose_W && !finite(*at->pose_W))
    return "The pose must be finite numbers.";
  if (const auto* carry = std::get_if<Carry>(&request)) {
    return arm_ == nullptr ? kNoArm : refusal_of(carry->goal);
  }
  if (const auto* stick = std::get_if<Joystick>(&request)) {
    if (!within_unit(stick->forward) || !within_unit(stick->turn)) {
      return "Joystick axes must lie between -1 and 1.";
    }
    if (!spec_.drives) return "This robot only replays a log; it cannot be driven.";
    if (!by_hand_) return "This robot drives by itself; it has no stick.";
    if (stick->mode == StickMode::Raw && !spec_.raw_stick) {
      return "This robot's file does not allow a stick without a guard (raw).";
    }
    if (auto reason = link_refusal(*stick)) return reason;
    if (stick->mode == StickMode::Wall) {
      return teleop_refusal(intent_.parameters, spec_.radius);
    }
  }
  return std::nullopt;
}

std::optional<std::string> Pipeline::refusal_of(const SetGoal& goal) const {
  const bool finite = goal.position_W.allFinite() && std::isfinite(goal.heading.value_or(0));
  if (!finite) return "The goal must be finite numbers.";
  if (!spec_.drives) return "This robot only replays a log; it cannot be sent to a goal.";
  if (map_pose_ && !map_pose_->located()) return kNotFound;
  return std::nullopt;
}

std::optional<std::string> Pipeline::refusal_of(const SetJoints& joints) const {
  if (arm_ == nullptr) return kNoArm;
  for (std::size_t k = 0; k < kArmJoints; ++k) {
    if (std::abs(joints.position[k]) <= spec_.arm->limits[k]) continue;  // false for NaN
    return "Joint " + std::to_string(k + 1) + " must lie within " +
           std::to_string(spec_.arm->limits[k]) + " rad to either side.";
  }
  return std::nullopt;
}

std::optional<std::string> Pipeline::refusal_of(const SetHandGoal& hand) const {
  if (arm_ == nullptr) return kNoArm;
  const Quaternion& a = hand.attitude_W;
  const double length = std::sqrt(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z);
  const auto good = [](const Vec3& point_W) { return point_W.allFinite(); };
  if (!good(hand.position_W) || !std::ranges::all_of(hand.path_W, good) ||
      !std::isfinite(hand.arm_angle.value_or(0))) {
    return "The hand's goal must be finite numbers.";
  }
  if (hand.path_W.size() > kMostPathPoints) {
    return "The hand's path has more than " + std::to_string(kMostPathPoints) + " points.";
  }
  if (!(path_length(hand) <= kLongestPath))
    return "The hand's path is longer than " + std::to_string(static_cast<int>(kLongestPath)) +
           " m.";
  if (!(std::abs(length - 1) < kUnitError)) return "The hand's attitude must be a unit quaternion.";
  return hand.then ? refusal_of(*hand.then) : std::nullopt;
}

std::optional<std::string> Pipeline::refusal_of(const SetGoals& list) const {
  if (list.goals.size() > kMostGoals) {
    return "The list has more than " + std::to_string(kMostGoals) + " goals.";
  }
  if (list.next >= std::max<std::size_t>(1, list.goals.size())) {
    return "The list of goals has no goal " + std::to_string(list.next) + ".";
  }
  for (const SetGoal& goal : list.goals) {
    if (auto problem = refusal_of(goal)) return problem;
  }
  return std::nullopt;
}

std::optional<std::string> Pipeline::refusal(const Parameters& now, const SetParameter& set) const {
  if (auto reason = algo::refusal(now, *set.parameter, set.value)) return reason;
  if (!controller_.refusal) return std::nullopt;
  Parameters then = now;
  then.set(*set.parameter, set.value);
  return controller_.refusal(then);
}

void Pipeline::tick(Telemetry& t) {
  look(t);
  decide(t);
}

void Pipeline::look(Telemetry& t) {
  t.tick = tick_++;
  if (joystick_ticks_ > 0) --joystick_ticks_;
  for (const Request& request : t.requests) apply(request);

  notice_jump(t.observation);
  sense(t);     // filter the newest scan, find the nearest return of each side
  sequence(t);  // take the next goal where one is reached
}

void Pipeline::decide(Telemetry& t) {
  control(t);                  // let behaviours propose, pick one
  hold(t);                     // the gate has the last word
  if (turnover_ != nullptr) {  // even a stop brakes no harder than the robot stands
    t.command.base.v = turnover_->eased(t.command.base.v, t.observation.odometry);
  }
  remember(t.command.base);
  narrator_.tell(*avoiding_, arm_, by_ramps_, t);  // explains the tick, now and then
}

void Pipeline::notice_ramp(const Request& edit) {
  const auto* const add = std::get_if<AddObstacle>(&edit);
  const auto* const change = std::get_if<ChangeObstacle>(&edit);
  const bool ramp = (add != nullptr && is_ground(add->obstacle)) ||
                    (change != nullptr && is_ground(change->obstacle));
  by_ramps_ = by_ramps_ || (ramp && !spec_.line && !spec_.floor);
}

void Pipeline::apply(const Request& request) {
  if (arm_ != nullptr) arm_->apply(request);
  if (is_edit(request)) return notice_ramp(request);  // carried out by the robot
  if (intent_.apply(request)) sequencer_.begin(intent_);
  if (std::holds_alternative<Joystick>(request)) {
    joystick_ticks_ = static_cast<std::uint64_t>(
        std::ceil(intent_.parameters[algo::kJoystickTimeout] / spec_.period));
  }
}

/// A robot that was located anew, or whose map has moved, may have jumped: what behaviours remember
/// lies elsewhere.
void Pipeline::notice_jump(const Observation& observation) {
  const bool found =
      map_pose_ && observation.map_pose && map_pose_->epoch != observation.map_pose->epoch;
  map_pose_ = observation.map_pose;
  if (!found && !observation.map_move) return;
  if (found) {
    coordinator_.reset(observation.odometry.pose);
  } else {
    coordinator_.move(*observation.map_move, observation.odometry.pose);
  }
  sensing_.reset();
}

void Pipeline::sense(Telemetry& t) {
  const LaserScan* front = sensing_.take(t.observation, intent_.parameters, scene_.scan);
  scene_.fresh = front != nullptr;
  if (front != nullptr) {
    blinded_ = blinded(*front);
    if (!blinded_) scan_stamp_ = front->stamp;
    if (ground_ != nullptr) ground_->enter_edges(t.observation.odometry.pose, scene_.scan);
    perceive(t.observation.odometry.pose, scene_);
    t.scene.scan = scene_.scan;
  } else {
    // The frame comes from a pool: a stale scan's data must not be from another tick.
    t.scene.scan.resize(scene_.scan.size());
    t.scene.scan.stamp = scene_.scan.stamp;
  }
  if (!spec_.has_laser) sense_sonar(t);
  const auto& tilt = t.observation.inclinometer;
  if (tilt && std::isfinite(tilt->roll) && std::isfinite(tilt->pitch)) tilt_stamp_ = tilt->stamp;
  t.scene.fresh = scene_.fresh;
  t.scene.echoes = scene_.echoes;
  t.scene.left = scene_.left;
  t.scene.right = scene_.right;
  show_nearest(t);

  if (scene_.fresh) {
    clearance_ = spec_.half_length > 0 ? rectangle_clearance(scene_.scan, spec_)
                                       : nearest_distance(scene_) - spec_.radius;
  }
  t.clearance = clearance_;
}

/// Reads the sonar ring. Its stamps count only for controllers that drive by sonar: one that needs
/// a scanner is held.
void Pipeline::sense_sonar(Telemetry& t) {
  const Observation& observation = t.observation;
  const Vec2 p = observation.odometry.pose.position();
  perceive(observation.odometry.pose, observation.sonar, scene_);
  double nearest = 0;
  for (const RangeReading& reading : observation.sonar) {
    if (by_sonar_ && reading.status != Beam::Invalid) scan_stamp_ = reading.stamp;
    nearest = std::max(nearest, reading.range_max);
  }
  if (observation.sonar.empty()) return;
  for (const Echo& echo : scene_.echoes) {
    if (echo.hit) nearest = std::min(nearest, (echo.point_W - p).norm());
  }
  clearance_ = nearest - spec_.radius;
}

void Pipeline::show_nearest(Telemetry& t) const {
  t.layers.clear();
  Layer& nearest = add_layer(t.layers, kNearest, 4);
  for (const auto& side : {scene_.left, scene_.right}) {
    if (side) put(nearest, side->point_W);
  }
}

void Pipeline::sequence(Telemetry& t) {
  const bool lost = map_pose_ && !map_pose_->located();  // it may seem to be at the goal
  t.mission = lost ? sequencer_.mission() : sequencer_.update(t.observation.odometry.pose, intent_);
  t.goal = intent_.goal;
  t.goals_ahead.clear();
  for (const SetGoal& goal : intent_.goals_ahead) t.goals_ahead.push_back(goal);
}

void Pipeline::control(Telemetry& t) {
  Resource resource;
  resource.stamp = t.observation.stamp;
  resource.dt = spec_.period;
  resource.odometry = t.observation.odometry;
  resource.observation = &t.observation;
  resource.scene = &scene_;
  resource.merge = &sensing_.merge();
  resource.under_way = under_way_;
  resource.parameters = &intent_.parameters;
  resource.intent = &intent_;
  resource.spec = turnover_ != nullptr ? &turnover_->spec() : &spec_;
  resource.goal = t.goal;
  resource.mission = t.mission;
  resource.joystick = intent_.stick;
  resource.manual = joystick_ticks_ > 0;
  resource.interrupted = driver_ != behaviours::kRest && driver_ != behaviours::kAvoid;
  resource.grids = grids_wanted_ && grids_.due(t.observation.stamp);
  const Decision decision = coordinator_.decide(resource, t.output);
  if (resource.grids) grids_.thin(t.observation.stamp, t.output.layers);
  if (manual_ != nullptr) manual_->show(t);
  if (turnover_ != nullptr) turnover_->show(t);
  if (ground_ != nullptr) ground_->show(t);
  driver_ = decision.winner;
  t.behaviour = decision.winner;
  t.limit = decision.limit;
  t.command = actuate(decision, t.observation.joints, spec_);
  if (arm_ == nullptr) return;
  const Command wanted = t.command;
  t.command = arm_->guarded(resource, wanted);
  if (t.command != wanted) t.limit = limits::kArmNear;
  t.mission = arm_->mission().value_or(t.mission);
  if (intent_.carry_goal) t.goal = intent_.carry_goal;  // for people
}

void Pipeline::hold(Telemetry& t) {
  GateInput in;
  in.stopped = intent_.stop;
  in.scan_timeout = intent_.parameters[kScanTimeout];
  in.scan_stamp = scan_stamp_;
  in.blinded = blinded_;
  in.hidden = t.command.base.v > 0 && hidden(scene_.scan, spec_);
  in.by_hand = t.behaviour == behaviours::kManual;
  in.needs_tilt = spec_.drives && (spec_.stance || spec_.inclinometer);
  in.tilt_timeout = intent_.parameters[kTiltTimeout];
  in.tilt_stamp = tilt_stamp_;
  in.needs_joints = arm_ != nullptr;
  t.hold = gate(in, t.observation, t.command);
  if (arm_ != nullptr) arm_->show(t);
  if (!t.hold) return;
  t.command = {.joints = t.command.joints};
  sequencer_.interrupt();
  if (t.mission == Mission::Driving || t.mission == Mission::Stuck) t.mission = Mission::Held;
}

/// Stores a command, which acts after the robot's delay.
void Pipeline::remember(const Twist2& command) {
  if (under_way_.empty()) return;
  std::ranges::rotate(under_way_, under_way_.begin() + 1);
  under_way_.back() = command;
}

}  // namespace algo
