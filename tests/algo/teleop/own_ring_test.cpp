// tests/algo/teleop/own_ring_test.cpp: the echoes of a robot's own sonars as the laws read them.
#include "algo/teleop/own_ring.hpp"

#include <cmath>
#include <numbers>

#include "tests/algo/allocations.hpp"
#include <gtest/gtest.h>

namespace {

using algo::kRingSonars;

constexpr auto kAxes = algo::ring_bearings();
constexpr double kMount = 0.3;  // [m] of each sonar from R

/// A reading of the sonar along `axis`: an echo at `range` [m], or none.
algo::RangeReading ring_reading(double axis, double stamp, double range) {
  const algo::Vec2 at = kMount * algo::direction(axis);
  const bool hit = range < 3;
  return {.mount_R = {at.x(), at.y(), axis},
          .stamp = stamp,
          .range = range,
          .range_max = 3,
          .status = hit ? algo::Beam::Ok : algo::Beam::Free};
}

/// One round of all eight at `stamp`, heard at the origin. Sonar `near` hears `range` [m].
algo::Observation round_of(double stamp, std::size_t near, double range) {
  algo::Observation observation;
  observation.stamp = stamp;
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    observation.sonar.push_back(ring_reading(kAxes[n], stamp, n == near ? range : 3));
  }
  return observation;
}

TEST(OwnRing, CountsFromTheCentreAndOnItsAxes) {
  algo::OwnRing ring;
  ring.take(round_of(0, 2, 1));
  const algo::Ring read = ring.read({}, 0, {});
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    EXPECT_NEAR(read.distances[n], n == 2 ? 1.3 : 3, 1e-12) << n;
    EXPECT_EQ(read.bearings[n], kAxes[n]);
  }
}

/// The robot moves on by 0.4 m towards an echo straight ahead of sonar 4's axis.
TEST(OwnRing, AnEchoStaysWhereItWasHeard) {
  algo::OwnRing ring;
  ring.take(round_of(0, 4, 1));
  const algo::Vec2 on = 0.4 * algo::direction(kAxes[4]);
  EXPECT_NEAR(ring.read({on.x(), on.y(), 0}, 0.05, {}).distances[4], 0.9, 1e-12);
}

TEST(OwnRing, ASilentSonarIsUnknownAfterATenthOfASecond) {
  algo::OwnRing ring;
  ring.take(round_of(0, 4, 1));
  EXPECT_NEAR(ring.read({}, 0.1, {}).distances[4], 1.3, 1e-12);
  for (const double d : ring.read({}, 0.12, {}).distances) EXPECT_TRUE(std::isnan(d));
  ring.take(round_of(0.12, 4, 3));
  EXPECT_EQ(ring.read({}, 0.12, {}).distances[4], 3);
}

TEST(OwnRing, AnotherRingsSonarsServeTheConesThatTheyLieIn) {
  algo::OwnRing ring;
  algo::Observation observation;
  observation.sonar.push_back(ring_reading(kAxes[3] + 0.2, 0, 1));
  observation.sonar.push_back(ring_reading(std::numbers::pi, 0, 0.5));  // behind: no cone
  ring.take(observation);
  const algo::Ring read = ring.read({}, 0, {});
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    const bool near = algo::in_cone(kAxes[n], kAxes[3] + 0.2);
    EXPECT_NEAR(read.distances[n], near ? 1.3 : 3, 1e-12) << n;
  }
}

TEST(OwnRing, ASteadyTickAllocatesNothing) {
  algo::OwnRing ring;
  algo::Observation observation = round_of(0, 4, 1);
  ring.take(observation);
  const std::size_t before = allocations::count();
  ring.take(observation);
  ring.read({}, 0, {});
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
