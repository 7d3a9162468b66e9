// server/lab/mapping/locate_study.hpp: robots with poor wheels that drive by their pose on a known
// map, in drawings of three buildings, with a tenth of each map wrong.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/metrics.hpp"
#include "algo/types.hpp"
#include "server/experiment/pool.hpp"
#include "server/lab/mapping/corridor_walls.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/run_spec.hpp"

namespace server::mapping {

/// A building, and a way through it to a goal 60 m off or farther.
struct Drawing {
  std::string name{};
  std::vector<Piece> pieces{};
  std::vector<algo::Vec2> way_W{};  // corners, from the start to the goal
};

/// "offices": one corridor round a block. "hall": pillars and shelves. "wings": two corridors that
/// look alike, joined by a lobby. `seed` places doors, rooms and furniture.
Drawing drawing_of(const std::string& name, std::uint64_t seed);
constexpr std::array<const char*, 3> kDrawings{"offices", "hall", "wings"};

/// The pieces as a map shows them on which `share` of the length of all outlines is wrong: doors
/// and furniture are gone, moved or new.
std::vector<Piece> outdated(const Drawing& drawing, double share, std::uint64_t seed);

enum class DrivesBy : std::uint8_t {
  Wheels,   // without a map
  Map,      // from a known start
  MapLost,  // from an unknown start, at which it stands until it is located
};

/// "offices" with the corridor to the goal shut 11 m before it; "hall" with a wall along its middle
/// that is open at one end; "wings" from the end of one wing to the end of the other. The straight
/// way to the goal leads into a dead end.
Drawing dead_end_of(const std::string& name, std::uint64_t seed);

/// The map of `pieces`, with free cells wherever a robot could get in the true building. `planned`:
/// planners get it too.
std::shared_ptr<const KnownMap> map_of(const std::vector<Piece>& pieces,
                                       const Drawing& truth,
                                       bool planned);

struct LocateRun {
  std::string drawing{};
  DrivesBy by = DrivesBy::Wheels;
  std::uint64_t seed = 0;
  algo::Outcome outcome = algo::Outcome::Running;
  double goal_off = 0;    // [m] between the robot's true place and the goal, at the end
  double worst_off = 0;   // [m] of the pose, while located
  double located = 0;     // share of the time
  double false_time = 0;  // [s] located, but more than 0.5 m and 3 deviations off
  double within_3 = 1;    // share of the time located with an error of at most 3 deviations
  /// Of a passenger of the same drive, who has the same map and scans and knows no start.
  double passenger_found = -1;        // [m] of way until located; below 0: never
  double passenger_false = 0;         // [s]
  std::vector<algo::Vec2> track_W{};  // true
};

struct LocateOptions {
  double wrong = 0.1;  // share of the map
  std::uint64_t first_seed = 1;
  std::size_t seeds = 5;
  experiment::PoolOptions pool{};
};

/// The scenario of a drawing: Controller `strip`, wheels that count 5 % wrong and slip.
sim::Scenario scenario_of(const Drawing& drawing);

/// Drives the way of each drawing with each seed, by each of DrivesBy.
std::vector<LocateRun> study_locate(const LocateOptions& options);

/// A drive by the map to a goal behind a dead end.
struct DeadEndRun {
  std::string drawing{};
  bool planned = false;  // the planner has the map too
  std::uint64_t seed = 0;
  algo::Outcome outcome = algo::Outcome::Running;
  double time = 0;                    // [s]
  double way = 0;                     // [m]
  double goal_off = 0;                // [m] at the end
  std::vector<algo::Vec2> track_W{};  // true
};
/// Drives each of dead_end_of() with each seed, with the map for the planner and without.
std::vector<DeadEndRun> study_dead_ends(const LocateOptions& options);

/// Both parts of the study.
struct LocateStudy {
  std::vector<LocateRun> runs{};
  std::vector<DeadEndRun> dead_ends{};
};
/// A row for each drawing and DrivesBy, over the seeds; then one for each dead end, with the map
/// for the planner and without.
std::string to_text(const LocateStudy& study);
nlohmann::json to_json(const LocateStudy& study);
/// Puts the tables into `file`, and a picture of each drawing's first seed into pictures/maps/
/// beside it.
void write_markdown(const LocateStudy& study, const std::filesystem::path& file);

}  // namespace server::mapping
