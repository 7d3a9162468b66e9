// algo/arm/hand_path_planner.hpp: where base and arm go while the hand follows a path.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algo/arm/reach_places.hpp"

namespace algo {

/// Configurations with the hand on its path, at most kHandStep apart there; the first is the start.
struct HandPathPlan {
  static constexpr double kHandStep = 0.04;  // [m]

  std::vector<BodyJoints> path{};  // empty if there is no way
  std::string why{};               // then the reason, as a sentence
};

/// From `start`, whose hand keeps its attitude, straight from point to point. A beam search over
/// short arcs of the base: at each step of the hand the arm's inverse, in the branch it is in,
/// closes the chain. `base_stays`: the arm alone moves. The same arguments give the same plan.
HandPathPlan plan_hand_path(const MobileArm& body,
                            const BodyJoints& start,
                            std::span<const Vec3> points_W,
                            bool base_stays,
                            std::span<const Solid> solids,
                            const ReachRules& rules = {});

}  // namespace algo
