// server/lab/soak/ground_courses.hpp: random courses of steps, slopes and trenches, driven by a
// robot with floor sensors: it climbs nothing above its limits, refuses nothing far below them, and
// never falls.
#pragma once

#include <cstdint>
#include <string>
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

/// How one course ended.
struct CourseEnd {
  bool arrived = false;
  bool fell = false;        // lies on its side, or is where it refused to go
  std::size_t passed = 0;   // pieces
  std::size_t climbed = 0;  // of them, above the robot's limit
  std::size_t refused = 0;  // pieces below the limit by more than the margin and its accuracy
  std::size_t narrow = 0;   // trenches under 2 cm among the refused
  std::string words{};      // of the piece that stopped it
};

/// Drives for `seconds` of simulated time at most.
CourseEnd drive_course(const GroundCourse& course,
                       const algo::ClimbLimits& limits,
                       std::uint64_t seed,
                       double seconds);

/// The sums over courses 1 .. `count`.
struct CourseSums {
  std::size_t courses = 0, arrived = 0, fell = 0, passed = 0, climbed = 0, refused = 0, narrow = 0;
};
CourseSums drive_courses(const algo::ClimbLimits& limits, std::size_t count, double seconds);

/// The limits of `masuda`, from its file; without any there, ones on the safe side of what it
/// climbs in Bullet.
algo::ClimbLimits masuda_limits();

}  // namespace server::soak
