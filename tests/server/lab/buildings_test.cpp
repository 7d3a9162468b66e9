// tests/server/lab/buildings_test.cpp: random buildings, what is true of them, and runs in a few.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

#include "server/lab/buildings/building_study.hpp"
#include "server/lab/buildings/furniture.hpp"
#include "server/lab/buildings/grid_oracle.hpp"
#include "server/run/scenario_json.hpp"
#include "sim/obstacle_set.hpp"

namespace server::buildings {
namespace {

using algo::Vec2;
using server::to_json;  // of a scenario

/// Two rooms of 4 m with a door between them.
FloorPlan two_rooms(double door_width) {
  FloorPlan plan({0, 4, 8}, {0, 4}, door_width);
  plan.put_door({0, 0}, {1, 0}, 0.5);
  return plan;
}

TEST(FloorPlan, ADoorIsAsWideAsWanted) {
  for (const double width : kDoorWidths) {
    const FloorPlan plan = two_rooms(width);
    ASSERT_EQ(plan.doors().size(), 1U);
    const Vec2 middle_W = plan.doors()[0].middle_W;
    sim::ObstacleSet set;
    for (const algo::Obstacle& wall : plan.walls()) set.add(wall);
    EXPECT_NEAR(set.distance(middle_W), width / 2, 1e-9);
    GridOracle oracle(plan.walls());
    EXPECT_TRUE(oracle.way({1, 1}, {7, 1}, width / 2 - 0.005, 0.1));
    EXPECT_FALSE(oracle.way({1, 1}, {7, 1}, width / 2 + 0.005, 0.1));
  }
}

TEST(FloorPlan, WallsInOneLineAreOneObstacle) {
  EXPECT_EQ(two_rooms(0.9).walls().size(), 6U);  // four around, two beside the door
}

TEST(FloorPlan, AnEdgeTooShortForADoorIsOpen) {
  FloorPlan plan({0, 1, 2}, {0, 1}, 0.9);
  plan.put_door({0, 0}, {1, 0}, 0.5);
  EXPECT_TRUE(plan.doors().empty());
  EXPECT_TRUE(GridOracle(plan.walls()).way({0.5, 0.5}, {1.5, 0.5}, 0.35, 0.1));
}

TEST(GridOracle, TheShortestWayHasItsLength) {
  const FloorPlan plan = two_rooms(1.0);
  GridOracle oracle(plan.walls());
  const auto way = oracle.way({1.025, 1.025}, {3.025, 1.025}, 0.35, 0.1);
  ASSERT_TRUE(way);
  EXPECT_NEAR(length_of(*way), 2, 1e-9);
}

TEST(GridOracle, LeavesANarrowPlaceButEntersNone) {
  const FloorPlan plan = two_rooms(1.0);
  GridOracle oracle(plan.walls());
  const Vec2 at_wall(0.05 + 0.36, 2.025);  // 0.36 m from the wall
  EXPECT_TRUE(oracle.way(at_wall, {3, 2}, 0.395, 0.1));
  EXPECT_FALSE(oracle.way({3, 2}, Vec2(0.05 + 0.2, 2), 0.395, 0.1));
}

TEST(Buildings, AreTheSameForTheSameSeedAndValidScenarios) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Building building = building_of(seed, "strip");
    const sim::Scenario& world = building.scenario;
    EXPECT_EQ(to_json(world), to_json(building_of(seed, "strip").scenario));
    EXPECT_EQ(to_json(scenario_from_json(to_json(world))), to_json(world)) << seed;
    sim::ObstacleSet set;
    for (const algo::Obstacle& obstacle : world.obstacles) set.add(obstacle);
    EXPECT_GT(set.distance(world.start.position()), 0.35 + 0.02) << seed;
  }
  EXPECT_NE(to_json(building_of(1, "strip").scenario), to_json(building_of(2, "strip").scenario));
}

TEST(Buildings, TheScenarioIsTheFirstOfTheChosenWithTheLimitOfItsRun) {
  const sim::Scenario hall = first_scenario({.kinds = {Kind::Hall}});
  EXPECT_EQ(hall.title, "Building 3: hall");
  EXPECT_EQ(hall.time_limit, limit_of(truth_of(building_of(3, "strip"))));
  EXPECT_THROW(first_scenario({.first_seed = 1, .last_seed = 1, .kinds = {Kind::Maze}}),
               std::invalid_argument);
}

/// Its cells are as wide as its doors: start and goal once fell on one place, and the thing about
/// the goal had a negative length.
TEST(Buildings, OfNarrowCellsHaveAGoalAwayFromTheStart) {
  const sim::Scenario world = building_of(197, "strip").scenario;
  EXPECT_EQ(to_json(scenario_from_json(to_json(world))), to_json(world));
  EXPECT_GT((world.goal->position_W - world.start.position()).norm(), 2);
}

