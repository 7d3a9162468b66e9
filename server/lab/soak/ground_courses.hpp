// server/lab/soak/ground_courses.hpp: random courses of steps, slopes and trenches, driven by a
// robot with floor sensors: it climbs nothing above its limits, refuses nothing far below them, and
// never falls.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "algo/robot.hpp"
#include "algo/terrain/ground_class.hpp"
#include "sim/scenario.hpp"

namespace server::soak {

/// One piece of a course, across the whole way.
struct CoursePiece {
  algo::GroundClass kind = algo::GroundClass::Flat;
  double size = 0;  // [m] height of a step or width of a trench, [rad] of a slope; positive
  double from = 0;  // [m] along x, where it begins,
  double to = 0;    // and ends
};

struct GroundCourse {
  sim::Scenario scenario{};
  std::vector<CoursePiece> pieces{};
};

/// Three pieces of `limits`' kinds, each from a third to one and a half of its limit, at least 1.2
/// m apart. The edges are up to 10 degrees askew. The same seed gives the same course.
GroundCourse random_course(std::uint64_t seed, const algo::ClimbLimits& limits);

/// Pieces of these kinds and sizes, 1.2 m apart, with all edges askew by `skew` [rad].
GroundCourse course_of(const std::vector<std::pair<algo::GroundClass, double>>& pieces,
                       double skew);

/// How a piece compares with the robot's limit.
enum class PieceFit : std::uint8_t {
  Below,   // by more than the margin: the robot should drive over it
  Within,  // either will do
  Above,   // the robot must not
};
PieceFit fit_of(const CoursePiece& piece, const algo::ClimbLimits& limits);

/// True for a trench under 2 cm, which the sensors see about half the time.
bool is_narrow(const CoursePiece& piece);

/// A piece that the robot met.
struct MetPiece {
  CoursePiece piece{};
  PieceFit fit = PieceFit::Below;
  bool passed = false;
};

/// How one course ended.
struct CourseEnd {
  bool arrived = false;
  bool fell = false;            // overturned
  std::vector<MetPiece> met{};  // in their order; only the last one may have stopped it
  std::string words{};          // of the piece that stopped it
  std::uint64_t hash = 0;       // of every true pose
};

/// Drives for `seconds` of simulated time at most.
CourseEnd drive_course(const GroundCourse& course,
                       const algo::ClimbLimits& limits,
                       std::uint64_t seed,
                       double seconds);

/// The limits of `masuda`, from its file; without any there, ones on the safe side of what it
/// climbs in Bullet.
algo::ClimbLimits masuda_limits();

}  // namespace server::soak
