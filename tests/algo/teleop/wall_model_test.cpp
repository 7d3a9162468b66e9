// tests/algo/teleop/wall_model_test.cpp: votes and the wall that wins.
#include "algo/teleop/wall_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Parameters;
using algo::RingReadings;
using algo::Vec2;
using algo::VotingPoint;
using algo::WallModel;
using algo::units::kRadiansPerDegree;

using tests::kInf;
using tests::kNan;

double degrees(const WallModel& wall) {
  return wall.theta / kRadiansPerDegree;
}

/// The ring's readings of the wall at distance `rho` [m] and bearing `theta` [rad].
RingReadings readings_of(double rho, double theta) {
  RingReadings readings{};
  const auto bearings = algo::ring_bearings();
  for (std::size_t n = 0; n < readings.size(); ++n) {
    const double facing = std::cos(bearings[n] - theta);
    readings[n] = facing > 0.05 ? std::min(3.0, rho / facing) : 3.0;
  }
  return readings;
}

TEST(Votes, OfEqualsTheLowestSensorIsTheNearest) {
  const auto bearings = algo::ring_bearings();
  RingReadings readings{};
  readings.fill(2.0);
  std::array<int, algo::kRingSonars> zeta{};
  algo::count_votes(bearings, readings, Parameters{}, zeta);
  EXPECT_EQ(zeta, (std::array<int, algo::kRingSonars>{2, 1, 1, 0, 0, 0, 0, 0}));
}

TEST(Votes, TheSectorHoldsTwoSonarsOnEitherSide) {
  RingReadings readings{};
  readings.fill(2.0);
  readings[4] = 1.0;
  std::array<int, algo::kRingSonars> zeta{};
  algo::count_votes(algo::ring_bearings(), readings, Parameters{}, zeta);
  EXPECT_EQ(zeta, (std::array<int, algo::kRingSonars>{0, 0, 1, 1, 2, 1, 1, 0}));
}

TEST(Votes, NeedOneReadingForEachSensor) {
  std::array<int, 3> zeta{};
  const std::array<double, 2> two{1, 2};
  EXPECT_THROW(algo::count_votes(two, two, Parameters{}, zeta), std::invalid_argument);
  EXPECT_NO_THROW(algo::count_votes({}, {}, Parameters{}, {}));
}

/// Two cells from the truth at most: five points cannot tell neighbouring cells apart.
TEST(FindWall, FindsWallsOnEverySide) {
  for (double rho = 0.45; rho < 1.6; rho += 0.1) {
    for (double theta = -87.5; theta < 90; theta += 5) {
      const auto wall =
          algo::wall_of_ring(readings_of(rho, theta * kRadiansPerDegree), Parameters{});
      ASSERT_TRUE(wall);
      EXPECT_NEAR(wall->rho, rho, 0.15) << rho << " " << theta;
      EXPECT_NEAR(degrees(*wall), theta, 10.1) << rho << " " << theta;
    }
  }
}

/// One point 1.04 m away at 2.5 degrees. Its curve is above 0 from -87.5 to 92.5 degrees, within 37
/// cells of theta, and passes the borders 1.0, 0.9, .., 0.1 m of rho on either side of its peak.
/// 1.04 cos(35 degrees) = 0.8519 is nearest to a centre of rho: theta = 2.5 - 35 or 2.5 + 35
/// degrees.
TEST(FindWall, APointVotesForEveryCellThatItsCurveCrosses) {
  const Vec2 at = 1.04 * algo::direction(2.5 * kRadiansPerDegree);
  const std::array<VotingPoint, 1> point{{{at, 1}}};
  const auto wall = algo::find_wall(point);
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->votes, 1);
  EXPECT_EQ(wall->ties, 37U + 2 * 10U);
  EXPECT_NEAR(degrees(*wall), -32.5, 1e-9);
  EXPECT_NEAR(wall->rho, 0.85, 1e-9);
}

/// Mirrored readings have mirrored cells, and equal votes and sums: the smaller theta wins, so that
/// rounding does not decide.
TEST(FindWall, AWallDeadAheadCountsAsOneOnTheRight) {
  for (double rho = 0.5; rho < 2; rho += 0.01) {
    const auto wall = algo::wall_of_ring(readings_of(rho, 0), Parameters{});
    ASSERT_TRUE(wall);
    std::array<VotingPoint, 2> points{{{{rho, -0.3}, 1}, {{rho, 0.3}, 1}}};
    const auto mirrored = algo::find_wall(points);
    ASSERT_TRUE(mirrored);
    EXPECT_LT(mirrored->theta, 0) << rho;
  }
}

TEST(FindWall, NobodyVotesNoWall) {
  EXPECT_FALSE(algo::find_wall({}));
  const std::array<VotingPoint, 2> silent{{{{1, 0}, 0}, {{1, 1}, -1}}};
  EXPECT_FALSE(algo::find_wall(silent));
  RingReadings free{};
  free.fill(3.0);
  EXPECT_FALSE(algo::wall_of_ring(free, Parameters{})) << "readings without echo are no wall";
}

/// All eight fail: an obstacle at D_min everywhere.
TEST(FindWall, NanCountsAsAnObstacleAtTheStopDistance) {
  RingReadings readings{};
  readings.fill(kNan);
  const auto wall = algo::wall_of_ring(readings, Parameters{});
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->rho, 0.5, 0.1);
}

TEST(FindWall, PointsThatAreNotFiniteDoNotSpoilTheOthers) {
  std::vector<VotingPoint> points{{{1, -0.2}, 1}, {{1, 0}, 2}, {{1, 0.3}, 1}};
  const auto clean = algo::find_wall(points);
  for (const double bad : {kNan, kInf, -kInf}) {
    points.push_back({{bad, 1}, 2});
    points.push_back({{0, bad}, 2});
  }
  const auto wall = algo::find_wall(points);
  ASSERT_TRUE(clean && wall);
  EXPECT_EQ(wall->rho, clean->rho);
  EXPECT_EQ(wall->theta, clean->theta);
  EXPECT_EQ(wall->votes, clean->votes);
}

TEST(FindWall, KeepsItsLimitsForAnyPoints) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-20, 20);
  for (int n = 0; n < 500; ++n) {
    std::array<VotingPoint, 8> points{};
    int most = 0;
    for (VotingPoint& p : points) {
      p = {{uniform(random), uniform(random)}, static_cast<int>(random() % 3)};
      most += p.votes;
    }
    const auto wall = algo::find_wall(points);
    if (!wall) continue;
    EXPECT_TRUE(wall->rho > 0 && wall->rho < algo::kWallReach);
    EXPECT_LE(std::abs(wall->theta), std::numbers::pi);
    EXPECT_TRUE(wall->votes > 0 && wall->votes <= most);
    EXPECT_GE(wall->ties, 1U);
  }
}

TEST(FindWall, AllocatesNothing) {
  const RingReadings readings = readings_of(0.9, -1.0);
  const Parameters parameters;
  const auto before = allocations::count();
  EXPECT_TRUE(algo::wall_of_ring(readings, parameters));
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
