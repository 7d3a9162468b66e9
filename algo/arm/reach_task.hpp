// algo/arm/reach_task.hpp: brings the hand to a pose: plans, drives, reaches, and plans again where
// it has to.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "algo/arm/body_follower.hpp"
#include "algo/arm/reach_planner.hpp"

namespace algo {

/// The sequencing layer of a reach: its legs one after another. It plans anew when the base has
/// come to stand where the hand does not get to its goal, or when the body has waited too long.
class ReachTask {
 public:
  enum class State : std::uint8_t { Goes, Waits, Arrived, GivenUp };

  ReachTask(const MobileArm& body, const BodyLimits& limits, const ReachRules& rules = {});

  /// Plans the way from `now`; allocates, and takes up to some tenths of a second.
  void begin(const BodyJoints& now,
             const Pose3& hand_W,
             std::span<const Solid> solids,
             std::uint64_t seed);

  /// One tick of `dt` [s] for a body at `now`. Plans before the last leg and after a long wait.
  /// Allocates only then, and where a leg begins.
  BodyCommand update(const BodyJoints& now, std::span<const Solid> solids, double dt);

  State state() const { return state_; }
  /// What the body does, or why it does not, as a sentence.
  std::string words() const;
  /// The present plan; empty if there is none.
  std::span<const ReachLeg> legs() const { return legs_; }
  /// How often it has planned.
  int plans() const { return plans_; }

 private:
  /// False if there is no way; why_ then says why.
  bool plan_anew(const BodyJoints& now, std::span<const Solid> solids);
  void next_leg(const BodyJoints& now, std::span<const Solid> solids);
  void give_up();

  MobileArm body_;
  ReachRules rules_;
  BodyFollower follower_;
  Pose3 hand_W_ = Pose3::Identity();
  std::uint64_t seed_ = 0;
  std::vector<ReachLeg> legs_{};
  std::size_t leg_ = 0;
  double still_ = 0;  // [s] without a motion
  int plans_ = 0;
  std::string why_{};  // the reason, where there is no way
  State state_ = State::Arrived;
};

}  // namespace algo
