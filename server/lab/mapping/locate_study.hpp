// server/lab/mapping/locate_study.hpp: robots with poor wheels that drive by their pose on a known
// map, in drawings of three buildings, with a tenth of each map wrong.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/metrics.hpp"
#include "algo/types.hpp"
#include "server/experiment/pool.hpp"
#include "server/lab/mapping/corridor_walls.hpp"
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

/// A row for each drawing and DrivesBy, over the seeds.
std::string to_text(const std::vector<LocateRun>& runs);
nlohmann::json to_json(const std::vector<LocateRun>& runs);
/// Puts the table into `file`, and a picture of each drawing's first seed into pictures/maps/
/// beside it.
void write_markdown(const std::vector<LocateRun>& runs, const std::filesystem::path& file);

}  // namespace server::mapping