TEST(Buildings, HaveEveryKindOfGoalAndAreNotTooBig) {
  std::array<int, 4> places{};
  std::array<int, 2> ways{};
  int doors = 0;
  int nose_on = 0;
  int legs = 0;
  constexpr std::uint64_t kSeeds = 48;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Building building = building_of(seed, "strip");
    ++places.at(static_cast<std::size_t>(building.goal_place));
    doors += building.timed_door ? 1 : 0;
    nose_on += building.nose_on ? 1 : 0;
    const Truth truth = truth_of(building);
    EXPECT_FALSE(truth.has_way && truth.has_none) << seed;
    EXPECT_EQ(truth.has_way, truth.time.has_value()) << seed;
    ways[0] += truth.has_none ? 1 : 0;
    ways[1] += truth.has_way ? 1 : 0;
    for (const algo::Obstacle& obstacle : building.scenario.obstacles) {
      EXPECT_LT(obstacle.pose_W.position().cwiseAbs().maxCoeff(), 66) << seed;
      const auto* const round = std::get_if<algo::Cylinder>(&obstacle.shape);
      legs += round != nullptr && 2 * round->radius == kLeg ? 1 : 0;
    }
  }
  for (const int count : places) EXPECT_GT(count, 2);
  EXPECT_GT(ways[0], 6);
  EXPECT_GT(ways[1], 20);
  EXPECT_GT(doors, 3);
  EXPECT_GT(nose_on, 2);
  EXPECT_GT(legs, 100);
}

/// While the door is shut there is no way through it.
TEST(Buildings, ATimedDoorShutsItsDoorway) {
  int tried = 0;
  for (std::uint64_t seed = 0; seed < 72; ++seed) {
    const Building building = building_of(seed, "strip");
    if (!building.timed_door) continue;
    const TimedDoor& door = *building.timed_door;
    const auto leaf = std::ranges::find(building.scenario.obstacles, door.id, &algo::Obstacle::id);
    ASSERT_NE(leaf, building.scenario.obstacles.end());
    ASSERT_TRUE(leaf->path);
    const Vec2 shut_W = door.shut_W.position();
    EXPECT_EQ(leaf->path->at(door.opens - 1), shut_W);
    EXPECT_GE((leaf->path->at(0) - shut_W).norm(), building.door_width - 1e-9);
    EXPECT_GE((leaf->path->at(door.opens + 10) - shut_W).norm(), building.door_width - 1e-9);
    ++tried;
  }
  EXPECT_GT(tried, 5);
}

TEST(BuildingStudy, CountsEndsByTheTruth) {
  const auto run = [](bool way, algo::Outcome outcome, double state, double time) {
    BuildingRun r;
    r.truth = {.time = way ? std::optional(10.0) : std::nullopt, .has_way = way, .has_none = !way};
    r.row = {.outcome = outcome,
             .figures = {{"silent", 0.0}, {"end_state", state}, {"time_s", time}}};
    return r;
  };
  constexpr double kNoWay = 8;  // FullStripController::kNoWay
  constexpr double kBlocked = 9;
  const std::array runs{run(true, algo::Outcome::Reached, 0, 15),
                        run(true, algo::Outcome::Stuck, kNoWay, 80),
                        run(true, algo::Outcome::OutOfTime, 1, 120),
                        run(false, algo::Outcome::Stuck, kNoWay, 80),
                        run(false, algo::Outcome::Stuck, kBlocked, 80),
                        run(false, algo::Outcome::Collided, 1, 3)};
  std::vector<const BuildingRun*> all;
  for (const BuildingRun& each : runs) all.push_back(&each);
  const BuildingFigures f = figures_of(all);
  EXPECT_EQ(f.with_way, 3U);
  EXPECT_EQ(f.reached, 1U);
  EXPECT_EQ(f.refused, 1U);
  EXPECT_EQ(f.late, 1U);
  EXPECT_EQ(f.without_way, 3U);
  EXPECT_EQ(f.said, 1U);
  EXPECT_EQ(f.collisions, 1U);
  EXPECT_DOUBLE_EQ(f.ratio_median, 1.5);
}

TEST(BuildingStudy, RunsTheChosenKindsAlikeWithAnyNumberOfThreads) {
  Options options{.first_seed = 0, .last_seed = 7, .kinds = {Kind::Flat}};
  options.pool.threads = 1;
  const std::vector<BuildingRun> one = run_buildings(options);
  ASSERT_EQ(one.size(), 2U);  // seeds 1 and 7
  EXPECT_EQ(one[1].seed, 7U);
  options.pool.threads = 2;
  const std::vector<BuildingRun> two = run_buildings(options);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NE(one[i].end(), End::Collided);
    EXPECT_EQ(one[i].row["time_s"], two[i].row["time_s"]);
  }
  EXPECT_EQ(figures_table(one).rows.size(), kKinds.size() + kDoorWidths.size() + 2);
}

TEST(BuildingStudy, RefusesAnUnknownKind) {
  EXPECT_EQ(kind_named("dead_ends"), Kind::DeadEnds);
  EXPECT_THROW(kind_named("castle"), std::invalid_argument);
}

}  // namespace
}  // namespace server::buildings
