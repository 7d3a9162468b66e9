// algo/arm/reach_planner.hpp: a way of base and arm that brings the hand to a pose.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algo/arm/reach_places.hpp"
#include "algo/request.hpp"

namespace algo {

/// A part of a way, which one strip follows. Its first configuration is the last one of the part
/// before.
struct ReachLeg {
  enum class Kind : std::uint8_t { Arm, Turn, Drive, Follow };
  Kind kind = Kind::Arm;
  std::vector<BodyJoints> path{};
};
/// "drives", as the page says.
std::string_view name(ReachLeg::Kind kind);

/// The way of a reach: the arm folds, the base turns and drives straight from corner to corner, and
/// the arm reaches out while the base stands.
struct ReachPlan {
  std::vector<ReachLeg> legs{};  // empty if there is no way
  std::string why{};             // then the reason, as a sentence
};

/// From `start` to the hand at `hand_W`. First the places of the base are found from which the hand
/// gets there clear of `solids` (reach_places()); from the best one on, a way of the base with the
/// arm folded (A*), and one of the arm (plan_arm()). The same arguments give the same
/// plan. With `path_W`, only places count from which the hand can go on along it.
ReachPlan plan_reach(const MobileArm& body,
                     const BodyJoints& start,
                     const Pose3& hand_W,
                     std::span<const Solid> solids,
                     std::uint64_t seed,
                     const ReachRules& rules = {},
                     std::span<const Vec3> path_W = {});

/// The last leg anew, for a base that has come to stand at `now`, a little off its place. None if
/// the hand does not get there from where the base stands.
std::optional<ReachLeg> plan_last_reach(const MobileArm& body,
                                        const BodyJoints& now,
                                        const Pose3& hand_W,
                                        std::span<const Solid> solids,
                                        std::uint64_t seed,
                                        const ReachRules& rules = {});

/// Folds the arm and drives the base to `goal`.
ReachPlan plan_return(const MobileArm& body,
                      const BodyJoints& start,
                      const SetGoal& goal,
                      std::span<const Solid> solids,
                      std::uint64_t seed,
                      const ReachRules& rules = {});

/// Straight to `goal` with the arm as it is: the strip of arm and base yields to what is there.
ReachPlan plan_carry(const BodyJoints& start, const SetGoal& goal, const ReachRules& rules = {});

/// A plan that a body asks for.
struct ReachQuestion {
  enum class Kind : std::uint8_t {
    Whole,   // of the hand's way to its goal
    Last,    // of its last leg, from where the base stands
    Return,  // plan_return()
    Carry,   // plan_carry()
    Follow,  // plan_hand_path()
  };
  Kind kind = Kind::Whole;
  BodyJoints now = BodyJoints::Zero();
  Pose3 hand_W = Pose3::Identity();
  std::vector<Vec3> path_W{};  // of the hand, on from there
  bool base_stays = false;     // on that path
  SetGoal base_goal{};
  std::vector<Solid> solids{};
  std::uint64_t seed = 0;
  ReachRules rules{};
};
/// Takes up to some tenths of a second. The same question gets the same answer.
ReachPlan answer(const MobileArm& body, const ReachQuestion& question);

}  // namespace algo
