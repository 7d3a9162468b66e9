// tests/server/lab/operator_test.cpp: the adversarial operator: its worlds, its witness, a few
// seconds of it, and the places in which no robot may be held.
#include <cmath>

#include <gtest/gtest.h>

#include "server/lab/soak/indoor_world.hpp"
#include "server/lab/soak/operator_study.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/scenario_json.hpp"

namespace server::soak {
namespace {

TEST(IndoorWorld, IsTheSameForTheSameSeedAndAValidScenario) {
  int people = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const sim::Scenario world = indoor_world(seed, 0.35);
    EXPECT_EQ(to_json(world), to_json(indoor_world(seed, 0.35)));
    EXPECT_EQ(to_json(scenario_from_json(to_json(world))), to_json(world)) << seed;
    sim::ObstacleSet set;
    for (const algo::Obstacle& obstacle : world.obstacles) {
      set.add(obstacle);
      people += obstacle.path ? 1 : 0;
    }
    EXPECT_GT(set.distance(world.start.position()), 0.4) << seed;
  }
  EXPECT_GT(people, 10);
  EXPECT_NE(to_json(indoor_world(1, 0.35)), to_json(indoor_world(5, 0.35)));
}

TEST(IndoorWorld, PeopleWalkPastAllThatStands) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const sim::Scenario world = indoor_world(seed, 0.35);
    sim::ObstacleSet set;
    for (const algo::Obstacle& obstacle : world.obstacles) {
      if (!obstacle.path) set.add(obstacle);
    }
    for (const algo::Obstacle& obstacle : world.obstacles) {
      if (!obstacle.path) continue;
      const double radius = std::get<algo::Cylinder>(obstacle.shape).radius;
      for (double stamp = 0; stamp < obstacle.path->period; stamp += 0.1) {
        EXPECT_GT(set.distance(obstacle.path->at(stamp)), radius + 0.2) << seed;
      }
    }
  }
}

/// A box ahead of the origin, and a person who comes from the left.
sim::Scenario staged_scenario() {
  sim::Scenario scenario;
  algo::Obstacle ahead{.id = 1, .pose_W = {1, 0, 0}, .shape = algo::Box{0.2, 0.2}};
  algo::Obstacle person{.id = 2, .pose_W = {0, 5, 0}, .shape = algo::Cylinder{0.25}};
  person.path =
      algo::ObstaclePath{.period = 100, .keys = {{0, {0, 5}}, {5, {0, 0.55}}, {100, {0, 0.55}}}};
  scenario.obstacles = {ahead, person};
  return scenario;
}

/// A disc that drives as the test says.
struct Staged {
  void tick(double x, double y, bool collided) {
    observation.stamp += 0.1;
    observation.clear_sensors();
    truth.pose = {x, y, 0};
    truth.collided = collided;
    truth.clearance = collided ? 0 : 0.1;
    if (sees_box) add_beam(truth.pose, {0.9, 0});
    if (sees_person) {
      const algo::Vec2 at_W = scenario.obstacles[1].path->at(observation.stamp);
      add_beam(truth.pose, at_W - algo::Vec2(0, 0.25));
    }
    witness.see(observation, truth);
  }
  void add_beam(const algo::Pose2& pose, const algo::Vec2& to_W) {
    algo::LaserScan& scan = observation.scans.append();
    scan = {};
    scan.stamp = observation.stamp;
    scan.range_max = 8;
    scan.angle_increment = 0.01;
    const algo::Vec2 way = to_W - pose.position();
    scan.angle_min = std::atan2(way.y(), way.x());
    scan.resize(1);
    scan.set_ok(0, way.norm());
  }
  bool sees_box = false, sees_person = false;
  sim::Scenario scenario = staged_scenario();
  algo::Observation observation{};
  algo::GroundTruth truth{};
  ContactWitness witness{scenario, {.radius = 0.3}};
};

TEST(ContactWitness, TellsTheSeenFromTheUnseen) {
  for (const bool seen : {false, true}) {
    Staged staged;
    staged.sees_box = seen;
    for (int k = 0; k < 5; ++k) staged.tick(0.1 * k, 0, false);
    staged.sees_box = false;
    for (int k = 5; k <= 6; ++k) staged.tick(0.1 * k, 0, k == 6);
    for (int k = 0; k < 10; ++k) staged.tick(0.5, 0, false);
    EXPECT_EQ(staged.witness.count(Touch::Seen), seen ? 1 : 0);
    EXPECT_EQ(staged.witness.count(Touch::Unseen), seen ? 0 : 1);
    EXPECT_EQ(staged.witness.seen().size(), seen ? 1U : 0U);
  }
}

