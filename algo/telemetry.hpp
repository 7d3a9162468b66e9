// algo/telemetry.hpp: one tick as one value: what was sensed, asked, decided and commanded.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

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
  bool operator==(const Echo&) const = default;
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

/// One control point of the strip. Forces are displacements [m].
struct Node {
  Vec2 position_W{0, 0};
  Vec2 internal_W{0, 0};
  Vec2 external_W{0, 0};
  bool operator==(const Node&) const = default;
};

enum class Side : std::int8_t { Right = -1, None = 0, Left = 1 };

/// A controller's grid as people see it: row-major from its corner, one byte a cell.
struct GridLayer {
  static constexpr std::uint8_t kUnknown = 255;  // else 0 free, 127 even, 254 occupied
  Vec2 corner_W{0, 0};                           // [m] outer corner of cell (0, 0)
  double cell = 0;                               // [m] edge
  std::uint32_t columns = 0;                     // along W's x
  std::uint32_t rows = 0;
  // columns x rows. Empty: the controller keeps no grid, or this tick brings none (Pipeline).
  std::vector<std::uint8_t> cells{};
  bool operator==(const GridLayer&) const = default;
};

/// A motion that a controller weighed: constant twist held for `horizon`.
struct Candidate {
  Twist2 twist{};
  double horizon = 0;    // [s]
  double cost = 0;       // in the controller's own measure; less is better
  bool allowed = false;  // passed the controller's collision test
  bool chosen = false;
  bool operator==(const Candidate&) const = default;
};

/// An obstacle seen moving.
struct Track {
  Vec2 position_W{0, 0};
  Vec2 velocity_W{0, 0};  // [m/s]
  double radius = 0;      // [m]
  double age = 0;         // [s] since it was first seen
  double unseen = 0;      // [s] since it was last seen
  bool operator==(const Track&) const = default;
};

/// What a controller is about, for the sentences of explain().
enum class Manner : std::uint8_t {
  None,         // a strip of one via point speaks by its forces
  ToGoal,       // straight, whatever is in between
  TakingScan,   // standing still to look
  ToEdge,       // past the edge of an obstacle
  Pushed,       // the way is the sum of pull and pushes
  Planned,      // along plan_W
  NoPlan,       // no way over the grid
  Valley,       // through a free valley of the histogram
  Walled,       // no sector is free
  Window,       // the chosen one of the candidates
  NoWindow,     // no candidate is allowed
  Following,    // along the strip of many nodes
  Turning,      // on the spot, towards the strip
  Maneuvering,  // to and fro in a narrow place
  GivingWay,    // to what moves
  Cornered,     // every motion would meet what moves
  Escaping,     // out of too narrow a place
  BackingOff,   // the way was blocked for long
  NoWay,        // the map has no way to the goal
  Blocked,      // nothing is free just now
  GoalTaken,    // something stands on the goal, and this is as far as it goes
};

/// What a controller decided and why.
struct ControlOutput {
  Twist2 twist{};
  Manner manner = Manner::None;
  Recycled<Node> strip{};  // start .. end; the second is the pass point
  Vec2 internal_W{0, 0};   // [m] F_int at the via point
  Vec2 external_left_W{0, 0};
  Vec2 external_right_W{0, 0};
  Vec2 elastic_W{0, 0};    // [m] their sum, with the side choice's push
  Vec2 pass_W{0, 0};       // where the base is sent
  Side side = Side::None;  // the side on which the obstacle is passed
  double side_since = 0;   // [s] run clock at which it was chosen
  double side_alpha = 0;   // share of the side push, 0..1
  std::int32_t blocked_beam = -1;
  Recycled<Track> tracks{};
  Recycled<Vec2> plan_W{};           // a deliberative layer's path, robot to goal
  Recycled<Candidate> candidates{};  // what a velocity stage weighed
  std::vector<float> histogram{};    // polar density by bearing in W, first sector from 0 ccw
  double histogram_threshold = 0;    // sectors below it count as free
  GridLayer grid{};

  /// Everything but the buffers, which are kept for the next tick.
  void clear();
};

/// Why the gate replaced the command by zero.
enum class Hold : std::uint8_t {
  None,
  Stopped,
  Bumper,
  StaleScan,
  NotFinite,
  LinkLost,
  Halted,   // by the robot itself: observation.halt says why
  Dazzled,  // beams ahead, or most of them, tell nothing
};

/// The sequencing layer's state.
enum class Mission : std::uint8_t { Idle, Driving, Arrived, Stuck, Held };

/// The behaviour whose proposal was taken.
enum class BehaviourId : std::uint8_t { Rest, Avoid, Manual };

/// "stale_scan", "driving", "avoid": as REST and CSV spell them.
std::string_view name(Hold hold);
std::string_view name(Halt halt);
std::string_view name(Mission mission);
std::string_view name(BehaviourId behaviour);

struct Telemetry {
  std::uint64_t tick = 0;
  Recycled<Request> requests{};  // applied before this tick, in order
  Observation observation{};
  std::optional<GroundTruth> ground_truth{};
  Scene scene{};
  std::optional<SetGoal> goal{};
  Recycled<SetGoal> goals_ahead{};  // after that one, in order
  ControlOutput output{};
  Command command{};
  Hold hold = Hold::None;
  Mission mission = Mission::Idle;
  BehaviourId behaviour = BehaviourId::Rest;
  double clearance = 0;  // [m] hull to the nearest filtered return; range_max - radius when none
};

}  // namespace algo
