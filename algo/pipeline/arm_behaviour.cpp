// algo/pipeline/arm_behaviour.cpp: goals of hand and joints, the task's plans, and the drawings.
#include "algo/pipeline/arm_behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "algo/perceive.hpp"

namespace algo {
namespace {

constexpr double kArmTau = 0.1;          // [s] in which the joints take the last of their way
constexpr double kJointsThere = 0.002;   // [rad]
constexpr double kBaseStands = 0.02;     // [m/s, rad/s] of the odometry: less is its noise
constexpr double kMostReachSpeed = 0.4;  // [m/s] of the base: it can stop within the task's horizon
constexpr double kMostReachTurn = 0.8;   // [rad/s]
constexpr double kSight = 3;             // [m] of the task, from R
constexpr double kSameBody = 0.15;       // [m] a piece so near to a moving body is of it
constexpr double kShownNear = 0.5;       // [m] of a link to a thing
constexpr double kShowPlan = 1;          // [s] between two showings of one plan

constexpr LayerInfo kStripLayer{.name = "arm.strip",
                                .label = "Way of the hand",
                                .kind = LayerKind::Polyline,
                                .tone = Tone::Elastic,
                                .axes = 3};
constexpr LayerInfo kPathLayer{.name = "arm.path",
                               .label = "Path that the hand shall follow",
                               .kind = LayerKind::Polyline,
                               .tone = Tone::Plan,
                               .axes = 3};
constexpr LayerInfo kNearLayer{.name = "arm.near",
                               .label = "Nearest things of the links",
                               .kind = LayerKind::Arrows,
                               .tone = Tone::External,
                               .axes = 3,
                               .unit = "m"};

Pose3 pose_of(const SetHandGoal& goal) {
  const Quaternion& a = goal.attitude_W;
  Pose3 pose = Pose3::Identity();
  pose.linear() = Eigen::Quaterniond(a.w, a.x, a.y, a.z).normalized().toRotationMatrix();
  pose.translation() = goal.position_W;
  return pose;
}

/// One of the two goals is given.
ReachGoal goal_of(const std::optional<SetHandGoal>& hand, const std::optional<SetGoal>& carry) {
  if (!hand) return {.then = carry, .carries = true};
  return {.hand_W = pose_of(*hand),
          .path_W = hand->path_W,
          .arm_angle = hand->arm_angle,
          .base_stays = hand->base_stays,
          .then = hand->then};
}

BodyLimits body_limits(const RobotSpec& spec) {
  return {.max_v = std::min(kMostReachSpeed, spec.max_v),
          .max_omega = std::min(kMostReachTurn, spec.max_omega),
          .max_rate = *std::ranges::min_element(spec.arm->rates),
          .max_acceleration = spec.max_acceleration};
}

bool stands(const Odometry& odometry, const JointReading& joints) {
  const auto still = [](double rate) { return std::abs(rate) < kBaseStands; };
  return still(odometry.twist.v) && still(odometry.twist.omega) &&
         std::ranges::all_of(joints.rate, still);
}

ReachRules session_rules() {
  ReachRules rules;
  rules.here_first = true;
  return rules;
}

}  // namespace

ArmBehaviour::ArmBehaviour(const RobotSpec& spec,
                           std::vector<Obstacle> declared,
                           std::unique_ptr<ReachThinker> thinker)
    : spec_(spec),
      body_(mobile_arm(*spec.arm, spec.radius)),
      declared_(std::move(declared)),
      thinker_(std::move(thinker)),
      guard_(spec),
      task_(body_, body_limits(spec), session_rules()) {}

void ArmBehaviour::reset(const Pose2& /*start_W*/) {
  known_.reset(declared_, spec_.arm->scan_height);
  task_ = ReachTask(body_, body_limits(spec_), session_rules());
  goals_ = 0;
  begun_ = false;
  asked_.reset();
  take_ = false;
  shown_.reset();
  shown_plan_ = 0;
  now_.reset();
  points_.reset();
  ahead_.reset();
  beside_.reset();
  hand_goal_.reset();
  carry_goal_.reset();
  joint_goal_.reset();
  state_ = ArmState::Rest;
}

void ArmBehaviour::apply(const Request& request) {
  if (is_edit(request)) known_.apply(request);
  if (std::holds_alternative<TakePlan>(request)) take_ = true;
}

bool ArmBehaviour::plan_ready() const {
  return asked_ && !take_ && stamp_ - *asked_ >= kThinkTime && thinker_->ready();
}

void ArmBehaviour::sense(const Resource& in) {
  const Observation& seen = *in.observation;
  stamp_ = in.stamp;
  now_.reset();
  if (!finite(seen.odometry.pose) || !std::isfinite(seen.stamp)) return;
  look(seen);
  unseen_.clear();
  for (MoverWatch* watch : {&ahead_, &beside_}) {
    watch->each(seen.stamp, [this](const Track& track) { see_move(track); });
  }
  known_.find_near(seen.odometry.pose.position(), kSight, near_);
  near_.insert(near_.end(), unseen_.begin(), unseen_.end());
  keep_ahead_free(near_);
  if (!seen.joints) return;
  const ArmJoints q = joints_of(seen.joints->position);
  if (q.allFinite()) now_ = body_joints(seen.odometry.pose, q);
}

/// A body that no scanner sees any more goes on.
void ArmBehaviour::see_move(const Track& track) {
  if (known_.set_moving(track.position_W, track.radius + kSameBody, track.velocity_W)) return;
  Solid& body = unseen_.emplace_back();
  body.centre_W = track.position_W;
  body.rounding = track.radius;
  body.velocity_W = track.velocity_W;
}

/// Each beam is mapped from where the robot was when it was fired.
void ArmBehaviour::look(const Observation& seen) {
  points_.follow(seen.odometry.pose, seen.stamp);
  const LaserScan* const ahead = front_scan(seen);
  MoverWatch* other = &beside_;  // a tracker follows one scanner
  for (const LaserScan& scan : seen.scans) {
    const bool readable = scan.size() > 0 && std::isfinite(scan.stamp) && all_finite(scan.ranges);
    if (!readable) continue;  // NaN must not enter
    const Pose2 sensor_W = points_.map(scan);
    known_.see(scan, sensor_W, points_.points_W());
    MoverWatch* const watch = &scan == ahead ? &ahead_ : std::exchange(other, nullptr);
    if (watch != nullptr) watch->take(scan, sensor_W, points_.points_W());
  }
}

Proposal ArmBehaviour::propose(const Resource& in, ControlOutput& /*output*/) {
  sense(in);
  hand_goal_ = in.intent->hand_goal;
  carry_goal_ = in.intent->carry_goal;
  joint_goal_ = in.intent->joint_goal;
  const bool wants_base = hand_goal_ || carry_goal_;
  const bool is_new = goals_ != in.intent->arm_goals;
  goals_ = in.intent->arm_goals;
  if (is_new || !wants_base) {
    begun_ = false;
    asked_.reset();
  }
  const bool take = std::exchange(take_, false);
  state_ = ArmState::Rest;
  Proposal out;
  if (!now_) return out;
  if (take && asked_) {
    asked_.reset();
    task_.take(thinker_->take(), *now_, known_.all());
  }
  const auto drive = wants_base ? reach(in) : turn(in);
  if (!drive) return out;
  out.active = wants_base;
  out.twist = drive->base;
  out.rates = drive->rates;
  return out;
}

/// A step of the task. The robot stands before it plans, so that the plan begins where it is.
std::optional<ArmBehaviour::Drive> ArmBehaviour::reach(const Resource& in) {
  state_ = ArmState::Plans;
  if (!begun_) {
    if (!stands(in.odometry, *in.observation->joints)) return Drive{};
    task_.begin(*now_, goal_of(hand_goal_, carry_goal_), known_.all(), goals_);
    begun_ = true;
  }
  task_.set_sweeps(static_cast<int>((*in.parameters)[kArmSweeps]));
  task_.set_hand_speed((*in.parameters)[kHandSpeed]);
  const BodyCommand command = task_.update(*now_, near_, known_.all(), in.dt);
  if (task_.question() != nullptr && !asked_) {
    thinker_->ask(body_, *task_.question());
    asked_ = in.stamp;
  }
  switch (task_.state()) {
    case ReachTask::State::Plans:
      break;
    case ReachTask::State::Goes:
      state_ = ArmState::Goes;
      break;
    case ReachTask::State::Waits:
      state_ = ArmState::Waits;
      break;
    case ReachTask::State::Arrived:
      state_ = ArmState::Arrived;
      break;
    case ReachTask::State::GivenUp:
      state_ = ArmState::GivenUp;
      break;
  }
  return Drive{command.base, values_of(command.rates)};
}

/// The joints straight to where they are set: all arrive at once.
std::optional<ArmBehaviour::Drive> ArmBehaviour::turn(const Resource& in) {
  if (!joint_goal_) return std::nullopt;
  const ArmJoints change = joints_of(joint_goal_->position) - arm_of(*now_);
  const double left = change.cwiseAbs().maxCoeff();
  state_ = left < kJointsThere ? ArmState::Arrived : ArmState::Turns;
  double time = std::max(kArmTau, in.dt);
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    time = std::max(time, std::abs(change[k]) / spec_.arm->rates[static_cast<std::size_t>(k)]);
  }
  return Drive{{}, values_of(change / time)};
}

