// algo/telemetry.hpp: all data of one tick: sensed, requested, decided and commanded.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algo/layer.hpp"
#include "algo/name.hpp"
#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/request.hpp"
#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace algo {

/// The nearest valid return on one side.
struct Nearest {
  std::uint32_t beam = 0;
  Vec2 point_W{0, 0};
  double distance = 0;  // [m] from the robot's centre, not the raw range
  bool operator==(const Nearest&) const = default;
};

/// The newest reading of one sonar of a ring.
struct Echo {
  Pose2 mount_R{};
  double stamp = 0;    // [s] run clock
  bool hit = false;    // an obstacle was in range
  Vec2 point_W{0, 0};  // on the axis; meaningful only if `hit`
};

/// Perception's result from the newest scan. `scan` is filtered and may be older than this tick.
/// Without a scanner, `echoes` replaces it; left and right are then the nearest echoes, and their
/// beam is the index of the sonar.
struct Scene {
  LaserScan scan{};
  bool fresh = false;  // a new scan came this tick
  std::optional<Nearest> left{};
  std::optional<Nearest> right{};
  Recycled<Echo> echoes{};  // one per sonar, by first reading; empty with a scanner
};

/// A number from a controller's method, plotted by the page and read by judges.
struct Measure {
  std::string_view name{};  // "strip.internal"; in static storage, like the unit
  std::string_view unit{};  // "m"
  double value = 0;
};

/// A controller's decision, and the drawings and measures that explain it.
struct ControlOutput {
  Twist2 twist{};
  std::optional<JointValues> joint_rates{};  // [rad/s] of the arm; absent: it rests
  std::optional<Vec2> pass_W{};              // the point the base drives to
  bool waits = false;                        // it may stand still now; its words give the reason
  std::uint8_t state = 0;  // the controller's own; a change prompts new words at once
  bool answered = false;   // from outside the program: the record keeps both as inputs
  Recycled<Measure> measures{};
  Recycled<Layer> layers{};

  std::optional<double> measure(std::string_view name) const;
  /// Clears everything but keeps the buffers for the next tick.
  void clear();
};

/// One sentence for the robot's action and one for the reason, with the numbers.
struct Explanation {
  std::string what{};
  std::string why{};
  bool operator==(const Explanation&) const = default;
};

/// Why the gate replaced the command by zero; no name: it did not. The component that holds the
/// robot gives the reason (algo/gate.hpp).
struct Hold {
  Name name{};              // "stale_scan"
  std::string_view what{};  // "Waiting for the laser"; for people, without numbers
  std::string_view why{};   // a sentence; both are in static storage and not restored from a record
  explicit operator bool() const { return !name.empty(); }
  friend bool operator==(const Hold& a, const Hold& b) { return a.name == b.name; }
};

/// Why a command is below the wanted one; no name: nothing limits it.
struct Limit {
  Name name{};             // "turnover"
  std::string_view why{};  // a sentence, as in Hold
  explicit operator bool() const { return !name.empty(); }
  friend bool operator==(const Limit& a, const Limit& b) { return a.name == b.name; }
};

/// The sequencing layer's state.
enum class Mission : std::uint8_t { Idle, Driving, Arrived, Stuck, Held };

/// What the arm does.
enum class ArmState : std::uint8_t {
  Rest,     // it has nothing to do
  Turns,    // its joints, to where a person sets them
  Plans,    // the body stands and waits for its plan
  Goes,     // along its plan
  Waits,    // for something to get out of its way
  Arrived,  // the hand is at its goal, or the joints are
  GivenUp,  // there is no way to the goal
};
/// "given_up", as REST and CSV spell it.
std::string_view name(ArmState state);

/// x [m], y [m] and yaw [rad] of R in W, then the joints [rad].
using GhostPose = std::array<double, 3 + kArmJoints>;

/// The arm in one tick, of a robot that has one.
struct ArmTelemetry {
  bool present = false;
  ArmState state = ArmState::Rest;
  std::optional<SetHandGoal> hand_goal{};
  std::optional<SetJoints> joint_goal{};
  std::array<double, kBodyLinks> clearance{};  // [m] of each link to all that the robot knows
  double own_clearance = 0;                    // [m] of the arm to the robot itself
  std::uint32_t plan = 0;                      // its number; 0: there is none
  bool plan_fresh = false;                     // the frame carries the plan
  Recycled<GhostPose> ghost{};                 // of the whole plan; only if fresh
};

namespace behaviours {

inline constexpr Name kRest = "rest";  // no behaviour wants the base
inline constexpr Name kAvoid = "avoid";
inline constexpr Name kManual = "manual";
inline constexpr Name kArm = "arm";        // brings the hand to its goal
inline constexpr Name kGround = "ground";  // surveys the ground ahead

}  // namespace behaviours

/// The texts of a halt.
struct HaltInfo {
  std::string_view name{};  // "motors_off", as REST and CSV spell it
  std::string_view what{};  // for people, as in Hold
  std::string_view why{};
};
const HaltInfo& info(Halt halt);
inline std::string_view name(Halt halt) {
  return info(halt).name;
}
/// "driving", as REST and CSV spell it.
std::string_view name(Mission mission);
/// "none" if nothing holds the robot.
std::string_view name(const Hold& hold);

struct Telemetry {
  std::uint64_t tick = 0;
  Recycled<Request> requests{};  // applied before this tick, in order
  Observation observation{};
  std::optional<GroundTruth> ground_truth{};
  Recycled<Moved> moved{};  // simulator only; true
  Scene scene{};
  std::optional<SetGoal> goal{};
  Recycled<SetGoal> goals_ahead{};  // after `goal`, in order
  ControlOutput output{};
  Recycled<Layer> layers{};   // from the pipeline; the controller has its own
  Explanation words{};        // the newest explanation
  bool words_fresh = false;   // made in this tick; the frame carries the words only then
  std::uint32_t legend = 0;   // identifies the layers and measures (algo/legend.hpp)
  bool legend_fresh = false;  // the frame carries their descriptions
  Command command{};
  Hold hold{};
  Limit limit{};
  Mission mission = Mission::Idle;
  Name behaviour = behaviours::kRest;  // the one whose proposal was taken
  double clearance = 0;  // [m] hull to the nearest filtered return; range_max - radius if none
  ArmTelemetry arm{};
};

}  // namespace algo
