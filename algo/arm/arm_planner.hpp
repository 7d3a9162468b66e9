// algo/arm/arm_planner.hpp: a way for the arm, found by two random trees that grow towards each
// other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algo/arm/mobile_arm.hpp"

namespace algo {

/// The margins of a way, and the bounds of the search for it.
struct ArmPlanRules {
  double margin = 0.05;      // [m] from the links to solids
  double own_margin = 0.02;  // [m] from the arm to the body and the hand to the upper arm
  double stride = 0.30;      // [rad] by which a tree grows, over all joints
  double look = 0.04;        // [rad] between two looks at a motion
  int samples = 10000;       // of which each grows both trees
  int shortcuts = 100;       // that are tried on the way found
};

/// True if `body` at `q` keeps the margins.
bool is_clear(const MobileArm& body,
              const BodyJoints& q,
              std::span<const Solid> solids,
              const ArmPlanRules& rules = {});
/// The same along the straight motion from `from` to `to`, both included.
bool is_clear(const MobileArm& body,
              const BodyJoints& from,
              const BodyJoints& to,
              std::span<const Solid> solids,
              const ArmPlanRules& rules = {});

/// A way of the joints from `from` to `to` while the base stands at `base_W`, whose straight pieces
/// keep the margins; both ends are included. None when the search ends without one. RRT-Connect
/// (Kuffner and LaValle 2000) with shortcuts; the same arguments give the same way.
std::optional<std::vector<ArmJoints>> plan_arm(const MobileArm& body,
                                               const Pose2& base_W,
                                               const ArmJoints& from,
                                               const ArmJoints& to,
                                               std::span<const Solid> solids,
                                               std::uint64_t seed,
                                               const ArmPlanRules& rules = {});

}  // namespace algo
