// tests/algo/sensor_merge_test.cpp: which readings of other sensors enter the scan, and where.
#include "algo/sensor_merge.hpp"

#include <numbers>

#include "tests/algo/allocations.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Beam;
using algo::LaserScan;
using algo::Observation;
using algo::SensorMerge;

constexpr double kDegree = std::numbers::pi / 180;

/// 361 beams that saw nothing, of a scanner 0.1 m ahead of the centre.
LaserScan free_scan() {
  LaserScan scan;
  scan.mount_R = {0.1, 0, 0};
  scan.angle_min = -90 * kDegree;
  scan.angle_increment = 0.5 * kDegree;
  scan.range_max = 8;
  scan.resize(361);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
  return scan;
}

algo::RangeReading reading(double heading, double range, double stamp = 0) {
  return {{0.3, 0, heading}, stamp, range, 3.5, Beam::Ok};
}

std::size_t hits(const LaserScan& scan) {
  std::size_t count = 0;
  for (const Beam beam : scan.status) count += beam == Beam::Ok ? 1 : 0;
  return count;
}

TEST(SensorMerge, ObstaclesMissedByTheLaserEnterItsBeams) {
  SensorMerge merge;
  Observation observation;
  observation.infrared.push_back(reading(0, 0.8));
  merge.take(observation);
  LaserScan scan = free_scan();
  merge.enter({}, 0, scan);
  // 0.3 + 0.8 m ahead of the centre is 1.0 m ahead of the scanner; 1 degree either side is 5 beams.
  EXPECT_EQ(hits(scan), 5U);
  for (std::size_t i = 178; i <= 182; ++i) {
    EXPECT_NEAR(scan.ranges[i], 1.0, 1e-12) << i;
    EXPECT_FALSE(scan.measured(i)) << i;
  }
}

TEST(SensorMerge, ARepeatedReadingKeepsItsPosition) {
  SensorMerge merge;
  Observation observation;
  observation.sonar.push_back(reading(0, 0.8, 1.0));
  merge.take(observation);
  observation.odometry.pose.x = 0.2;  // driven on since; the base repeats the reading
  merge.take(observation);
  LaserScan scan = free_scan();
  merge.enter(observation.odometry.pose, 1.1, scan);
  EXPECT_NEAR(scan.ranges[180], 0.8, 1e-12);
}

TEST(SensorMerge, ReadingsTheLaserSeesTooAreLeftOut) {
  SensorMerge merge;
  Observation observation;
  observation.sonar.push_back(reading(0, 0.8));
  merge.take(observation);
  LaserScan scan = free_scan();
  scan.set_ok(200, 1.1);  // 10 degrees left, inside the cone: that is what echoed
  merge.enter({}, 0, scan);
  EXPECT_EQ(hits(scan), 1U);
  LaserScan far = free_scan();
  far.set_ok(180, 5);  // a wall behind something low
  merge.enter({}, 0, far);
  EXPECT_NEAR(far.ranges[180], 1.0, 1e-12);
}

TEST(SensorMerge, NeighbouringReadingsDoNotExplainEachOther) {
  SensorMerge merge;
  Observation observation;
  for (int k = -3; k <= 3; ++k) observation.infrared.push_back(reading(k * 1.77 * kDegree, 0.8));
  merge.take(observation);
  LaserScan scan = free_scan();
  merge.enter({}, 0, scan);
  std::size_t first = 0;
  while (scan.status[first] != Beam::Ok) ++first;
  for (std::size_t i = first; i < first + hits(scan); ++i) EXPECT_EQ(scan.status[i], Beam::Ok);
  EXPECT_GT(hits(scan), 15U);
}

TEST(SensorMerge, AReadingHoldsUntilTheNextOneOrUntilItIsOld) {
  SensorMerge merge;
  Observation observation;
  observation.infrared.push_back(reading(0, 0.8));
  merge.take(observation);
  observation.clear_sensors();
  merge.take(observation);
  LaserScan scan = free_scan();
  merge.enter({0.2, 0, 0}, 0.4, scan);  // the robot came 0.2 m nearer since
  EXPECT_NEAR(scan.ranges[180], 0.8, 1e-12);
  LaserScan later = free_scan();
  merge.enter({}, 0.6, later);
  EXPECT_EQ(hits(later), 0U);
  observation.infrared.push_back({{0.3, 0, 0}, 0.1, 3.5, 3.5, Beam::Free});
  merge.take(observation);
  LaserScan gone = free_scan();
  merge.enter({}, 0.1, gone);
  EXPECT_EQ(hits(gone), 0U);
}

TEST(SensorMerge, ReadingsOutsideTheScannersFieldAreLeftOut) {
  SensorMerge merge;
  Observation observation;
  observation.infrared.push_back({{-0.3, 0, std::numbers::pi}, 0, 0.5, 3.5, Beam::Ok});
  merge.take(observation);
  LaserScan scan = free_scan();
  merge.enter({}, 0, scan);
  EXPECT_EQ(hits(scan), 0U);
  LaserScan none;
  merge.enter({}, 0, none);  // no scanner, no scan
}

TEST(SensorMerge, AllocatesOnlyWhileSensorsAppear) {
  SensorMerge merge;
  Observation observation;
  for (int k = 0; k < 100; ++k) observation.infrared.push_back(reading(k * kDegree, 1));
  merge.take(observation);
  LaserScan scan = free_scan();
  const std::size_t before = allocations::count();
  for (int k = 0; k < 10; ++k) {
    merge.take(observation);
    merge.enter({}, 0, scan);
  }
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
