// server/lab/buildings/building_world.hpp: random buildings with a start, a goal and what is true
// of the way between them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/lab/buildings/building_kinds.hpp"
#include "server/lab/buildings/grid_oracle.hpp"
#include "sim/scenario.hpp"

namespace server::buildings {

inline constexpr std::array kDoorWidths{0.75, 0.80, 0.90, 1.00};  // [m]
inline constexpr double kTopSpeed = 0.5;                          // [m/s]

/// Where the goal lies. ShutIn: in a cell or a pen without any opening. Inside: in a thing.
enum class GoalPlace : std::uint8_t { Near, Far, ShutIn, Inside };
/// "shut_in"
std::string_view name(GoalPlace place);

/// A door that closes before the robot can have reached it, and opens again.
struct TimedDoor {
  double closes = 0;                     // [s] run clock, until which it stands open
  double opens = 0;                      // [s] from which on it slides open
  static constexpr double kSlide = 1.5;  // [s] either way
  std::uint32_t id = 0;                  // of its leaf among the obstacles
  algo::Pose2 shut_W{};                  // of the leaf
};

struct Building {
  Kind kind = Kind::Maze;
  double door_width = 0;  // [m]
  GoalPlace goal_place = GoalPlace::Near;
  bool nose_on = false;  // the start is 25 mm from something ahead
  std::optional<TimedDoor> timed_door{};
  sim::Scenario scenario{};
};

/// The kind is the seed's place among the six, the width of the doors that of the seed's sixth
/// among the four; all else is drawn. The robot is the Silvermate with its LMS200, without
/// dynamics. The same seed gives the same world on every machine.
Building building_of(std::uint64_t seed, const std::string& controller);

/// What is true of the way to the goal.
struct Truth {
  /// [s] of the shortest way at top speed, with the wait for a closed door if that is shorter than
  /// the way round; nothing if there is no way.
  std::optional<double> time{};
  /// There is a way, or there surely is none. Neither: it is too close to call, since a gap among
  /// the furniture is hardly wider than the robot.
  bool has_way = false;
  bool has_none = false;
};
Truth truth_of(const Building& building);
/// The same between any two places, without a door that moves. `found` gets the way, if it is not
/// null.
Truth truth_between(GridOracle& oracle,
                    double door_width,
                    const algo::Vec2& from_W,
                    const algo::Vec2& to_W,
                    std::optional<std::vector<algo::Vec2>>* found = nullptr);

}  // namespace server::buildings
