// tests/sim/robot_laws_test.cpp: laws that every algo::Robot obeys.
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/sim/reference_world.hpp"
#include <gtest/gtest.h>

#include "sim/replay.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::Command;
using algo::Observation;
using algo::Robot;

Scenario scenario(PhysicsKind physics) {
  Scenario result;
  result.physics = physics;
  result.obstacles = reference::room(20);
  result.robot.sensors.lasers.front().salt = 0.01;
  result.robot.sensors.lasers.front().pepper = 0.01;
  return result;
}

std::unique_ptr<Robot> bullet(std::uint64_t seed) {
  return std::make_unique<World>(scenario(PhysicsKind::Bullet), seed);
}
std::unique_ptr<Robot> kinematic(std::uint64_t seed) {
  return std::make_unique<World>(scenario(PhysicsKind::Kinematic), seed);
}
/// A log for a seed: the readings depend on the seed.
std::unique_ptr<Robot> log(std::uint64_t seed) {
  std::ostringstream text;
  for (int scan = 0; scan < 200; ++scan) {
    text << "FLASER 4 1.01 2.02 81.91 " << 0.01 * static_cast<double>(100 + seed) + 0.01 * scan;
    for (int pose = 0; pose < 2; ++pose) text << " " << 0.01 * scan << " 0 0";
    text << " " << 0.02 * scan << " host 0\n";
  }
  std::istringstream stream(text.str());
  return std::make_unique<Replay>(stream, "laws.log");
}

struct Kind {
  std::string name{};
  std::function<std::unique_ptr<Robot>(std::uint64_t)> make{};
};
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

class RobotLaws : public testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Robot> make(std::uint64_t seed = 1) const { return GetParam().make(seed); }
  static Command wander(int tick) {
    return {{0.4 - 0.002 * (tick % 300), 0.8 * std::sin(0.05 * tick)}};
  }
};

void expect_same(const Observation& a, const Observation& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.odometry, b.odometry);
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t k = 0; k < a.scans.size(); ++k) {
    EXPECT_EQ(a.scans[k].stamp, b.scans[k].stamp);
    EXPECT_EQ(a.scans[k].ranges, b.scans[k].ranges);
    EXPECT_EQ(a.scans[k].status, b.scans[k].status);
    EXPECT_EQ(a.scans[k].codes, b.scans[k].codes);
  }
  ASSERT_EQ(a.bumpers.size(), b.bumpers.size());
  for (std::size_t k = 0; k < a.bumpers.size(); ++k) EXPECT_EQ(a.bumpers[k], b.bumpers[k]);
  EXPECT_EQ(a.gyro, b.gyro);
  EXPECT_EQ(a.inclinometer, b.inclinometer);
  EXPECT_EQ(a.encoders, b.encoders);
}

TEST_P(RobotLaws, TheSpecIsUsable) {
  const auto robot = make();
  const algo::RobotSpec& spec = robot->spec();
  EXPECT_FALSE(spec.name.empty());
  EXPECT_GT(spec.radius, 0);
  EXPECT_GT(spec.half_track, 0);
  EXPECT_GT(spec.period, 0);
  EXPECT_GT(spec.max_v, 0);
  EXPECT_GT(spec.max_omega, 0);
  EXPECT_EQ(robot->arming(), nullptr);
  EXPECT_EQ(robot->editing() != nullptr, spec.drives);
}

TEST_P(RobotLaws, StopIsAllowedAfterAnyCall) {
  const auto robot = make();
  robot->stop();
  Observation seen;
  robot->reset(seen);
  robot->stop();
  for (int tick = 0; tick < 50; ++tick) {
    ASSERT_TRUE(robot->step(wander(tick), seen));
    robot->stop();
    if (robot->editing() != nullptr) robot->editing()->edit(algo::ClearGoal{});
    robot->stop();
  }
  if (!robot->spec().drives) return;
  for (int tick = 0; tick < 60; ++tick) ASSERT_TRUE(robot->step({}, seen));
  EXPECT_EQ(seen.odometry.twist, algo::Twist2{});
}

TEST_P(RobotLaws, TimeNeverGoesBackAndScansAreNeverFromTheFuture) {
  const auto robot = make();
  Observation seen;
  robot->reset(seen);
  EXPECT_EQ(seen.stamp, 0);
  double last = seen.stamp;
  double last_scan = -1;
  for (int tick = 0; tick < 150; ++tick) {
    ASSERT_TRUE(robot->step(wander(tick), seen));
    EXPECT_GT(seen.stamp, last);
    last = seen.stamp;
    EXPECT_EQ(seen.odometry.stamp, seen.stamp);
    for (const algo::LaserScan& scan : seen.scans) {
      EXPECT_GT(scan.stamp, last_scan);
      EXPECT_LE(scan.stamp, seen.stamp + 1e-9);
      last_scan = scan.stamp;
    }
  }
  EXPECT_GT(last_scan, 0);
}

