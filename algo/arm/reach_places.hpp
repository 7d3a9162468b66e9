// algo/arm/reach_places.hpp: where a base may stand so that its arm brings the hand to a pose.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algo/arm/arm_planner.hpp"

namespace algo {

/// Bounds and steps of the search for a reach.
struct ReachRules {
  ArmPlanRules arm{};
  double room = 6;            // [m] half of the searched square about start and goal
  double cell = 0.05;         // [m] of the base's grid
  double base_margin = 0.08;  // [m] of the driving base
  double spacing = 0.20;      // [m] between configurations of the drive
  int places = 12;            // of the base, from which the arm tries to reach
  std::size_t skip = 0;       // of the best places, which come last: they have been tried
  bool here_first = false;    // the base drives only if the hand does not get there from its place
  std::optional<double> arm_angle{};  // [rad] at the goal; absent: the best one
};

/// The body with its arm folded, for driving: an upright cylinder up to the top of the arm, as wide
/// as base and arm.
class FoldedBody {
 public:
  explicit FoldedBody(const MobileArm& body);

  double height() const { return height_; }  // [m]
  /// [m] Between the body at `p_W` and the nearest solid; infinite without one.
  double room(const Vec2& p_W, std::span<const Solid> solids) const;

 private:
  double radius_;
  double height_;
};

/// The joints at which the hand of a body at `base_W` is at `hand_W`, clear of `solids`: of
/// the best solution of all and of each branch, the first that is clear. With `arm_angle` [rad],
/// the clear one of that angle that is farthest from the limits.
std::optional<ArmJoints> reaching_joints(const MobileArm& body,
                                         const Pose2& base_W,
                                         const Pose3& hand_W,
                                         std::span<const Solid> solids,
                                         const ArmPlanRules& rules = {},
                                         std::optional<double> arm_angle = std::nullopt);

struct ReachPlace {
  Pose2 base_W{};
  ArmJoints q = ArmJoints::Zero();
  double cost = 0;  // [m] the way from the start; more where it is tight or near a joint's limit
};

/// The places from which the hand gets to its pose, the best first.
std::vector<ReachPlace> reach_places(const MobileArm& body,
                                     const Vec2& start_W,
                                     const Pose3& hand_W,
                                     std::span<const Solid> solids,
                                     const ReachRules& rules = {});

}  // namespace algo
