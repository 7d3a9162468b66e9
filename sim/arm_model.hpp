// sim/arm_model.hpp: the arm of a simulated robot: its geometry, masses and motors.
#pragma once

#include <optional>
#include <string>

#include "algo/arm/mobile_arm.hpp"
#include "algo/arm_spec.hpp"

namespace sim {

/// The masses and torques are chosen (physics.md 7).
struct ArmModel : algo::ArmSpec {
  algo::JointValues masses{1.2, 1.5, 1.0, 1.0, 0.6, 0.5, 0.6};  // [kg] of the links
  algo::JointValues torques{40, 40, 25, 25, 10, 10, 5};         // [N m] that the motors have
  double payload = 0;                                           // [kg] in the hand
  double step_rate = 1000;                                      // [Hz] of the physics
  std::optional<algo::JointValues> start{};  // [rad] of the joints; absent: at rest
  bool operator==(const ArmModel&) const = default;

  double mass() const;  // [kg] of links and payload
  const algo::JointValues& begins() const { return start ? *start : rest; }
};

/// A defect of one of its numbers, as in "rest_deg: joint 2 is beyond its limit".
std::optional<std::string> defect(const ArmModel& arm);

/// The body that touches things: `arm` on a base of `radius` and `height` [m].
algo::MobileArm body_of(const ArmModel& arm, double radius, double height);

}  // namespace sim