TEST_P(RobotLaws, SameSeedSameObservations) {
  const auto a = make(3);
  const auto b = make(3);
  Observation seen_a;
  Observation seen_b;
  a->reset(seen_a);
  b->reset(seen_b);
  for (int tick = 0; tick < 150; ++tick) {
    expect_same(seen_a, seen_b);
    EXPECT_EQ(a->ground_truth(), b->ground_truth());
    ASSERT_TRUE(a->step(wander(tick), seen_a));
    ASSERT_TRUE(b->step(wander(tick), seen_b));
  }
}

TEST_P(RobotLaws, AnotherSeedOtherObservations) {
  const auto a = make(3);
  const auto b = make(4);
  Observation seen_a;
  Observation seen_b;
  a->reset(seen_a);
  b->reset(seen_b);
  bool differs = false;
  for (int tick = 0; tick < 20; ++tick) {
    ASSERT_TRUE(a->step({}, seen_a));
    ASSERT_TRUE(b->step({}, seen_b));
    if (seen_a.scans.empty() || seen_b.scans.empty()) continue;
    differs = differs || seen_a.scans[0].ranges != seen_b.scans[0].ranges;
  }
  EXPECT_TRUE(differs);
}

TEST_P(RobotLaws, ResetStartsTheSameRunAgain) {
  const auto robot = make(5);
  Observation first;
  robot->reset(first);
  std::vector<Observation> run;
  for (int tick = 0; tick < 60; ++tick) {
    ASSERT_TRUE(robot->step(wander(tick), first));
    run.push_back(first);
  }
  if (robot->editing() != nullptr) {
    algo::Obstacle extra{.id = 999, .pose_W = {0, 3, 0}, .shape = algo::Cylinder{0.2}};
    EXPECT_EQ(robot->editing()->edit(algo::AddObstacle{extra}), std::nullopt);
  }
  Observation second;
  robot->reset(second);
  EXPECT_EQ(second.stamp, 0);
  for (int tick = 0; tick < 60; ++tick) {
    ASSERT_TRUE(robot->step(wander(tick), second));
    expect_same(run[static_cast<std::size_t>(tick)], second);
  }
}

TEST_P(RobotLaws, TheNextStepTakesItsAnnouncedTime) {
  const auto robot = make();
  Observation seen;
  robot->reset(seen);
  for (int tick = 0; tick < 50; ++tick) {
    const double before = seen.stamp;
    const double period = robot->next_period();
    ASSERT_TRUE(robot->step(wander(tick), seen));
    EXPECT_NEAR(seen.stamp - before, period, 1e-9);
  }
}

TEST_P(RobotLaws, EveryBeamSurvivesTheWire) {
  const auto robot = make();
  Observation seen;
  robot->reset(seen);
  std::size_t beams = 0;
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(robot->step(wander(tick), seen));
    for (const algo::LaserScan& scan : seen.scans) {
      algo::LaserScan copy = scan;
      for (std::size_t i = 0; i < scan.size(); ++i, ++beams) {
        algo::unpack_beam(copy, i, algo::pack_beam(scan, i));
        ASSERT_EQ(copy.ranges[i], scan.ranges[i]);
        ASSERT_EQ(copy.status[i], scan.status[i]);
        ASSERT_EQ(copy.codes[i], scan.codes[i]);
      }
    }
  }
  EXPECT_GT(beams, 0u);
}

TEST_P(RobotLaws, RequestsThatAreNoEditsAreIgnored) {
  const auto robot = make();
  algo::Editing* const editing = robot->editing();
  if (editing == nullptr) return;
  EXPECT_EQ(editing->edit(algo::SetGoal{{1, 2}, {}}), std::nullopt);
  EXPECT_EQ(editing->edit(algo::Joystick{1, 0}), std::nullopt);
  EXPECT_EQ(editing->edit(algo::Stop{true}), std::nullopt);
  EXPECT_EQ(editing->edit(algo::SetParameter{}), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Robots,
                         RobotLaws,
                         testing::Values(Kind{"bullet", bullet},
                                         Kind{"kinematic", kinematic},
                                         Kind{"replay", log}),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace sim
