// algo/pipeline/reactive.cpp: behaviours, their coordinator and the actuator's limits.
#include "algo/pipeline/reactive.hpp"

#include <algorithm>
#include <cmath>

#include "algo/geometry.hpp"
#include "algo/pipeline/driver_link.hpp"

namespace algo {
namespace {

constexpr double kPulls = 0.05;     // of the stick's travel ahead
constexpr double kPullReach = 1.5;  // [m] to the pulled goal
constexpr LayerInfo kPull{.name = "teleop.pull",
                          .label = "Goal that the stick pulls along",
                          .kind = LayerKind::Points,
                          .tone = Tone::Internal};

TwistLimits intersect(const TwistLimits& a, const TwistLimits& b) {
  return {.v_min = std::max(a.v_min, b.v_min),
          .v_max = std::min(a.v_max, b.v_max),
          .omega_min = std::max(a.omega_min, b.omega_min),
          .omega_max = std::min(a.omega_max, b.omega_max)};
}

}  // namespace

Proposal AvoidBehaviour::propose(const Resource& in, ControlOutput& output) {
  if (pulls_goal(in)) return {};  // the driver's behaviour has asked the controller already
  ControlInput input = static_cast<const ControlInput&>(in);
  if (in.mission == Mission::Arrived) input.goal.reset();
  controller_->update(input, *in.parameters, output);
  return {.active = input.goal.has_value(),
          .twist = output.twist,
          .limits = {},
          .limit = {},
          .rates = output.joint_rates};
}

Twist2 AvoidBehaviour::follow(const Resource& in, const SetGoal& pulled, ControlOutput& output) {
  ControlInput input = static_cast<const ControlInput&>(in);
  input.goal = pulled;
  input.interrupted = false;
  controller_->update(input, *in.parameters, output);
  return output.twist;
}

bool pulls_goal(const Resource& in) {
  return in.manual && in.joystick.mode == StickMode::Elastic && in.joystick.forward > kPulls;
}

Proposal ManualBehaviour::propose(const Resource& in, ControlOutput& output) {
  guard_.sense(in);
  own_ring_.take(*in.observation);
  pull_W_.reset();
  const bool shared = in.manual && in.joystick.mode == StickMode::Wall;
  if (!shared) shared_.reset();
  if (!in.manual) {
    course_.reset();
    return {};
  }
  const Twist2 full = full_stick(in);
  const Twist2 wanted{in.joystick.forward * full.v, in.joystick.turn * full.omega};
  Proposal out{.active = true, .twist = wanted, .limits = {}, .limit = {}};
  if (in.joystick.mode == StickMode::Raw) {
    out.twist = capped_for_link(wanted, in.joystick);
    if (out.twist != wanted) out.limit = limits::kLink;
    return out;
  }
  if (shared) out.twist = shared_.share(in, own_ring_, wanted, out.limit);
  if (!pulls_goal(in)) course_.reset();
  if (pulls_goal(in)) {
    out.twist = pulled(in, full, output);
    out.limit = limits::kPulled;
  }
  out.twist = guarded(in, out.twist, out.limit);
  return out;
}

/// First as if the driver stood beside the robot, then as slow as the driver's link wants it.
Twist2 ManualBehaviour::guarded(const Resource& in, const Twist2& wanted, Limit& limit) {
  const Twist2 near = guard_.limit(in, wanted);
  if (near != wanted) limit = limits::kGuard;
  const double delay = driver_delay(in.joystick);
  if (delay == 0) return near;
  const Twist2 far = guard_.limit(in, near, delay);
  if (far != near) limit = limits::kLink;
  return far;
}

/// The controller's way to the goal, no faster than the stick asks for. The goal lies on the course
/// that the stick steers, not ahead of the hull: a robot that goes round an obstacle comes back to
/// it.
Twist2 ManualBehaviour::pulled(const Resource& in, const Twist2& full, ControlOutput& output) {
  const Pose2& here = in.odometry.pose;
  course_ = wrap_angle(course_.value_or(here.heading) + in.joystick.turn * full.omega * in.dt);
  pull_W_ = here.position() + kPullReach * direction(*course_);
  const Twist2 twist = avoid_.follow(in, {*pull_W_, std::nullopt}, output);
  const double most = in.joystick.forward * full.v;
  const double share = std::abs(twist.v) > most ? most / std::abs(twist.v) : 1.0;
  return {share * twist.v, share * twist.omega};
}

void ManualBehaviour::show(Telemetry& t) const {
  shared_.show(t);
  if (pull_W_) put(add_layer(t.layers, kPull, 2), *pull_W_);
}

void ManualBehaviour::reset(const Pose2& start_W) {
  guard_.reset(start_W);
  own_ring_.reset();
  shared_.reset();
  course_.reset();
}

void BehaviourCoordinator::reset(const Pose2& start_W) {
  for (Slot& slot : slots_) slot.behaviour->reset(start_W);
  sample_anew();
}

void BehaviourCoordinator::move(const MapMove& move, const Pose2& here_W) {
  for (Slot& slot : slots_) slot.behaviour->move(move, here_W);
  sample_anew();
}

void BehaviourCoordinator::sample_anew() {
  for (Slot& slot : slots_) {
    slot.held = {};
    slot.age = std::numeric_limits<double>::infinity();
  }
}

Decision BehaviourCoordinator::decide(const Resource& resource, ControlOutput& output) {
  Decision decision;
  for (Slot& slot : slots_) {
    slot.age += resource.dt;
    // Half a tick of slack: otherwise rounding could stretch a period of n ticks to n + 1.
    if (slot.age + resource.dt / 2 >= slot.behaviour->period()) {
      slot.held = slot.behaviour->propose(resource, output);
      slot.age = 0;
    }
    if (!decision.rates) decision.rates = slot.held.rates;
    if (!slot.held.active || decision.winner != behaviours::kRest) continue;
    decision.winner = slot.behaviour->name();
    decision.twist = slot.held.twist;
    decision.limit = slot.held.limit;
  }
  // A limit only bounds a motion; it never starts one.
  if (decision.winner == behaviours::kRest) return decision;
  TwistLimits common;
  for (const Slot& slot : slots_) {
    const Twist2 before = limited(decision.twist, common);
    common = intersect(common, slot.held.limits);
    if (limited(decision.twist, common) != before) decision.limit = slot.held.limits.reason;
  }
  decision.twist = limited(decision.twist, common);
  return decision;
}

Twist2 limited(const Twist2& twist, const TwistLimits& limits) {
  const bool contradictory = limits.v_min > limits.v_max || limits.omega_min > limits.omega_max;
  if (contradictory) return {};
  // clamp() lets NaN through to the gate; min() and max() would turn it into a limit.
  return {std::clamp(twist.v, limits.v_min, limits.v_max),
          std::clamp(twist.omega, limits.omega_min, limits.omega_max)};
}

Command actuate(const Twist2& twist, const RobotSpec& spec) {
  return {{std::clamp(twist.v, -spec.max_v, spec.max_v),
           std::clamp(twist.omega, -spec.max_omega, spec.max_omega)}};
}

Command actuate(const Decision& decision,
                const std::optional<JointReading>& joints,
                const RobotSpec& spec) {
  Command command = actuate(decision.twist, spec);
  if (!spec.arm) return command;
  command.joints = kArmJoints;
  if (!decision.rates || !joints) return command;
  for (std::size_t k = 0; k < kArmJoints; ++k) {
    const double most = spec.arm->rates[k];
    // No further than to the joint's limit. NaN stays, for the gate.
    const double low = std::min(0.0, (-spec.arm->limits[k] - joints->position[k]) / spec.period);
    const double high = std::max(0.0, (spec.arm->limits[k] - joints->position[k]) / spec.period);
    command.joint_rates[k] = std::clamp(std::clamp((*decision.rates)[k], -most, most), low, high);
  }
  return command;
}

}  // namespace algo
