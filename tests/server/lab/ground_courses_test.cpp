// tests/server/lab/ground_courses_test.cpp: a few random courses of steps, slopes and trenches in
// Bullet.
#include "server/lab/soak/ground_courses.hpp"

#include <gtest/gtest.h>

namespace server::soak {
namespace {

TEST(GroundCourses, AreTheSameForTheSameSeed) {
  const algo::ClimbLimits limits = masuda_limits();
  EXPECT_EQ(random_course(3, limits).scenario.obstacles,
            random_course(3, limits).scenario.obstacles);
  EXPECT_NE(random_course(3, limits).scenario.obstacles,
            random_course(4, limits).scenario.obstacles);
  EXPECT_EQ(random_course(3, limits).pieces.size(), 3U);
}

TEST(GroundCourses, ARobotClimbsNothingAboveItsLimitsAndNeverFalls) {
  const CourseSums sums = drive_courses(masuda_limits(), 6, 240);
  EXPECT_EQ(sums.courses, 6U);
  EXPECT_EQ(sums.fell, 0U);
  EXPECT_EQ(sums.climbed, 0U);
  EXPECT_LE(sums.refused, 2U);  // an edge met too obliquely costs way
  EXPECT_GT(sums.passed, 2U);
}

TEST(GroundCourses, DrivesRepeat) {
  const algo::ClimbLimits limits = masuda_limits();
  const CourseEnd a = drive_course(random_course(2, limits), limits, 2, 60);
  const CourseEnd b = drive_course(random_course(2, limits), limits, 2, 60);
  EXPECT_EQ(a.words, b.words);
  EXPECT_EQ(a.passed, b.passed);
}

}  // namespace
}  // namespace server::soak
