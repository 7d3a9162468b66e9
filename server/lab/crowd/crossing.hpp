// server/lab/crowd/crossing.hpp: a robot crosses a scene of recorded people from side to side.
#pragma once

#include <cstddef>
#include <vector>

#include "server/lab/crowd/people_file.hpp"
#include "server/run/run_spec.hpp"

namespace server::crowd {

inline constexpr std::size_t kCrossings = 100;
inline constexpr double kMostTime = 90;        // [s] of a crossing
inline constexpr double kGoalReach = 0.3;      // [m] of the true position
inline constexpr double kMovingSpeed = 0.05;   // [m/s] from which a contact is the robot's
inline constexpr double kIntrusion = 0.45;     // [m] between hull and disc
inline constexpr double kLeftOut = 1.5;        // [m] from the robot within which nobody appears
inline constexpr double kPersonalSpace = 1.2;  // [m] between hull and disc
inline constexpr double kStandingRoom = 1.0;   // [m] at which the robot that stands still stops

/// A way through the middle of the recording's rectangle.
struct Way {
  algo::Pose2 start_W{};
  algo::Vec2 goal_W{0, 0};
  double begin = 0;  // [s] of the recording
};
/// The way of crossing `k`: towards +x, +y, -x, -y in turn. Throws std::runtime_error with a
/// sentence if the recording is too small or too short for it.
Way way_of(const Recording& recording, std::size_t k);
/// The way of crossing 0, also of a recording that is too short for the others.
Way first_way(const Recording& recording);

enum class Driver : std::uint8_t {
  Controller,  // the scenario's own
  Standing,    // the same, but it stands still while somebody is within kStandingRoom
  Alone,       // the same, without people
};

/// The end of one crossing, and its seconds near people.
struct Crossing {
  bool crossed = false;
  bool moving_contact = false;  // ends the crossing
  int contacts_at_rest = 0;
  double time = 0;                     // [s]
  double intrusion = 0;                // [s]
  double personal = 0;                 // [s]
  std::vector<algo::Pose2> track_W{};  // the true pose of each tick, from the start on
};

/// Drives one way. `robot` gives robot, sensors, controller and parameters; its obstacles and goals
/// are left out. The same arguments give the same crossing.
Crossing cross(const Recording& recording, const Way& way, const RunSpec& robot, Driver driver);

}  // namespace server::crowd
