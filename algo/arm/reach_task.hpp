// algo/arm/reach_task.hpp: brings the hand to a pose: asks for a plan, drives, reaches, and asks
// again where it has to.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algo/arm/body_follower.hpp"
#include "algo/arm/hand_path.hpp"
#include "algo/arm/reach_planner.hpp"

namespace algo {

/// Where hand or base are to get, and how.
struct ReachGoal {
  Pose3 hand_W = Pose3::Identity();
  std::vector<Vec3> path_W{};         // of the hand, on from there
  std::optional<double> arm_angle{};  // [rad] at the goal; absent: the best one
  bool base_stays = false;            // the arm alone moves
  std::optional<SetGoal> then{};      // of the base, after all that
  bool carries = false;               // there is no goal of the hand: the arm goes along as it is
};

/// The sequencing layer of a reach: its legs one after another, then the hand's path, then back. It
/// asks for a plan and stands until it has come: at the start, when the base has come to stand
/// before the last leg, when the hand does not get to its goal from there, and when the body has
/// waited too long.
class ReachTask {
 public:
  enum class State : std::uint8_t { Plans, Goes, Waits, Arrived, GivenUp };

  ReachTask(const MobileArm& body, const BodyLimits& limits, const ReachRules& rules = {});

  /// Sets the goal of a body that stands at `now`.
  void begin(const BodyJoints& now,
             const ReachGoal& goal,
             std::span<const Solid> solids,
             std::uint64_t seed);

  /// The plan that it waits for; null if it waits for none.
  const ReachQuestion* question() const { return question_ ? &*question_ : nullptr; }
  /// The answer to question(), for a body at `now`. May leave another question.
  void take(ReachPlan found, const BodyJoints& now, std::span<const Solid> solids);

  /// One tick of `dt` [s] for a body at `now`: it keeps clear of what is `near`, and plans anew
  /// with `all`. Allocates only where it asks and where a leg begins.
  BodyCommand update(const BodyJoints& now,
                     std::span<const Solid> near,
                     std::span<const Solid> all,
                     double dt);

  /// Of the strip, in one tick.
  void set_sweeps(int sweeps) { follower_.set_sweeps(sweeps); }
  void set_hand_speed(double speed) { path_.set_speed(speed); }  // [m/s] along its path

  State state() const { return state_; }
  /// What the body does, or why it does not, as a sentence.
  std::string words() const;
  /// The present plan; empty if there is none.
  std::span<const ReachLeg> legs() const { return legs_; }
  /// Counts the changes of the plan.
  std::uint32_t changes() const { return changes_; }
  const BodyStrip& strip() const { return follower_.strip(); }
  /// How often it has got a plan of the whole way, or none.
  int plans() const { return plans_; }

 private:
  enum class Stage : std::uint8_t { There, Path, Back };
  /// What is asked for now: the way to the goal of the hand or of the base.
  ReachQuestion::Kind way() const;
  /// The question leaves out moving solids: they will be elsewhere.
  void ask(ReachQuestion::Kind kind, const BodyJoints& now, std::span<const Solid> solids);
  /// Asks for the whole way again, with other places first, or gives up.
  void ask_anew(const BodyJoints& now, std::span<const Solid> solids);
  void take_whole(ReachPlan found, const BodyJoints& now);
  void follow(const BodyJoints& now);
  void next_leg(const BodyJoints& now, std::span<const Solid> solids);
  /// The hand is at its goal, or at the end of its path: begins the next stage, if there is one.
  bool go_on(const BodyJoints& now, std::span<const Solid> solids);
  BodyCommand step(const BodyJoints& now, std::span<const Solid> near, double dt);
  /// The points of the path that are ahead of the hand.
  std::vector<Vec3> path_left() const;
  void give_up();

  MobileArm body_;
  ReachRules rules_;
  BodyFollower follower_;
  HandPath path_;
  double followed_ = 0;  // [m] of the hand's path, on the legs before this one
  ReachGoal goal_{};
  std::uint64_t seed_ = 0;
  Stage stage_ = Stage::There;
  std::optional<ReachQuestion> question_{};
  std::vector<ReachLeg> legs_{};
  std::size_t leg_ = 0;
  double still_ = 0;  // [s] without a motion
  int plans_ = 0;
  std::uint32_t changes_ = 0;
  std::string why_{};  // the reason, where there is no way
  State state_ = State::Arrived;
};

/// Answers the task's questions at once.
void answer_at_once(ReachTask& task,
                    const MobileArm& body,
                    const BodyJoints& now,
                    std::span<const Solid> solids);

}  // namespace algo
