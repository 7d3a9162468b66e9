// tests/server/lab/soak_test.cpp: random worlds, their true reachability, and runs in a few.
#include "server/lab/soak/soak.hpp"

#include <gtest/gtest.h>

#include "server/lab/soak/random_world.hpp"
#include "server/run/scenario_json.hpp"
#include "sim/obstacle_set.hpp"

namespace server::soak {
namespace {

TEST(RandomWorld, IsTheSameForTheSameSeedAndAValidScenario) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const sim::Scenario world = random_world(seed, "strip");
    EXPECT_EQ(to_json(world), to_json(random_world(seed, "strip")));
    EXPECT_EQ(to_json(scenario_from_json(to_json(world))), to_json(world)) << seed;
    sim::ObstacleSet set;
    for (const algo::Obstacle& obstacle : world.obstacles) set.add(obstacle);
    EXPECT_GT(set.distance(world.start.position()), 0.4);
  }
  EXPECT_NE(to_json(random_world(1, "strip")), to_json(random_world(2, "strip")));
}

TEST(RandomWorld, AClosedDoorIsNoPath) {
  sim::Scenario world;
  algo::Obstacle wall;
  wall.id = 1;
  wall.pose_W = {0, 0, 1.5707963};
  wall.shape = algo::Wall{20, 0.1};
  world.obstacles.push_back(wall);
  EXPECT_FALSE(reachable(world, {-2, 0}, {2, 0}, 0.35, 0.1));
  EXPECT_TRUE(reachable(world, {-2, 0}, {-3, 3}, 0.35, 0.1));
  world.obstacles[0].shape = algo::Wall{8, 0.1};  // the wall ends within the room
  EXPECT_TRUE(reachable(world, {-2, 0}, {2, 0}, 0.35, 0.1));
}

TEST(Soak, NoForbiddenOutcomeOccurs) {
  const std::vector<World> worlds = run_worlds({.worlds = 3});
  for (const World& world : worlds) {
    EXPECT_FALSE(is_fault(world.row))
        << world.seed << ": " << ending(world.row) << ", " << world.row.reason;
    EXPECT_GE(world.row["min_clearance_m"], 0);
  }
  const experiment::Table table = endings_table(worlds);
  int counted = 0;
  for (const auto& line : table.rows) counted += std::stoi(line[1]);
  EXPECT_EQ(counted, 3);
}

/// In these worlds the robot once backed into space that its scanner had never seen.
TEST(Soak, WorldsOfFormerCollisionsInReverse) {
  for (const std::uint64_t seed : {227U, 350U, 509U}) {
    const experiment::Row row = run_trial(trial_of(seed, "strip"));
    EXPECT_EQ(ending(row), "reached") << seed << ": " << row.reason;
  }
}

TEST(Soak, EachFaultHasItsName) {
  const auto row = [](algo::Outcome outcome, double silent, double not_finite) {
    return experiment::Row{.outcome = outcome,
                           .figures = {{"silent", silent}, {"not_finite", not_finite}}};
  };
  EXPECT_EQ(ending(row(algo::Outcome::Stuck, 0, 0)), "gave a reason");
  EXPECT_EQ(ending(row(algo::Outcome::Stuck, 1, 0)), "silent");
  EXPECT_EQ(ending(row(algo::Outcome::OutOfTime, 0, 0)), "out of time");
  EXPECT_FALSE(is_fault(row(algo::Outcome::OutOfTime, 0, 0)));
  EXPECT_TRUE(is_fault(row(algo::Outcome::Stuck, 1, 0)));
  EXPECT_TRUE(is_fault(row(algo::Outcome::Collided, 0, 0)));
  EXPECT_TRUE(is_fault(row(algo::Outcome::Failed, 0, 1)));
}

}  // namespace
}  // namespace server::soak
