// algo/request.hpp: all requests of a person or a script. The browser, REST, tests and the record
// use the same values.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "algo/arm_spec.hpp"
#include "algo/name.hpp"
#include "algo/obstacle.hpp"
#include "algo/parameters.hpp"
#include "algo/types.hpp"

namespace algo {

struct SetGoal {
  Vec2 position_W{0, 0};
  std::optional<double> heading{};  // [rad] wanted on arrival; absent: any
  bool operator==(const SetGoal&) const = default;
};
/// Appends a goal to the queue; it becomes the current goal if there is none.
struct AddGoal {
  SetGoal goal{};
  bool operator==(const AddGoal&) const = default;
};
/// Replaces all goals. The robot goes to goals[next] and then on; no goals: it stays.
struct SetGoals {
  std::vector<SetGoal> goals{};
  std::uint32_t next = 0;  // below goals.size(), or 0
  bool loop = false;       // after the last goal, go on to the first
  bool operator==(const SetGoals&) const = default;
};
struct ClearGoal {
  bool operator==(const ClearGoal&) const = default;
};
struct AddObstacle {
  Obstacle obstacle{};
  bool operator==(const AddObstacle&) const = default;
};
/// Replaces the obstacle with the id of this one.
struct ChangeObstacle {
  Obstacle obstacle{};
  bool operator==(const ChangeObstacle&) const = default;
};
struct MoveObstacle {
  std::uint32_t id = 0;
  Pose2 pose_W{};
  bool operator==(const MoveObstacle&) const = default;
};
struct RemoveObstacle {
  std::uint32_t id = 0;
  bool operator==(const RemoveObstacle&) const = default;
};
/// How far a driver's stick is obeyed. It comes with every push, so a lost request cannot leave the
/// robot in a mode that its driver does not know.
enum class StickMode : std::uint8_t {
  Guarded,  // as far as the robot can still stop before all that it sees
  Wall,  // besides, slower where it is crowded, and along a wall at full stick (Park et al. 2005)
  Raw,   // as it is: only Stop, the bumpers and the watchdog hold
  Elastic,  // it pulls the goal of the run's controller along, which finds the way (ours)
};
inline constexpr const char* kStickModeList = "guarded, wall, raw, elastic";
/// "guarded", as REST and CSV spell it.
std::string_view name(StickMode mode);
/// The mode of that name; nothing if there is none.
std::optional<StickMode> stick_mode(std::string_view name);

/// A manual driver's stick; each axis in [-1, 1] of the robot's limits.
struct Joystick {
  double forward = 0;
  double turn = 0;  // left is positive
  StickMode mode = StickMode::Guarded;
  /// [s] How long the driver's hand takes to answer what the robot does, without the driver's own
  /// part: the round trip of the link. 0: beside the robot.
  double round_trip = 0;
  Name driver{};  // who gave it; empty: nobody knows
  bool centred() const { return forward == 0 && turn == 0; }
  bool operator==(const Joystick&) const = default;
};
/// `engaged` latches the robot at rest until a Stop{false} releases it.
struct Stop {
  bool engaged = true;
  bool operator==(const Stop&) const = default;
};
struct SetParameter {
  const ParameterInfo* parameter = nullptr;  // never null in a request that is carried out
  double value = 0;                          // in the parameter's unit
  bool operator==(const SetParameter&) const = default;
};

/// Turns the arm's joints straight to these positions.
struct SetJoints {
  JointValues position{};  // [rad]
  bool operator==(const SetJoints&) const = default;
};
/// A unit quaternion.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
  bool operator==(const Quaternion&) const = default;
};
inline constexpr std::size_t kMostPathPoints = 100;
inline constexpr double kLongestPath = 30;  // [m] of the hand: a plan takes time for each metre
/// Brings the hand to a pose, with arm and base.
struct SetHandGoal {
  Vec3 position_W{0, 0, 0};
  Quaternion attitude_W{};
  std::vector<Vec3> path_W{};  // to which the hand goes on in straight lines, turned the same
  std::optional<double> arm_angle{};  // [rad] at the goal, see arm_angle(); absent: any
  bool base_stays = false;            // the arm alone moves
  std::optional<SetGoal> then{};      // where the base goes after that, with the arm folded
  bool operator==(const SetHandGoal&) const = default;
};
/// Drives the base straight to a goal with the arm as it is, stretched out too. Arm and base yield
/// to what is in their way.
struct Carry {
  SetGoal goal{};
  bool operator==(const Carry&) const = default;
};
/// The plan that the robot asked for has come, and is followed from this tick on. The run itself
/// gives this request, so that the record has it and a replay repeats it.
struct TakePlan {
  bool operator==(const TakePlan&) const = default;
};
/// The robot is about here on the map that it knows: within 2 m and 0.5 rad. Without a pose it may
/// be anywhere.
struct SetInitialPose {
  std::optional<Pose2> pose_W{};
  bool operator==(const SetInitialPose&) const = default;
};

using Request = std::variant<SetGoal,
                             ClearGoal,
                             AddObstacle,
                             MoveObstacle,
                             RemoveObstacle,
                             Joystick,
                             Stop,
                             SetParameter,
                             AddGoal,
                             SetGoals,
                             ChangeObstacle,
                             SetJoints,
                             SetHandGoal,
                             Carry,
                             TakePlan,
                             SetInitialPose>;

}  // namespace algo
