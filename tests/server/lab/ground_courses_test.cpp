// tests/server/lab/ground_courses_test.cpp: a few random courses of steps, slopes and trenches in
// Bullet.
#include "server/lab/soak/ground_courses.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "algo/geometry.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "algo/units.hpp"
#include "server/lab/soak/course_study.hpp"
#include "sim/world.hpp"

namespace server::soak {
namespace {

using namespace algo::units;

/// A step and slopes that `masuda` masters.
std::vector<std::pair<algo::GroundClass, double>> mastered() {
  return {{algo::GroundClass::StepUp, 0.005},
          {algo::GroundClass::SlopeUp, 10_deg},
          {algo::GroundClass::SlopeDown, 10_deg}};
}

TEST(GroundCourses, AreTheSameForTheSameSeed) {
  const algo::ClimbLimits limits = masuda_limits();
  EXPECT_EQ(random_course(3, limits).scenario.obstacles,
            random_course(3, limits).scenario.obstacles);
  EXPECT_NE(random_course(3, limits).scenario.obstacles,
            random_course(4, limits).scenario.obstacles);
  EXPECT_EQ(random_course(3, limits).pieces.size(), 3U);
}

/// The pieces leave no lip between them: each begins where the one before it ends.
TEST(GroundCourses, AreWholeGround) {
  const algo::ClimbLimits limits = masuda_limits();
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    std::optional<double> end;  // [m] at right angles to the edges
    for (const algo::Obstacle& piece : random_course(seed, limits).scenario.obstacles) {
      const auto* ramp = std::get_if<algo::Ramp>(&piece.shape);
      if (ramp == nullptr) {
        end.reset();
        continue;
      }
      const double skew = std::remainder(piece.pose_W.heading, std::numbers::pi);
      const double middle = piece.pose_W.position().dot(algo::direction(skew));
      if (end) {
        EXPECT_NEAR(middle - ramp->length / 2, *end, 1e-9) << seed;
      }
      end = middle + ramp->length / 2;
      const bool down = std::abs(piece.pose_W.heading - skew) > 1;
      if (down && ramp->low == 0) end.reset();  // the floor goes on without a piece
    }
  }
}

TEST(GroundCourses, KnowWhatShouldBePassed) {
  const algo::ClimbLimits limits{
      .step_up = 0.010, .step_down = 0.02, .trench = 0.03, .slope_up = 0.3, .slope_down = 0.3};
  const auto fit = [&](algo::GroundClass kind, double size) {
    return fit_of({.kind = kind, .size = size}, limits);
  };
  EXPECT_EQ(fit(algo::GroundClass::StepUp, 0.0079), PieceFit::Below);
  EXPECT_EQ(fit(algo::GroundClass::StepUp, 0.0081), PieceFit::Within);
  EXPECT_EQ(fit(algo::GroundClass::StepUp, 0.0101), PieceFit::Above);
  EXPECT_EQ(fit(algo::GroundClass::SlopeDown, 0.3 - 0.0699), PieceFit::Below);
  EXPECT_EQ(fit(algo::GroundClass::SlopeUp, 0.3 - 0.0435), PieceFit::Within);
  EXPECT_TRUE(is_narrow({.kind = algo::GroundClass::Trench, .size = 0.019}));
  EXPECT_FALSE(is_narrow({.kind = algo::GroundClass::StepUp, .size = 0.019}));
}

/// Each repeats bit for bit.
TEST(GroundCourses, ARobotClimbsWhatItCanAndNothingElse) {
  const CourseOptions options{.worlds = 2, .first_seed = 5, .seconds = 240};
  const auto rows = run_courses(options);
  std::size_t passed = 0;
  std::size_t refused = 0;
  for (const CourseRow& row : rows) {
    EXPECT_FALSE(is_fault(row)) << row.seed << ": " << row.end.words;
    for (const MetPiece& met : row.end.met) ++(met.passed ? passed : refused);
  }
  EXPECT_GT(passed, 2U);
  EXPECT_GT(refused, 0U) << "no piece was too much for it";
  const algo::ClimbLimits limits = masuda_limits();
  EXPECT_EQ(drive_course(random_course(5, limits), limits, 5, 240).hash, rows[0].end.hash);
}

/// All edges are 10 degrees askew.
TEST(GroundCourses, TenDegreesAskewIsNotTooMuch) {
  for (const double skew : {-10_deg, 10_deg}) {
    const GroundCourse course = course_of(mastered(), skew);
    const CourseEnd end = drive_course(course, masuda_limits(), 1, 180);
    EXPECT_TRUE(end.arrived) << end.words;
    EXPECT_FALSE(end.fell);
    EXPECT_EQ(end.met.size(), course.pieces.size());
  }
}

/// An alignment may leave up to 10 degrees (section 5.2). By hand there is none: the robot votes
/// and crosses 10 degrees askew, and stops before what is too much for it.
TEST(GroundCourses, TenDegreesLeftByTheAlignmentAreNotTooMuch) {
  const auto way_by_hand = [](const GroundCourse& course) {
    sim::World world(course.scenario, 1);
    algo::Pipeline pipeline({.controller = "go_to_goal"}, world.spec());
    algo::Telemetry t;
    world.reset(t.observation);
    pipeline.reset(t.observation.odometry.pose);
    const double end = course.pieces.back().to + 0.3;
    while (t.observation.stamp < 120 && world.pose_W().x < end && !world.overturned()) {
      t.requests.clear();
      t.requests.push_back(algo::Joystick{.forward = 1, .mode = algo::StickMode::Raw});
      pipeline.tick(t);
      world.step(t.command, t.observation);
    }
    EXPECT_FALSE(world.overturned());
    return world.pose_W().x;
  };
  for (const double skew : {-10_deg, 10_deg}) {
    const GroundCourse course = course_of(mastered(), skew);
    EXPECT_GT(way_by_hand(course), course.pieces.back().to);
    const GroundCourse high = course_of({{algo::GroundClass::StepUp, 0.012}}, skew);
    EXPECT_LT(way_by_hand(high), high.pieces.front().from - 0.1);
  }
}

}  // namespace
}  // namespace server::soak
