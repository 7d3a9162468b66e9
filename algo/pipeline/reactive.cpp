// algo/pipeline/reactive.cpp: behaviours, their coordinator and the actuator's limits.
#include "algo/pipeline/reactive.hpp"

#include <algorithm>

namespace algo {
namespace {

TwistLimits intersect(const TwistLimits& a, const TwistLimits& b) {
  return {.v_min = std::max(a.v_min, b.v_min),
          .v_max = std::min(a.v_max, b.v_max),
          .omega_min = std::max(a.omega_min, b.omega_min),
          .omega_max = std::min(a.omega_max, b.omega_max)};
}

}  // namespace

Proposal AvoidBehaviour::propose(const Resource& in, ControlOutput& output) {
  ControlInput input = static_cast<const ControlInput&>(in);
  if (in.mission == Mission::Arrived) input.goal.reset();
  controller_->update(input, *in.parameters, output);
  return {.active = input.goal.has_value(), .twist = output.twist, .limits = {}, .limit = {}};
}

Proposal ManualBehaviour::propose(const Resource& in, ControlOutput& /*output*/) {
  guard_.sense(in);
  own_ring_.take(*in.observation);
  const bool shared = in.manual && in.joystick.mode == StickMode::Wall;
  if (!shared) shared_.reset();
  if (!in.manual) return {};
  const Twist2 full = full_stick(in);
  const Twist2 wanted{in.joystick.forward * full.v, in.joystick.turn * full.omega};
  Proposal out{.active = true, .twist = wanted, .limits = {}, .limit = {}};
  if (in.joystick.mode == StickMode::Raw) return out;
  if (shared) out.twist = shared_.share(in, own_ring_, wanted, out.limit);
  const Twist2 safe = guard_.limit(in, out.twist);
  if (safe != out.twist) out.limit = limits::kGuard;
  out.twist = safe;
  return out;
}

void ManualBehaviour::reset(const Pose2& start_W) {
  guard_.reset(start_W);
  own_ring_.reset();
  shared_.reset();
}

void BehaviourCoordinator::reset(const Pose2& start_W) {
  for (Slot& slot : slots_) {
    slot.behaviour->reset(start_W);
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

}  // namespace algo
