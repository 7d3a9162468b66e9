// tests/algo/geometry_test.cpp: fields of view, nearest beams, and the result of perceive().
#include "algo/geometry.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "algo/perceive.hpp"
#include "algo/units.hpp"

namespace {

using algo::Beam;
using algo::LaserScan;
using algo::Vec2;
using namespace algo::units;

LaserScan free_scan(std::size_t beams, double first_deg, double step_deg) {
  LaserScan scan;
  scan.range_max = 8;
  scan.angle_min = first_deg * kRadiansPerDegree;
  scan.angle_increment = step_deg * kRadiansPerDegree;
  scan.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) scan.set_free(i);
  return scan;
}

TEST(Fields, OfTheUsualScanAreBeams31To329) {
  const LaserScan scan = free_scan(361, -90, 0.5);
  EXPECT_EQ(algo::right_beams(scan).begin, 31U);
  EXPECT_EQ(algo::right_beams(scan).end, 180U);  // the centre beam is the left's
  EXPECT_EQ(algo::left_beams(scan).begin, 180U);
  EXPECT_EQ(algo::left_beams(scan).end, 330U);
}

TEST(Fields, OfOtherScansAreTheSameAngles) {
  // 1 degree: -74 .. 74 of -90 .. 90.
  const LaserScan coarse = free_scan(181, -90, 1);
  EXPECT_EQ(algo::right_beams(coarse).begin, 16U);
  EXPECT_EQ(algo::right_beams(coarse).end, 90U);
  EXPECT_EQ(algo::left_beams(coarse).end, 165U);
  // 0.25 degree over 100 degrees: all of it.
  const LaserScan fine = free_scan(401, -50, 0.25);
  EXPECT_EQ(algo::right_beams(fine).begin, 0U);
  EXPECT_EQ(algo::left_beams(fine).begin, 200U);
  EXPECT_EQ(algo::left_beams(fine).end, 401U);
  // 360 values of 0.5 degree: the last beam is not used anyway.
  EXPECT_EQ(algo::left_beams(free_scan(360, -90, 0.5)).end, 330U);
  // A scan of the left side only has no right beams.
  const LaserScan left_only = free_scan(91, 0, 0.5);
  EXPECT_EQ(algo::right_beams(left_only).begin, algo::right_beams(left_only).end);
}

TEST(Fields, OfAnInvalidScanAreEmpty) {
  for (const double step : {0.0, -0.5, std::nan("")}) {
    const LaserScan scan = free_scan(361, -90, step);
    EXPECT_EQ(algo::left_beams(scan).end, 0U);
    EXPECT_EQ(algo::right_beams(scan).end, 0U);
  }
  EXPECT_EQ(algo::left_beams(LaserScan{}).end, 0U);
}

TEST(NearestBeam, TiesGoToTheLowerIndexAndOnlyOkBeamsCount) {
  LaserScan scan = free_scan(361, -90, 0.5);
  scan.set_ok(200, 2);
  scan.set_ok(210, 2);
  scan.set_ok(220, 3);
  scan.set_invalid(205, algo::BeamCode::Dazzled);
  scan.ranges[205] = 0.1;
  const auto hit = algo::nearest_beam(scan, algo::left_beams(scan));
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->beam, 200U);
  EXPECT_EQ(hit->distance, 2);
  EXPECT_FALSE(algo::nearest_beam(scan, algo::right_beams(scan)).has_value());
}

/*  The scanner sits 0.5 m ahead of the centre. A: straight ahead at range 1.0, 1.5 m from R.
 *  B: at 60 degrees to the left at range 1.1: (0.5 + 0.55, 0.953), |B| = sqrt(1.05^2 + 0.953^2)
 *  = 1.418 m from R. By range A is nearer, by distance from the centre B is. */
TEST(NearestBeam, IsNearestToTheCentreNotToTheScanner) {
  LaserScan scan = free_scan(361, -90, 0.5);
  scan.mount_R = {0.5, 0, 0};
  scan.set_ok(180, 1.0);
  scan.set_ok(300, 1.1);
  const auto hit = algo::nearest_beam(scan, algo::left_beams(scan));
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->beam, 300U);
  EXPECT_NEAR(hit->distance, std::hypot(0.5 + 1.1 * 0.5, 1.1 * std::sqrt(3.0) / 2), 1e-12);
}

TEST(ObstacleCheck, LiteralUsesTheFirstBeamAndOursTheNearest) {
  LaserScan scan = free_scan(361, -90, 0.5);
  scan.set_ok(101, 1.2);
  scan.set_ok(250, 0.9);
  const auto literal = algo::obstacle_check_literal(scan.ranges, 1.35);
  ASSERT_TRUE(literal.has_value());
  EXPECT_EQ(literal->beam, 101U);
  EXPECT_EQ(literal->angle_degrees, 50);  // 50.5 with the half lost
  EXPECT_EQ(literal->distance, 1.2);
  EXPECT_EQ(algo::obstacle_check(scan, 1.35).value().beam, 250U);
  EXPECT_FALSE(algo::obstacle_check(scan, 0.9).has_value());
  EXPECT_FALSE(algo::obstacle_check_literal(std::vector<double>(10, 0.5), 1.35).has_value());
  // Beam 330 is the literal's alone.
  LaserScan edge = free_scan(361, -90, 0.5);
  edge.set_ok(330, 1);
  EXPECT_TRUE(algo::obstacle_check_literal(edge.ranges, 1.35).has_value());
  EXPECT_FALSE(algo::obstacle_check(edge, 1.35).has_value());
}

TEST(Perceive, PutsTheNearestOfEachSideIntoTheWorld) {
  algo::Scene scene;
  scene.scan = free_scan(361, -90, 0.5);
  scene.scan.set_ok(180, 2);  // straight ahead: left
  scene.scan.set_ok(100, 3);  // 40 degrees to the right
  scene.scan.set_ok(10, 1);   // outside the field
  algo::perceive({1, 1, std::numbers::pi / 2}, scene);
  ASSERT_TRUE(scene.left && scene.right);
  EXPECT_EQ(scene.left->beam, 180U);
  EXPECT_LT((scene.left->point_W - Vec2(1, 3)).norm(), 1e-12);
  EXPECT_EQ(scene.right->beam, 100U);
  // Facing up, 40 degrees to the right is the bearing 50 degrees.
  const Vec2 expected = Vec2(1, 1) + 3 * algo::direction(50_deg);
  EXPECT_LT((scene.right->point_W - expected).norm(), 1e-12);
  scene.scan.set_free(180);
  algo::perceive({}, scene);
  EXPECT_FALSE(scene.left.has_value());  // the earlier point is dropped
}

}  // namespace