Command ArmBehaviour::guarded(const Resource& in, const Command& command) const {
  if (!now_) return command;  // the gate holds it
  const ArmJoints rates = joints_of(in.observation->joints->rate);
  if (!rates.allFinite()) return command;  // the gate holds it
  return guard_.limited(*now_, {in.odometry.twist, rates}, near_, command);
}

std::optional<Mission> ArmBehaviour::mission() const {
  if (!hand_goal_ && !carry_goal_) return std::nullopt;
  if (state_ == ArmState::Arrived) return Mission::Arrived;
  return state_ == ArmState::GivenUp ? Mission::Stuck : Mission::Driving;
}

void ArmBehaviour::show(Telemetry& t) {
  ArmTelemetry& arm = t.arm;
  arm.present = true;
  arm.state = state_;
  arm.hand_goal = hand_goal_;
  arm.joint_goal = joint_goal_;
  arm.ghost.clear();
  const bool has_plan = (hand_goal_ || carry_goal_) && begun_ && !task_.legs().empty();
  arm.plan = has_plan ? task_.changes() : 0;
  const bool is_new =
      arm.plan != shown_plan_ || !shown_ || t.observation.stamp - *shown_ >= kShowPlan;
  arm.plan_fresh = has_plan && is_new;
  if (arm.plan_fresh) {
    for (const ReachLeg& leg : task_.legs()) {
      for (const BodyJoints& q : leg.path) {
        std::copy(q.begin(), q.end(), arm.ghost.append().begin());
      }
    }
    shown_ = t.observation.stamp;
    shown_plan_ = arm.plan;
  }
  show_things(t);
  Layer& path = add_layer(t.layers, kPathLayer);
  if (hand_goal_ && !hand_goal_->path_W.empty()) {
    put(path, hand_goal_->position_W);
    for (const Vec3& point_W : hand_goal_->path_W) put(path, point_W);
  }
  Layer& strip = add_layer(t.layers, kStripLayer);
  if (!has_plan || !now_) return;
  for (const BodyFrames& ahead : task_.strip().frames()) put(strip, ahead.hand());
}

