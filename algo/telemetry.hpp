// algo/telemetry.hpp: one tick as one value: what was sensed, asked, decided and commanded.
#pragma once

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

/// Nearest valid return of one side.
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
  bool hit = false;    // something was in range
  Vec2 point_W{0, 0};  // on the axis; meaningful only with a hit
};

/// What perception makes of the newest scan. `scan` is filtered and may be older than this tick.
/// On a robot without a scanner `echoes` stands in for it; left and right are then the nearest
/// echoes, and their beam counts the sonars.
struct Scene {
  LaserScan scan{};
  bool fresh = false;  // a new scan came this tick
  std::optional<Nearest> left{};
  std::optional<Nearest> right{};
  Recycled<Echo> echoes{};  // one a sonar, as they first came; empty on a robot with a scanner
};

/// A number of a controller's method: plotted by the page, read by judges.
struct Measure {
  std::string_view name{};  // "strip.internal"; in static storage, as the unit
  std::string_view unit{};  // "m"
  double value = 0;
};

/// What a controller decided, and what it shows of why.
struct ControlOutput {
  Twist2 twist{};
  std::optional<Vec2> pass_W{};  // where the base is sent
  bool waits = false;            // it may stand still now, for the reason that its words give
  std::uint8_t state = 0;        // the controller's own; a change of it is worth new words at once
  Recycled<Measure> measures{};
  Recycled<Layer> layers{};

  std::optional<double> measure(std::string_view name) const;
  /// Everything but the buffers, which are kept for the next tick.
  void clear();
};

/// One sentence for what the robot is doing and one for why, with the numbers.
struct Explanation {
  std::string what{};
  std::string why{};
  bool operator==(const Explanation&) const = default;
};

/// Why the gate replaced the command by zero; without a name it did not. Who holds the robot gives
/// the reason (algo/gate.hpp).
struct Hold {
  Name name{};              // "stale_scan"
  std::string_view what{};  // "Waiting for the laser": for people, without numbers, in static
  std::string_view why{};   // storage; a record does not bring them back
  explicit operator bool() const { return !name.empty(); }
  friend bool operator==(const Hold& a, const Hold& b) { return a.name == b.name; }
};

/// What keeps a command below the one that was wanted; without a name nothing does.
struct Limit {
  Name name{};             // "turnover"
  std::string_view why{};  // a sentence, as of a Hold
  explicit operator bool() const { return !name.empty(); }
  friend bool operator==(const Limit& a, const Limit& b) { return a.name == b.name; }
};

/// The sequencing layer's state.
enum class Mission : std::uint8_t { Idle, Driving, Arrived, Stuck, Held };

namespace behaviours {

inline constexpr Name kRest = "rest";  // none wants the base
inline constexpr Name kAvoid = "avoid";
inline constexpr Name kManual = "manual";

}  // namespace behaviours

/// What there is to say of a halt.
struct HaltInfo {
  std::string_view name{};  // "motors_off": as REST and CSV spell it
  std::string_view what{};  // for people, as of a Hold
  std::string_view why{};
};
const HaltInfo& info(Halt halt);
inline std::string_view name(Halt halt) {
  return info(halt).name;
}
/// "driving": as REST and CSV spell it.
std::string_view name(Mission mission);
/// "none" where nothing holds the robot.
std::string_view name(const Hold& hold);

struct Telemetry {
  std::uint64_t tick = 0;
  Recycled<Request> requests{};  // applied before this tick, in order
  Observation observation{};
  std::optional<GroundTruth> ground_truth{};
  Recycled<Moved> moved{};  // simulator only, as the truth
  Scene scene{};
  std::optional<SetGoal> goal{};
  Recycled<SetGoal> goals_ahead{};  // after that one, in order
  ControlOutput output{};
  Recycled<Layer> layers{};   // what the pipeline shows besides the controller's
  Explanation words{};        // the newest
  bool words_fresh = false;   // they were said in this tick; the frame brings them only then
  std::uint32_t legend = 0;   // which layers and measures there are (algo/legend.hpp)
  bool legend_fresh = false;  // the frame says what they are
  Command command{};
  Hold hold{};
  Limit limit{};
  Mission mission = Mission::Idle;
  Name behaviour = behaviours::kRest;  // the one whose proposal was taken
  double clearance = 0;  // [m] hull to the nearest filtered return; range_max - radius when none
};

}  // namespace algo
