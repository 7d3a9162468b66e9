// server/lab/buildings/tour_drive.hpp: drives one tour: goal after goal in one building, without a
// restart.
#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "server/lab/buildings/building_study.hpp"
#include "server/lab/buildings/tour_goals.hpp"

namespace server::buildings {

/// What the robot knows its place by. True: wheels without error. Wheels: wheels that read
/// kScaleError wrong. Matched: the same wheels, corrected by matched scans.
enum class Odometry : std::uint8_t { True, Wheels, Matched };
inline constexpr std::array kOdometries{Odometry::True, Odometry::Wheels, Odometry::Matched};
/// "matched"
std::string_view name(Odometry odometry);
/// Throws std::invalid_argument that lists the names.
Odometry odometry_named(std::string_view name);

inline constexpr double kScaleError = 0.02;     // of ways and of turns
inline constexpr double kOdometryNoise = 0.01;  // per square root of metre and of radian

/// One goal of a tour.
///
/// It is handed over as a place seen from the robot: its true place relative to the robot's true
/// pose, put at the pose that the robot believes. So the drift up to then does not move it into a
/// wall. It is reached where the robot believes so.
struct Leg {
  TourGoal goal{};
  End end = End::OutOfTime;
  std::string reason{};  // the robot's last sentence
  double seconds = 0;
  /// The goal of a refusal as it lay in the end by the pose that the robot believed: the drift of
  /// the leg may have moved it off every way.
  bool drifted_off = false;
  algo::Vec2 end_W{0, 0};  // the robot's true place
  double drift = 0;        // [m] from it to the believed one
  double memory_mb = 0;    // of the process
};

/// How the end of a leg compares with the truth.
enum class Verdict : std::uint8_t {
  Reached,
  RefusedRightly,  // no way leads to the goal, or it is too close to call, or it drifted off
  RefusedWrongly,
  Late,      // there is a way, and the time was over
  Searched,  // there is none, or it is too close to call, and the time was over without a word
  Blocked,   // it stood without saying that there is no way, or in silence
  Collided
};
inline constexpr std::size_t kVerdicts = 7;
/// "refused_wrongly"
std::string_view name(Verdict verdict);
Verdict verdict_of(const Leg& leg);
/// Neither reached nor rightly refused.
bool is_fault(const Leg& leg);

struct Tour {
  std::uint64_t seed = 0;
  Odometry odometry = Odometry::True;
  Building building{};      // without its obstacles
  std::vector<Leg> legs{};  // fewer than wanted after a collision
  double doubled = 0;       // share of the remembered walls; NaN for controllers without a memory
  std::size_t walls = 0;    // cells remembered
};

struct TourOptions {
  std::size_t goals = 200;
  std::string controller = "strip";
  Odometry odometry = Odometry::Matched;
};

/// The same options and seed give the same tour, but for the memory of the process.
Tour drive_tour(std::uint64_t seed, const TourOptions& options, const std::stop_token& stop = {});

}  // namespace server::buildings