/// The clearance of each link, and an arrow from a link to the thing that is near it.
void ArmBehaviour::show_things(Telemetry& t) const {
  Layer& arrows = add_layer(t.layers, kNearLayer, 6 * kBodyLinks);
  if (!now_) return;
  const BodyFrames frames = body_frames(body_, *now_);
  t.arm.own_clearance = self_clearance(body_, frames);
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const auto part = static_cast<BodyLink>(k);
    const LinkAxis link = link_axis(body_, frames, part);
    NearestOnLink least{.distance = std::numeric_limits<double>::infinity()};
    for (const Solid& solid : near_) {
      const NearestOnLink there = nearest(link, solid);
      if (there.distance < least.distance) least = there;
    }
    t.arm.clearance[k] = least.distance;
    if (part == BodyLink::Base || !(least.distance < kShownNear)) continue;
    put(arrows, least.point_W, Vec3(-(least.distance + link.radius) * least.away));
  }
}

void ArmBehaviour::explain(const Telemetry& t, Explanation& words) const {
  switch (state_) {
    case ArmState::Rest:
      return;
    case ArmState::Turns:
      words.what = "Turning the joints";
      words.why = "The arm goes straight to where they are set.";
      break;
    case ArmState::Plans:
      words.what = "Looking for a way";
      words.why = "The robot stands while it plans its way to the goal.";
      break;
    case ArmState::Goes:
    case ArmState::Waits:
      words.what = state_ == ArmState::Waits ? "Waiting" : carry_goal_ ? "Carrying" : "Reaching";
      words.why = task_.words();
      break;
    case ArmState::Arrived:
      words.what = "Arrived";
      words.why = hand_goal_ || carry_goal_ ? task_.words() : "The joints are where they are set.";
      break;
    case ArmState::GivenUp:
      words.what = "No way to the goal";
      words.why = task_.words();
      break;
  }
  if (!t.limit) return;
  words.why += ' ';
  words.why += t.limit.why;
}

}  // namespace algo
