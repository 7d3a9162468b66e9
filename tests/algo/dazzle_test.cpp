// tests/algo/dazzle_test.cpp: dazzled beams, and the hidden space behind them.
#include "algo/dazzle.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "algo/perceive.hpp"
#include "algo/units.hpp"

namespace algo {
namespace {

using units::kRadiansPerDegree;

RobotSpec disc() {
  RobotSpec spec;
  spec.radius = 0.35;
  return spec;
}

/// Half degrees over 180; nothing in sight.
LaserScan open_field(const Pose2& mount_R = {0.2, 0, 0}) {
  LaserScan scan;
  scan.mount_R = mount_R;
  scan.angle_min = -90 * kRadiansPerDegree;
  scan.angle_increment = 0.5 * kRadiansPerDegree;
  scan.range_max = 8.191;
  scan.resize(361);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
  return scan;
}

/// Beams from `from` to `to` degrees say `code`.
LaserScan with(LaserScan scan, double from, double to, BeamCode code = BeamCode::Dazzled) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double degrees = scan.angle(i) / kRadiansPerDegree;
    if (degrees > from - 0.1 && degrees < to + 0.1) scan.set_invalid(i, code);
  }
  return scan;
}

TEST(Dazzle, AConeAheadHidesThePath) {
  for (const BeamCode code : {BeamCode::Dazzled, BeamCode::Overflow, BeamCode::ReadError}) {
    EXPECT_TRUE(hidden(with(open_field(), -10, 10, code), disc()));
  }
  EXPECT_TRUE(hidden(with(open_field(), 30, 40), disc()));
  EXPECT_TRUE(hidden(with(open_field(), -1, 0), disc()));  // three beams
  EXPECT_FALSE(hidden(open_field(), disc()));
}

TEST(Dazzle, ObstaclesBesideThePathDoNotCount) {
  EXPECT_FALSE(hidden(with(open_field(), 65, 90), disc()));
  EXPECT_FALSE(hidden(with(open_field(), -90, -65), disc()));
  // A long and narrow hull with its scanner in front: 0.2 + 0.05 m wide, seen from 0.1 m behind.
  RobotSpec narrow;
  narrow.half_length = 0.5;
  narrow.half_width = 0.2;
  EXPECT_TRUE(hidden(with(open_field({0.5, 0, 0}), 60, 66), narrow));
  EXPECT_FALSE(hidden(with(open_field({0.5, 0, 0}), 70, 90), narrow));
  EXPECT_FALSE(hidden(with(open_field({0, 0, 0}), 25, 90), narrow));
}

TEST(Dazzle, SingleBeamsAreNoCone) {
  LaserScan scan = open_field();
  for (std::size_t i = 0; i < scan.size(); i += 2) scan.set_invalid(i, BeamCode::Dazzled);
  EXPECT_FALSE(hidden(scan, disc()));
  EXPECT_FALSE(hidden(with(open_field(), 0, 0.5), disc()));  // two
  EXPECT_EQ(widest_cone(scan).end, widest_cone(scan).begin);
}

TEST(Dazzle, ABeamWithoutAnEchoHasLookedAndDoesNotSplitACone) {
  EXPECT_FALSE(hidden(with(open_field(), -40, 40, BeamCode::NoEcho), disc()));
  EXPECT_FALSE(hidden(with(open_field(), -40, 40, BeamCode::WeakSignal), disc()));  // a dark wall
  LaserScan scan = with(open_field(), -1, 1);                                       // five
  scan.set_invalid(180, BeamCode::NoEcho);
  EXPECT_TRUE(hidden(scan, disc()));
  EXPECT_EQ(widest_cone(scan).begin, 178U);
  EXPECT_EQ(widest_cone(scan).end, 183U);
}

TEST(Dazzle, MostBeamsAheadMakeABlindedScan) {
  EXPECT_FALSE(blinded(open_field()));
  EXPECT_FALSE(blinded(with(open_field(), -20, 20)));
  EXPECT_TRUE(blinded(with(open_field(), -30, 30)));
  EXPECT_TRUE(blinded(with(open_field(), -90, 90, BeamCode::NoEcho)));
}

}  // namespace
}  // namespace algo
