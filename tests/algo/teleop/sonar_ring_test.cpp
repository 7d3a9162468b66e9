// tests/algo/teleop/sonar_ring_test.cpp: the ring's readings out of laser scans.
#include "algo/teleop/sonar_ring.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

namespace {

using algo::LaserScan;
using algo::Parameters;
using algo::RingReadings;
using algo::units::kRadiansPerDegree;

using tests::kNan;

LaserScan scan_of(const worlds::World& world, const algo::Pose2& mount_R = {}) {
  LaserScan scan;
  worlds::scan_world(mount_R, world, 8, scan);
  scan.mount_R = mount_R;
  return scan;
}

TEST(SonarRing, SpansTheHalfCircleAhead) {
  const auto bearings = algo::ring_bearings();
  EXPECT_DOUBLE_EQ(bearings.front(), -std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(bearings.back(), std::numbers::pi / 2);
  EXPECT_NEAR(bearings[4] / kRadiansPerDegree, 12.857142857, 1e-9);
  for (std::size_t n = 1; n < bearings.size(); ++n) {
    EXPECT_LT(bearings[n] - bearings[n - 1], 2 * algo::kRingHalfCone) << "a gap between two cones";
  }
}

TEST(Heard, IsWithinReachAndNearForNan) {
  const Parameters parameters;
  EXPECT_EQ(algo::heard(1.2, parameters), 1.2);
  EXPECT_EQ(algo::heard(8.0, parameters), 3.0);
  EXPECT_EQ(algo::heard(-1.0, parameters), 0.0);
  EXPECT_EQ(algo::heard(kNan, parameters), 0.5);
}

TEST(VirtualSonars, AnEmptyPlaceHasNoEcho) {
  for (const double d : algo::virtual_sonars(scan_of({}), Parameters{}).distances)
    EXPECT_EQ(d, 3.0);
}

/// A pole of 5 cm, 1.5 m away on each axis in turn: its cone reads 1.45 m, and all others nothing.
TEST(VirtualSonars, ReadTheNearestReturnOfTheirCone) {
  const auto bearings = algo::ring_bearings();
  for (std::size_t n = 0; n < algo::kRingSonars; ++n) {
    const worlds::World world{.circles = {{1.5 * algo::direction(bearings[n]), 0.05}}};
    const RingReadings readings = algo::virtual_sonars(scan_of(world), Parameters{}).distances;
    for (std::size_t k = 0; k < algo::kRingSonars; ++k) {
      EXPECT_NEAR(readings[k], k == n ? 1.45 : 3.0, 1e-3) << n << ", cone " << k;
    }
  }
}

TEST(VirtualSonars, NothingFallsBetweenTwoCones) {
  for (double degrees = -90; degrees <= 90; degrees += 0.5) {
    LaserScan scan = scan_of({});
    scan.set_ok(static_cast<std::size_t>(std::lround(2 * (degrees + 90))), 1.0);
    const RingReadings readings = algo::virtual_sonars(scan, Parameters{}).distances;
    EXPECT_NEAR(algo::nearest_heard(readings, Parameters{}), 1.0, 1e-12) << degrees;
  }
}

/// A scanner 0.3 m ahead of the centre and turned to the left sees a pole at (1.3, 0) at 0.95 m. It
/// is 1.25 m away from the centre, in the two middle cones.
TEST(VirtualSonars, CountFromTheCentreNotFromTheScanner) {
  const worlds::World world{.circles = {{{1.3, 0}, 0.05}}};
  const RingReadings readings =
      algo::virtual_sonars(scan_of(world, {0.3, 0, 40 * kRadiansPerDegree}), Parameters{})
          .distances;
  EXPECT_NEAR(readings[3], 1.25, 1e-3);
  EXPECT_NEAR(readings[4], 1.25, 1e-3);
  EXPECT_EQ(readings[2], 3.0);
  EXPECT_EQ(readings[5], 3.0);
}

TEST(VirtualSonars, ABlindConeIsNotAFreeOne) {
  LaserScan scan = scan_of({});
  for (std::size_t i = 180; i <= 240; ++i) scan.set_invalid(i, algo::BeamCode::Dazzled);  // 0..30
  RingReadings readings = algo::virtual_sonars(scan, Parameters{}).distances;
  EXPECT_TRUE(std::isnan(readings[4]));
  EXPECT_EQ(readings[1], 3.0);
  EXPECT_EQ(algo::nearest_heard(readings, Parameters{}), 0.5);
  scan.set_ok(200, 1.0);  // a return among blind beams is still a return
  readings = algo::virtual_sonars(scan, Parameters{}).distances;
  EXPECT_DOUBLE_EQ(readings[4], 1.0);
}

/// A scanner of 100 degrees has no beams for the outer cones, whose sonars it therefore lacks.
TEST(VirtualSonars, ConesOutsideTheFieldReadNoEcho) {
  LaserScan scan;
  scan.angle_min = -50 * kRadiansPerDegree;
  scan.angle_increment = 0.25 * kRadiansPerDegree;
  scan.range_max = 8;
  scan.resize(401);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_ok(i, 2.0);
  const RingReadings readings = algo::virtual_sonars(scan, Parameters{}).distances;
  EXPECT_EQ(readings[0], 3.0);
  EXPECT_DOUBLE_EQ(readings[2], 2.0);
  EXPECT_EQ(readings[7], 3.0);
  for (const double d : algo::virtual_sonars(LaserScan{}, Parameters{}).distances)
    EXPECT_EQ(d, 3.0);
}

TEST(VirtualSonars, AnyScanGivesReadingsThatTheLawsCanHear) {
  std::mt19937_64 random(5);
  const double odd[] = {kNan, std::numeric_limits<double>::infinity(), 0, 1e300};
  for (int n = 0; n < 500; ++n) {
    LaserScan scan = scan_of({}, {0.2, -0.1, 0.3});
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const double range = std::uniform_real_distribution<double>(0, 8)(random);
      if (random() % 3 == 0) scan.set_invalid(i, algo::BeamCode::NoEcho);
      if (random() % 3 == 0) scan.set_ok(i, random() % 9 == 0 ? odd[random() % 4] : range);
    }
    for (const double d : algo::virtual_sonars(scan, Parameters{}).distances) {
      const double taken = algo::heard(d, Parameters{});
      EXPECT_TRUE(taken >= 0 && taken <= 3.0) << d;
    }
  }
}

TEST(VirtualSonars, AllocateNothing) {
  const LaserScan scan = scan_of({.circles = {{{1.3, 0}, 0.05}}});
  const Parameters parameters;
  const auto before = allocations::count();
  EXPECT_LT(algo::virtual_sonars(scan, parameters).distances[3], 3);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
