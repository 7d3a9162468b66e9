// tests/server/lab/slopes_test.cpp: the study of slopes, in short, and its worlds.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "algo/units.hpp"
#include "server/lab/soak/slope_study.hpp"
#include "sim/solid_caster.hpp"

namespace server::soak {
namespace {

using namespace algo::units;

/// Along the profile the ground is whole, starts and ends on the floor, and folds by 2 degrees at
/// most.
TEST(SlopeWorld, IsOneRidgeOfGentleFolds) {
  std::set<SlopeKind> kinds;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const SlopeWorld world = slope_world(seed);
    kinds.insert(world.kind);
    EXPECT_GE(world.steepest, 3_deg);
    EXPECT_LE(world.steepest, 12_deg);
    EXPECT_NEAR(world.scenario.robot.mass_height, 0.9, 0.0901);
    const auto& pieces = world.scenario.obstacles;
    double height = 0;
    double slope = 0;
    double steepest = 0;
    for (const algo::Obstacle& piece : pieces) {
      ASSERT_FALSE(algo::defect(piece)) << *algo::defect(piece);
      const auto& ramp = std::get<algo::Ramp>(piece.shape);
      const bool down = ramp.low < height - 1e-9;
      EXPECT_NEAR(down ? piece.height : ramp.low, height, 1e-9) << "a step between two facets";
      const double next = std::atan((piece.height - ramp.low) / ramp.length) * (down ? -1 : 1);
      EXPECT_LE(std::abs(next - slope), 2.0001_deg);
      slope = next;
      steepest = std::max(steepest, std::abs(slope));
      height = down ? ramp.low : piece.height;
    }
    EXPECT_NEAR(height, 0, 1e-6);
    EXPECT_LE(std::abs(slope), 2.0001_deg);
    EXPECT_NEAR(steepest, world.steepest, 1e-9);
  }
  EXPECT_EQ(kinds.size(), 3U);
}

/// Every world repeats bit for bit, and the guard keeps the robot up.
TEST(SlopeStudy, TheGuardKeepsTheRobotUp) {
  const SlopeOptions options{.worlds = 12, .first_seed = 1, .seconds = 14};
  const auto rows = run_slopes(options);
  ASSERT_EQ(rows.size(), 12U);
  EXPECT_EQ(turned_over(rows), 0);
  EXPECT_GE(way_share(rows), 0.7);
  int without = 0;
  for (const SlopeRow& row : rows) {
    EXPECT_EQ(row.guarded.way > 1, true) << row.seed;
    if (row.counts() && row.unguarded.overturned) ++without;
  }
  EXPECT_GT(without, 0) << "without the guard these drives prove nothing";
  const SlopeWorld again = slope_world(5);
  EXPECT_EQ(drive_on_slopes(again, 5, 14, true).hash, rows[4].guarded.hash);
  EXPECT_EQ(drive_on_slopes(again, 5, 14, false).hash, rows[4].unguarded.hash);
}

}  // namespace
}  // namespace server::soak