TEST(ContactWitness, APersonCountsIfTheRobotDroveTowardsThem) {
  for (const double speed : {0.0, 0.04, 0.1}) {
    Staged staged;
    staged.sees_person = true;
    for (int k = 0; k < 50; ++k) staged.tick(0, 0.1 * speed * (k - 49), k == 49);
    EXPECT_EQ(staged.witness.count(Touch::Seen), speed > 0.05 ? 1 : 0);
    EXPECT_EQ(staged.witness.count(Touch::Came), speed > 0.05 ? 0 : 1);
  }
}

TEST(ContactWitness, ARobotThatAPersonPushesCountsIfItsWheelsDriveTowardsThem) {
  for (const bool by_wheels : {false, true}) {
    Staged staged;
    staged.sees_person = true;
    for (int k = 0; k < 52; ++k) staged.tick(0, 0, k == 51);
    for (int k = 1; k <= 5; ++k) {
      if (by_wheels) staged.observation.odometry.pose.y = 0.02 * k;
      staged.tick(0, 0.02 * k, true);
    }
    EXPECT_EQ(staged.witness.count(Touch::Seen), by_wheels ? 1 : 0);
    EXPECT_EQ(staged.witness.count(Touch::Came), by_wheels ? 0 : 1);
  }
}

TEST(ContactWitness, APersonSeenForLessThanASecondDoesNotCount) {
  Staged staged;
  for (int k = 0; k < 50; ++k) {
    staged.sees_person = k >= 41;
    staged.tick(0, 0.01 * (k - 49), k == 49);
  }
  EXPECT_EQ(staged.witness.count(Touch::Came), 1);
}

/// A few seconds of the study: with this shard, each robot in one world of every kind.
TEST(Operator, DrivesAgainstNothingThatTheRobotHasSeen) {
  OperatorOptions options{.worlds = 12, .seconds = 72, .physics = sim::PhysicsKind::Kinematic};
  options.pool.shard = {.index = 1, .count = 3};
  const OperatorStudy study = run_operator(options);
  double ahead = 0;
  int raw = 0;
  for (const DrivenWorld& world : study.worlds) {
    for (const Hand hand : {Hand::Guarded, Hand::Changing}) {
      const Drive& drive = world.drives.at(static_cast<std::size_t>(hand));
      ahead += drive.ahead;
      for (const std::string& text : drive.seen) {
        ADD_FAILURE() << world.robot << ", world " << world.seed << ", " << name(hand) << ": "
                      << text;
      }
    }
    raw += world.drives.at(static_cast<std::size_t>(Hand::Raw)).touched(Touch::Seen);
  }
  EXPECT_EQ(counted_contacts(study), 0);
  EXPECT_GT(raw, 0) << "it must try hard";
  EXPECT_GT(ahead, 20) << "and the robots must not stand still to be safe";
  EXPECT_EQ(operator_table(study).rows.size(), options.robots.size() * kHands.size());
  EXPECT_EQ(operator_rows(study).rows.size(), 4 * options.robots.size() * kHands.size());
  EXPECT_TRUE(study.places.empty());
}

/// The end of a wall, whose visible part grows as the robot passes, looks as if it moved. It must
/// stay in the map: a corner of the hull turns past it later, where no scanner looks.
TEST(Operator, KnowsAWallThatSeemedToMove) {
  sim::Scenario scenario = indoor_world(29, builtin_robot("jackal").radius);
  scenario.robot = builtin_robot("jackal");
  const Drive drive = drive_adversarially(scenario, 29, 24, Hand::Guarded);
  EXPECT_EQ(drive.touched(Touch::Seen), 0) << (drive.seen.empty() ? "" : drive.seen[0]);
  EXPECT_GT(drive.ahead, 3);
}

TEST(TightPlaces, EveryDoorIsPassedAndEveryWallLeft) {
  for (const char* robot : {"silvermate", "jackal", "robhaz"}) {
    sim::Scenario scenario;
    scenario.robot = builtin_robot(robot);
    scenario.physics = sim::PhysicsKind::Kinematic;
    scenario.drive.ramps = true;
    const TightPlaces places = drive_tight_places(scenario);
    EXPECT_EQ(places.doors_passed, kDoorPoses) << robot;
    EXPECT_EQ(places.walls_left, kWallPoses) << robot;
  }
}

TEST(Operator, IsTheSameWithAnyNumberOfThreads) {
  OperatorOptions options{.worlds = 2, .seconds = 12, .physics = sim::PhysicsKind::Kinematic};
  options.robots.resize(1);
  options.pool.shard = {.index = 1, .count = 2};
  const OperatorStudy study = run_operator(options);
  ASSERT_EQ(study.worlds.size(), 1U);
  EXPECT_EQ(study.worlds[0].seed, 2U);
  options.pool = {.threads = 2};
  const OperatorStudy all = run_operator(options);
  EXPECT_EQ(all.worlds[1].drives[0].ahead, study.worlds[0].drives[0].ahead);
  EXPECT_EQ(all.places.size(), 1U);
}

}  // namespace
}  // namespace server::soak
