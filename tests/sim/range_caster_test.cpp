// tests/sim/range_caster_test.cpp: the caster against an analytic oracle, in many worlds.
#include "sim/range_caster.hpp"

#include <numbers>
#include <random>
#include <vector>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

namespace sim {
namespace {

using algo::Obstacle;
using algo::Pose2;
using reference::uniform;
using std::numbers::pi;

constexpr double kDegree = pi / 180;
const BeamPattern kHalfTurn{-pi / 2, 0.5 * kDegree, 361};

RangeCaster caster_of(const std::vector<Obstacle>& world) {
  RangeCaster caster(0.35);
  for (const Obstacle& obstacle : world) caster.add(obstacle);
  return caster;
}

/// [m] Up to 8, along the heading of `sensor` by a pattern of one beam.
double one_range(RangeCaster& caster, const Pose2& sensor) {
  std::vector<double> range(1);
  caster.cast(sensor, {0, 1, 1}, 8, range);
  return range.front();
}

Obstacle cylinder(std::uint32_t id, double x, double y, double radius) {
  return {.id = id, .pose_W = {x, y, 0}, .shape = algo::Cylinder{radius}};
}
Obstacle box(std::uint32_t id, const Pose2& pose, double length, double width) {
  return {.id = id, .pose_W = pose, .shape = algo::Box{length, width}};
}

TEST(RangeCaster, HandComputedRanges) {
  //        box 1 x 1 about (3, 0)       cylinder r 0.5 about (0, 2)
  RangeCaster caster = caster_of({box(7, {3, 0, 0}, 1, 1), cylinder(9, 0, 2, 0.5)});
  std::vector<double> ranges(361);
  std::vector<std::uint32_t> hits(361);
  caster.cast({0, 0, 0}, kHalfTurn, 8, ranges, hits);
  EXPECT_NEAR(ranges[180], 2.5, 1e-12);  // straight ahead: 3 - 1/2
  EXPECT_NEAR(ranges[360], 1.5, 1e-12);  // to the left: 2 - 0.5
  EXPECT_NEAR(ranges[190], 2.5 / std::cos(5 * kDegree), 1e-12);
  EXPECT_EQ(ranges[100], 8);  // no obstacle: exactly range_max
  EXPECT_EQ(caster.obstacle(hits[180]).id, 7u);
  EXPECT_EQ(caster.obstacle(hits[360]).id, 9u);
  EXPECT_EQ(hits[100], RangeCaster::kNothing);
  // The corner (2.5, 0.5) lies at atan(0.2) = 11.3099 deg: beam 202 (11 deg) hits, 203 does not.
  EXPECT_LT(ranges[202], 8);
  EXPECT_EQ(ranges[203], 8);
}

TEST(RangeCaster, BeamThroughACornerSharedByTwoFacesIsNotLost) {
  // A square on its corner: beam 180 runs exactly through (2, 0).
  RangeCaster caster = caster_of({box(1, {2 + std::sqrt(0.5), 0, pi / 4}, 1, 1)});
  std::vector<double> ranges(361);
  caster.cast({0, 0, 0}, kHalfTurn, 8, ranges);
  EXPECT_NEAR(ranges[180], 2, 1e-9);
}

TEST(RangeCaster, ObstacleLowerThanThePlaneIsInvisible) {
  Obstacle low = cylinder(1, 2, 0, 0.5);
  low.height = 0.34;
  Obstacle level = cylinder(2, 5, 0, 0.5);
  level.height = 0.35;
  RangeCaster caster = caster_of({low, level});
  EXPECT_NEAR(one_range(caster, {0, 0, 0}), 4.5, 1e-12);
  caster.move(1, {1, 0, 0});
  EXPECT_NEAR(one_range(caster, {0, 0, 0}), 4.5, 1e-12);
}

TEST(RangeCaster, SensorInsideAnObstacleReadsZero) {
  for (const Obstacle& obstacle : {cylinder(1, 0.1, 0, 0.5), box(1, {0.1, 0, 0.3}, 1, 1)}) {
    RangeCaster caster = caster_of({obstacle});
    std::vector<double> ranges(361, -1.0);
    std::vector<std::uint32_t> hits(361);
    caster.cast({0, 0, 0}, kHalfTurn, 8, ranges, hits);
    Rays rays;
    rays.resize(361);
    for (std::size_t i = 0; i < 361; ++i) rays.ux[i] = 1;
    std::vector<double> rolling(361, -1.0);
    caster.cast_rolling({0, 0, 0}, kHalfTurn, rays, {0.01, 2}, 8, rolling);
    for (std::size_t i = 0; i < 361; ++i) {
      EXPECT_EQ(ranges[i], 0);
      EXPECT_EQ(hits[i], 0u);
      EXPECT_EQ(rolling[i], 0);
    }
    EXPECT_EQ(one_range(caster, {0, 0, 1}), 0);
  }
}

TEST(RangeCaster, MoveAndRemoveChangeTheRanges) {
  RangeCaster caster = caster_of({cylinder(4, 2, 0, 0.5), box(5, {4, 0, 0}, 1, 1)});
  EXPECT_NEAR(one_range(caster, {0, 0, 0}), 1.5, 1e-12);
  caster.move(4, {0, 3, 0});
  EXPECT_NEAR(one_range(caster, {0, 0, 0}), 3.5, 1e-12);
  EXPECT_NEAR(one_range(caster, {0, 0, pi / 2}), 2.5, 1e-12);
  caster.remove(4);
  EXPECT_EQ(one_range(caster, {0, 0, pi / 2}), 8);
  EXPECT_NEAR(one_range(caster, {0, 0, 0}), 3.5, 1e-12);
}

TEST(RangeCaster, NormalPointsOutOfTheSurface) {
  RangeCaster caster = caster_of({cylinder(1, 0, 0, 1), box(2, {5, 0, pi / 2}, 2, 1)});
  EXPECT_NEAR((caster.normal_W(0, {0, 2}) - algo::Vec2(0, 1)).norm(), 0, 1e-12);
  // Turned by 90 degrees the box reaches from x 4.5 to 5.5.
  EXPECT_NEAR((caster.normal_W(1, {4.5, 0.2}) - algo::Vec2(-1, 0)).norm(), 0, 1e-12);
}

TEST(RangeCaster, RefusesAPatternOfMoreThanOneTurn) {
  RangeCaster caster;
  std::vector<double> ranges(800);
  EXPECT_THROW(caster.cast({}, {0, kDegree, 800}, 8, ranges), std::invalid_argument);
  EXPECT_THROW(caster.cast({}, {0, 0, 10}, 8, ranges), std::invalid_argument);
}

TEST(RangeCaster, AFullTurnSeesAllAround) {
  std::mt19937_64 random(3);
  const std::vector<Obstacle> world = reference::room(20, 5);
  RangeCaster caster = caster_of(world);
  std::vector<double> ranges(720);
  for (int pose = 0; pose < 20; ++pose) {
    const Pose2 sensor{
        uniform(random, -0.8, 0.8), uniform(random, -0.8, 0.8), uniform(random, -pi, pi)};
    const BeamPattern all{uniform(random, -pi, pi), 0.5 * kDegree, 720};
    caster.cast(sensor, all, 30, ranges);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double angle = sensor.heading + all.angle_min + static_cast<double>(i) * 0.5 * kDegree;
      ASSERT_TRUE(reference::agrees(world, sensor.position(), angle, 30, ranges[i], 1e-9))
          << "pose " << pose << " beam " << i;
    }
  }
}

struct Case {
  std::uint32_t obstacles = 0;
  double range_max = 0;
  int poses = 0;
};
class RangeCasterInRooms : public testing::TestWithParam<Case> {};

TEST_P(RangeCasterInRooms, AgreesWithTheOracleToATenthOfAMillimetre) {
  const auto [obstacles, range_max, poses] = GetParam();
  std::mt19937_64 random(obstacles);
  const std::vector<Obstacle> world = reference::room(obstacles);
  RangeCaster caster = caster_of(world);
  const double half = 5 * std::sqrt(obstacles / 20.0);
  std::vector<double> ranges(361);
  std::vector<std::uint32_t> hits(361);
  std::size_t hit_count = 0;
  for (int pose = 0; pose < poses; ++pose) {
    Pose2 sensor;
    do {
      sensor = {
          uniform(random, -half, half), uniform(random, -half, half), uniform(random, -pi, pi)};
    } while (reference::range(world, sensor.position(), 0, 1) == 0);
    caster.cast(sensor, kHalfTurn, range_max, ranges, hits);
    for (std::size_t i = 0; i < 361; ++i) {
      const double angle = sensor.heading - pi / 2 + static_cast<double>(i) * 0.5 * kDegree;
      ASSERT_TRUE(reference::agrees(world, sensor.position(), angle, range_max, ranges[i], 1e-4))
          << "pose " << pose << " beam " << i << ": " << ranges[i] << " instead of "
          << reference::range(world, sensor.position(), angle, range_max);
      ASSERT_EQ(hits[i] == RangeCaster::kNothing, ranges[i] == range_max);
      if (hits[i] != RangeCaster::kNothing) {
        ++hit_count;
        ASSERT_NEAR(reference::range_to(caster.obstacle(hits[i]), sensor.position(), angle),
                    ranges[i],
                    1e-4);
      }
    }
  }
  EXPECT_GT(hit_count, 0u);
}

TEST_P(RangeCasterInRooms, RollingRaysAgreeWithTheOracleRayByRay) {
  const auto [obstacles, range_max, poses] = GetParam();
  std::mt19937_64 random(obstacles + 7);
  const std::vector<Obstacle> world = reference::room(obstacles);
  RangeCaster caster = caster_of(world);
  const double half = 5 * std::sqrt(obstacles / 20.0);
  std::vector<double> ranges(361);
  std::vector<double> more_ranges(2 * 361);
  std::vector<std::uint32_t> first(362);
  Rays rays;
  Rays more;
  rays.resize(361);
  more.resize(2 * 361);
  for (int pose = 0; pose < poses; ++pose) {
    Pose2 sensor;
    do {
      sensor = {
          uniform(random, -half, half), uniform(random, -half, half), uniform(random, -pi, pi)};
    } while (reference::range(world, sensor.position(), 0, 1) == 0);
    const RaySpread spread{uniform(random, 0, 0.05), uniform(random, 0, 0.06)};
    const auto stray = [&](Rays& out, std::size_t slot, std::size_t beam) {
      const double way = uniform(random, -pi, pi);
      const double shift = uniform(random, 0, spread.shift);
      const double angle = -pi / 2 + static_cast<double>(beam) * 0.5 * kDegree +
                           uniform(random, -spread.turn, spread.turn);
      out.x[slot] = shift * std::cos(way);
      out.y[slot] = shift * std::sin(way);
      out.ux[slot] = std::cos(angle);
      out.uy[slot] = std::sin(angle);
    };
    for (std::size_t i = 0; i < 361; ++i) {
      stray(rays, i, i);
      stray(more, 2 * i, i);
      stray(more, 2 * i + 1, i);
      first[i] = static_cast<std::uint32_t>(2 * i);
    }
    first[361] = 2 * 361;
    const auto expect_agreement = [&](const Rays& which, const std::vector<double>& measured) {
      for (std::size_t i = 0; i < which.size(); ++i) {
        const algo::Vec2 origin_W = algo::to_parent(sensor, {which.x[i], which.y[i]});
        const double angle = sensor.heading + std::atan2(which.uy[i], which.ux[i]);
        ASSERT_TRUE(reference::agrees(world, origin_W, angle, range_max, measured[i], 1e-4))
            << "pose " << pose << " ray " << i << ": " << measured[i] << " instead of "
            << reference::range(world, origin_W, angle, range_max);
      }
    };
    caster.cast_rolling(sensor, kHalfTurn, rays, spread, range_max, ranges);
    expect_agreement(rays, ranges);
    caster.cast_more(more, first, range_max, more_ranges);
    expect_agreement(more, more_ranges);
  }
}

INSTANTIATE_TEST_SUITE_P(Rooms,
                         RangeCasterInRooms,
                         testing::Values(Case{20, 8.191, 200},
                                         Case{100, 30, 60},
                                         Case{1000, 8.191, 12},
                                         Case{1000, 30, 12}));

TEST(RangeCaster, PolygonsOfManyCornersAndSlowRay) {
  std::mt19937_64 random(11);
  std::vector<Obstacle> world;
  for (std::uint32_t k = 0; k < 30; ++k) {
    algo::Polygon polygon;
    const std::uint32_t corners = 3 + k % 7;
    const double radius = uniform(random, 0.1, 0.8);
    for (std::uint32_t j = 0; j < corners; ++j) {  // on a circle, hence convex
      polygon.points.push_back(radius *
                               algo::direction((j + uniform(random, 0, 0.8)) * 2 * pi / corners));
    }
    world.push_back(
        {.id = k,
         .pose_W = {uniform(random, -6, 6), uniform(random, -6, 6), uniform(random, -pi, pi)},
         .shape = polygon});
  }
  RangeCaster caster = caster_of(world);
  std::vector<double> ranges(361);
  for (int pose = 0; pose < 60; ++pose) {
    const Pose2 sensor{uniform(random, -6, 6), uniform(random, -6, 6), uniform(random, -pi, pi)};
    caster.cast(sensor, kHalfTurn, 8, ranges);
    for (std::size_t i = 0; i < 361; ++i) {
      const double angle = sensor.heading - pi / 2 + static_cast<double>(i) * 0.5 * kDegree;
      ASSERT_TRUE(reference::agrees(world, sensor.position(), angle, 8, ranges[i], 1e-9))
          << "pose " << pose << " beam " << i;
      ASSERT_TRUE(reference::agrees(world,
                                    sensor.position(),
                                    angle,
                                    8,
                                    one_range(caster, {sensor.x, sensor.y, angle}),
                                    1e-9));
    }
  }
}

}  // namespace
}  // namespace sim
