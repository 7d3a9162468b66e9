// server/lab/reproduce/simulated_hand.hpp: a driver's hand on a stick that pushes back.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "algo/request.hpp"

namespace server::reproduce {

/// The way in which a hand gives way, as a spring with a damper on either axis.
struct HandConfig {
  double time_constant = 0.15;    // [s] of the first order
  double forward_compliance = 0;  // share of the stick's travel that full force displaces it by
  double turn_compliance = 0;
};

/// The deflection that the driver means from `stamp` on.
struct Intention {
  double stamp = 0;  // [s] run clock
  double forward = 0;
  double turn = 0;
};

/// Each axis q tends to the driver's intention plus the displacement by the force F:
/// T dq/dt = intention + compliance F - q. Without a force the hand stays where the driver means it
/// to be: it knows nothing about the robot or its surroundings.
class SimulatedHand {
 public:
  explicit SimulatedHand(const HandConfig& config) : config_(config) {}

  /// Holds the force for `dt` [s]. `force_forward`, `force_left`: of full force, as the record's
  /// measures teleop.force_forward and teleop.force_left.
  void feel(const Intention& means, double force_forward, double force_left, double dt) {
    const double share = 1 - std::exp(-dt / config_.time_constant);
    const auto move = [share](double& q, double target) {
      q = std::clamp(q + share * (target - q), -1.0, 1.0);
    };
    move(stick_.forward, means.forward + config_.forward_compliance * force_forward);
    move(stick_.turn, means.turn + config_.turn_compliance * force_left);
  }
  const algo::Joystick& stick() const { return stick_; }

 private:
  HandConfig config_{};
  algo::Joystick stick_{.mode = algo::StickMode::Wall};
};

/// The newest of `script`, which is sorted by time, at `stamp` [s, run clock]; rest before the
/// first.
inline Intention intention_at(std::span<const Intention> script, double stamp) {
  Intention now;
  for (const Intention& each : script) {
    if (each.stamp <= stamp + 1e-9) now = each;
  }
  return now;
}

}  // namespace server::reproduce
