// tests/server/lab/tour_test.cpp: goals of a tour, the ends of its legs, and how doubled a map is.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include "server/lab/buildings/map_trueness.hpp"
#include "server/lab/buildings/tour_study.hpp"
#include "sim/obstacle_set.hpp"

namespace server::buildings {
namespace {

using algo::Pose2;
using algo::Vec2;

constexpr std::uint64_t kFlat = 7;  // seeds, each with doors of 0.80 m
constexpr std::uint64_t kHall = 9;

TEST(TourBuilding, HasNoMovingDoorAndItsPensLeaveTheRestReachable) {
  for (const std::uint64_t seed : {kFlat, kHall}) {
    const TourBuilding tour = tour_building_of(seed, "strip");
    EXPECT_FALSE(algo::any_moves(tour.building.scenario.obstacles));
    EXPECT_FALSE(tour.building.scenario.goal);
    TourGoals goals(tour, seed);
    const Vec2 start_W = tour.building.scenario.start.position();
    for (const Vec2& shut_W : tour.shut_W) EXPECT_TRUE(goals.between(start_W, shut_W).has_none);
  }
  EXPECT_FALSE(tour_building_of(kHall, "strip").shut_W.empty());
}

TEST(TourGoals, AreFreeOfThingsOrShutInAndTheSameForTheSameSeed) {
  const TourBuilding tour = tour_building_of(kHall, "strip");
  sim::ObstacleSet set;
  for (const algo::Obstacle& obstacle : tour.building.scenario.obstacles) set.add(obstacle);
  TourGoals goals(tour, kHall);
  TourGoals again(tour, kHall);
  const Vec2 robot_W = tour.building.scenario.start.position();
  std::map<GoalPlace, int> places;
  int without_way = 0;  // free places within a pen
  for (int k = 0; k < 60; ++k) {
    const TourGoal goal = goals.next(robot_W);
    EXPECT_EQ(goal.position_W, again.next(robot_W).position_W);
    ++places[goal.place];
    const double room = set.distance(goal.position_W);
    switch (goal.place) {
      case GoalPlace::Near:
        EXPECT_LT((goal.position_W - robot_W).norm(), 8);
        [[fallthrough]];
      case GoalPlace::Far:
        EXPECT_GT(room, 0.40);
        EXPECT_GT((goal.position_W - robot_W).norm(), 1.5);
        without_way += goal.truth.has_way ? 0 : 1;
        break;
      case GoalPlace::ShutIn:
        EXPECT_GT(room, 0.3);
        EXPECT_TRUE(goal.truth.has_none);
        break;
      default:
        EXPECT_LE(room, 0);
    }
  }
  EXPECT_EQ(places.size(), 4U);
  EXPECT_LE(without_way, 3);
}

TEST(Tour, JudgesALegByTheTruth) {
  const auto leg = [](bool way, End end) {
    Leg one;
    one.goal.truth = {.has_way = way, .has_none = !way};
    one.end = end;
    return one;
  };
  EXPECT_EQ(verdict_of(leg(true, End::Reached)), Verdict::Reached);
  EXPECT_EQ(verdict_of(leg(true, End::Refused)), Verdict::RefusedWrongly);
  EXPECT_EQ(verdict_of(leg(false, End::Refused)), Verdict::RefusedRightly);
  EXPECT_EQ(verdict_of(leg(true, End::OutOfTime)), Verdict::Late);
  EXPECT_EQ(verdict_of(leg(false, End::OutOfTime)), Verdict::Searched);
  EXPECT_EQ(verdict_of(leg(false, End::Silent)), Verdict::Blocked);
  EXPECT_EQ(verdict_of(leg(true, End::Collided)), Verdict::Collided);
  Leg drifted = leg(true, End::Refused);
  drifted.drifted_off = true;
  EXPECT_EQ(verdict_of(drifted), Verdict::RefusedRightly);
  EXPECT_FALSE(is_fault(drifted));
  EXPECT_TRUE(is_fault(leg(true, End::Blocked)));
}

TEST(Tour, AShortOneReachesItsGoalsOrRefusesThem) {
  const Tour tour = drive_tour(kFlat, {.goals = 4});
  ASSERT_EQ(tour.legs.size(), 4U);
  const Tour same = drive_tour(kFlat, {.goals = 1});
  EXPECT_EQ(tour.legs[0].seconds, same.legs[0].seconds);
  std::ptrdiff_t reached = 0;
  for (std::size_t i = 0; i < tour.legs.size(); ++i) {
    const Leg& leg = tour.legs[i];
    EXPECT_NE(leg.end, End::Collided) << i;
    EXPECT_LT(leg.drift, 0.3) << i;
    EXPECT_GT(leg.memory_mb, 1);
    reached += leg.end == End::Reached ? 1 : 0;
  }
  EXPECT_GE(reached, 2);
  EXPECT_LT(tour.doubled, 0.05);
  EXPECT_GT(tour.walls, 500U);
}

TEST(Tour, RefusesAnUnknownOdometry) {
  EXPECT_EQ(odometry_named("wheels"), Odometry::Wheels);
  EXPECT_THROW(odometry_named("stars"), std::invalid_argument);
}

TEST(TourStudy, HasARowForEachTourAndASumForEachOdometry) {
  TourStudyOptions options{.goals = 2, .odometries = {Odometry::True, Odometry::Wheels}};
  options.buildings.first_seed = kFlat;
  options.buildings.last_seed = kFlat;
  options.buildings.pool.threads = 1;
  const std::vector<Tour> tours = run_tours(options);
  ASSERT_EQ(tours.size(), 2U);
  EXPECT_EQ(tours_table(tours).rows.size(), 4U);
  EXPECT_EQ(legs_table(tours).rows.size(), 4U);
  EXPECT_EQ(tours_json(tours)["tours"].size(), 4U);
}

/// Points of two rooms' walls, each surface, 5 cm apart.
std::vector<Vec2> surfaces(const std::vector<algo::Obstacle>& obstacles) {
  constexpr int kSteps = 80;  // along an edge of a wall
  std::vector<Vec2> points_W;
  for (const algo::Obstacle& obstacle : obstacles) {
    const std::vector<Vec2> corners_W = outline_W(obstacle);
    for (std::size_t i = 0; i < corners_W.size(); ++i) {
      const Vec2 way = corners_W[(i + 1) % corners_W.size()] - corners_W[i];
      if (way.norm() < 0.3) continue;
      for (int k = 0; k < kSteps; ++k) points_W.emplace_back(corners_W[i] + way * k / kSteps);
    }
  }
  return points_W;
}

class DoubledWalls : public testing::Test {
 protected:
  static FloorPlan two_rooms() {
    FloorPlan plan({0, 4, 8}, {0, 5}, 0.9);
    plan.put_door({0, 0}, {1, 0}, 0.5);
    return plan;
  }
  std::vector<algo::Obstacle> walls_ = two_rooms().walls();
  GridOracle truth_{walls_};
  std::vector<Vec2> once_W_ = surfaces(walls_);
};

TEST_F(DoubledWalls, AMapDrawnOnceHasNoneThoughItIsMovedAndTurnedAsAWhole) {
  EXPECT_LT(doubled_share(once_W_, {}, truth_), 0.01);
  const Pose2 drift{3.0, -2.0, 0.4};  // of the robot's W in the true world
  std::vector<Vec2> moved_W;
  for (const Vec2& p : once_W_) moved_W.push_back(to_child(drift, p));
  MapPieces pieces;
  const Pose2 believed_W{moved_W[0].x(), moved_W[0].y(), 1};
  // The robot's newest visit errs by some centimetres.
  const Pose2 true_W =
      compose(drift, {believed_W.x + 0.1, believed_W.y - 0.08, believed_W.heading});
  pieces.visit(believed_W, true_W);
  EXPECT_LT(doubled_share(moved_W, pieces, truth_), 0.03);
}

TEST_F(DoubledWalls, AreCountedWhetherShiftedOrTurned) {
  std::vector<Vec2> shifted_W = once_W_;
  std::vector<Vec2> turned_W = once_W_;
  for (const Vec2& p : once_W_) {
    shifted_W.emplace_back(p + Vec2(0.4, 0.35));
    turned_W.push_back(to_parent(Pose2{0.3, 0.3, 0.1}, p));
  }
  EXPECT_GT(doubled_share(shifted_W, {}, truth_), 0.25);
  EXPECT_GT(doubled_share(turned_W, {}, truth_), 0.2);
}

TEST_F(DoubledWalls, OneDoubledWallCountsByItsShare) {
  std::vector<Vec2> some_W = once_W_;
  std::size_t added = 0;
  for (const Vec2& p : once_W_) {
    const bool lower = p.y() < 0.2 && p.x() > 0.3 && std::abs(p.x() - 4) > 0.3 && p.x() < 7.7;
    if (!lower) continue;  // nor in a corner, where it would lie on another wall
    some_W.emplace_back(p + Vec2(0, 0.4));
    ++added;
  }
  const double share = static_cast<double>(added) / static_cast<double>(some_W.size());
  EXPECT_NEAR(doubled_share(some_W, {}, truth_), share, 0.04);
}

TEST_F(DoubledWalls, NothingIsKnownOfAnEmptyMap) {
  EXPECT_TRUE(std::isnan(doubled_share({}, {}, truth_)));
}

}  // namespace
}  // namespace server::buildings
