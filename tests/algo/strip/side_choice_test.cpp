// tests/algo/strip/side_choice_test.cpp: blocked lane, choice, latch, forgetting and push (E.4).
#include "algo/strip/side_choice.hpp"

#include <cmath>
#include <numbers>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/perceive.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/strip/elastic_strip_controller.hpp"
#include "algo/strip/strip.hpp"

namespace {

using algo::LaserScan;
using algo::Side;
using algo::SideChoice;
using algo::SideInput;
using algo::SidePush;
using algo::Vec2;

/// The robot at the origin looking along x, the goal 4 m ahead, the paper's sizes.
struct Bench {
  LaserScan scan{};
  SideInput in{};
  SideChoice choice{};

  explicit Bench(const worlds::World& world) {
    see(world);
    in.goal_W = {4, 0};
    in.reach = 1.35;
    in.robot_radius = 0.35;
    in.scan = &scan;
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  void see(const worlds::World& world) { worlds::scan_world({}, world, 8, scan); }
  SidePush at(double stamp, const Vec2& force = {-0.1, 0}) {
    in.stamp = stamp;
    return choice.update(in, force);
  }
};

worlds::World post(double x, double y, double radius = 0.2) {
  return {{{{x, y}, radius}}, {}};
}

TEST(SideChoice, TheLaneIs450MillimetresToEitherSide) {
  EXPECT_TRUE(Bench(post(1.2, 0.64)).at(0).blocked_beam.has_value());   // its edge at 0.44
  EXPECT_FALSE(Bench(post(1.2, 0.66)).at(0).blocked_beam.has_value());  // at 0.46
  EXPECT_TRUE(Bench(post(1.2, -0.64)).at(0).blocked_beam.has_value());
  EXPECT_FALSE(Bench(post(1.2, -0.66)).at(0).blocked_beam.has_value());
}

TEST(SideChoice, TheLaneEndsAtTheReachPlusTheRadiusOrAtTheGoal) {
  EXPECT_TRUE(Bench(post(1.89, 0)).at(0).blocked_beam.has_value());   // surface at 1.69 < 1.70
  EXPECT_FALSE(Bench(post(1.91, 0)).at(0).blocked_beam.has_value());  // at 1.71
  Bench behind_the_goal(post(1.5, 0));
  behind_the_goal.in.goal_W = {1.2, 0};
  EXPECT_FALSE(behind_the_goal.at(0).blocked_beam.has_value());
}

TEST(SideChoice, NamesTheNearestBlockingBeam) {
  // Nearest point of the post at bearing atan2(0.1, 1.5) = 3.81 degrees: beam 187.6.
  const auto push = Bench(post(1.5, 0.1)).at(0);
  ASSERT_TRUE(push.blocked_beam.has_value());
  EXPECT_NEAR(static_cast<double>(*push.blocked_beam), 187.6, 1.0);
}

TEST(SideChoice, TakesTheSideWithLessOfTheObstacle) {
  Bench left(post(1.5, 0.1));  // the obstacle lies to the left: pass on the right
  left.at(0);
  EXPECT_EQ(left.choice.state().side, Side::Right);
  Bench right(post(1.5, -0.1));
  right.at(0);
  EXPECT_EQ(right.choice.state().side, Side::Left);
  Bench even(post(1.5, 0));
  even.at(0);
  EXPECT_EQ(even.choice.state().side, Side::Left);
}

TEST(SideChoice, SideIsChosenOnlyWithinTheReachPlus100Millimetres) {
  Bench far(post(1.67, 0));  // surface at 1.47
  EXPECT_TRUE(far.at(0).blocked_beam.has_value());
  EXPECT_EQ(far.choice.state().side, Side::None);
  EXPECT_EQ(far.at(0).alpha, 0);
  Bench near(post(1.63, 0));  // 1.43
  near.at(3.5);
  EXPECT_EQ(near.choice.state().side, Side::Left);
  EXPECT_EQ(near.choice.state().since, 3.5);
}

TEST(SideChoice, SideIsKeptWhileBlockedAndDroppedTwoSecondsAfter) {
  Bench bench(post(1.5, 0.1));
  bench.at(0);
  EXPECT_EQ(bench.choice.state().side, Side::Right);
  bench.see(post(1.5, -0.1));  // now left would be shorter
  bench.at(1);
  EXPECT_EQ(bench.choice.state().side, Side::Right);
  EXPECT_EQ(bench.choice.state().since, 0);
  bench.see({});
  EXPECT_EQ(bench.at(1.5).alpha, 0);
  bench.at(3.0);  // exactly 2 s after the last blocked tick: not yet
  EXPECT_EQ(bench.choice.state().side, Side::Right);
  bench.at(3.1);
  EXPECT_EQ(bench.choice.state().side, Side::None);
  bench.see(post(1.5, -0.1));
  bench.at(3.2);
  EXPECT_EQ(bench.choice.state().side, Side::Left);
}

TEST(SideChoice, ThePushIsSidewaysAndAsLargeAsItsShareOfTheForce) {
  Bench bench(post(1.5, 0.1));
  const SidePush push = bench.at(0, {-0.3, 0});
  EXPECT_EQ(push.alpha, 1);
  EXPECT_LT((push.force_W - Vec2(0, -0.3)).norm(), 1e-12);  // to the right
  EXPECT_EQ(bench.at(0, {0, 0}).force_W, Vec2(0, 0));
  EXPECT_EQ(bench.at(0, {0.3, 0}).force_W, Vec2(0, 0));  // the force already helps
}

TEST(SideShare, RisesBetween45And15Degrees) {
  const Vec2 u{1, 0};
  const auto share = [&](double degrees) {
    return algo::side_share(-algo::direction(degrees * std::numbers::pi / 180), u);
  };
  EXPECT_EQ(share(10), 1);
  EXPECT_NEAR(share(15), 1, 1e-12);
  EXPECT_NEAR(share(45), 0, 1e-12);
  EXPECT_EQ(share(50), 0);
  // (cos 30 - cos 45) / (cos 15 - cos 45) = 0.158919 / 0.258819
  EXPECT_NEAR(share(30), 0.614016, 1e-5);
  EXPECT_EQ(algo::side_share({0, 0}, u), 0);
}

LaserScan ranges_about(std::size_t centre, const std::vector<double>& ranges) {
  LaserScan scan;
  worlds::scan_world({}, {}, 8, scan);
  for (std::size_t k = 0; k < ranges.size(); ++k) scan.set_ok(centre + k, ranges[k]);
  return scan;
}

TEST(ChooseSide, TheClusterEndsWhereTheRangeJumps) {
  // Seen from beam 180 (1 m): 1.7 belongs to the cluster, 1.9 does not. Beams 178..181 + goal 180:
  // one beam to the left, two to the right: left is shorter.
  EXPECT_EQ(algo::choose_side(ranges_about(177, {1.9, 1.7, 1, 1, 1.7, 1.9}), 180, 0), Side::Left);
  // A beam more on the left, and another: right is shorter.
  EXPECT_EQ(algo::choose_side(ranges_about(178, {1.9, 1, 1, 1.7, 1.2}), 180, 0), Side::Right);
}

TEST(ChooseSide, ABeamWithoutAMeasurementDoesNotEndTheCluster) {
  LaserScan scan = ranges_about(176, {1, 1, 1, 1, 1, 1});  // 176..181: left is shorter
  EXPECT_EQ(algo::choose_side(scan, 180, 0), Side::Left);
  scan.set_invalid(179, algo::BeamCode::NoEcho);
  EXPECT_EQ(algo::choose_side(scan, 180, 0), Side::Left);
  scan.set_free(179);  // 180..181: right is shorter
  EXPECT_EQ(algo::choose_side(scan, 180, 0), Side::Right);
}

TEST(ChooseSide, CountsFromTheGoalsBearingInTheScanner) {
  const LaserScan even = ranges_about(178, {1, 1, 1, 1, 1});  // 178..182
  EXPECT_EQ(algo::choose_side(even, 180, 0), Side::Left);
  const double two_beams = std::numbers::pi / 180;
  EXPECT_EQ(algo::choose_side(even, 180, two_beams), Side::Left);
  EXPECT_EQ(algo::choose_side(even, 180, -two_beams), Side::Right);
  LaserScan turned = even;  // the scanner is turned two beams left; the goal is ahead in R
  turned.mount_R.heading = two_beams;
  EXPECT_EQ(algo::choose_side(turned, 180, 0), Side::Right);
}

TEST(SideChoice, AScannerMountedElsewhereSeesTheSameLane) {
  Bench ahead(post(1.5, 0));
  ahead.scan.mount_R = {0.3, 0, 0};  // what it sees at 1.3 m is 1.6 m from the centre
  EXPECT_TRUE(ahead.at(0).blocked_beam.has_value());
  ahead.scan.mount_R = {0.3, 0.8, 0};  // 0.8 m to the left: the post is beside the lane
  EXPECT_FALSE(ahead.at(0).blocked_beam.has_value());
  ahead.scan.mount_R = {0, 0, std::numbers::pi};  // looks back
  EXPECT_FALSE(ahead.at(0).blocked_beam.has_value());
}

/// The push of a first tick.
algo::StripForces forces_of(const char* name,
                            const algo::ControlInput& in,
                            const algo::Parameters& parameters) {
  const auto controller = algo::builtin_controllers().at(name).make();
  algo::ControlOutput out;
  controller->update(in, parameters, out);
  return dynamic_cast<const algo::ElasticStripController&>(*controller).forces();
}

/// Force law and side choice combine freely: the side choice only adds its push to the force of the
/// law alone.
TEST(SideChoice, AddsOnlyItsPushToEachLaw) {
  const algo::Pose2 pose{0, 0, 0};
  algo::Scene scene;
  worlds::scan_world(pose, post(1.4, 0.02, 0.3), 8, scene.scan);
  algo::perceive(pose, scene);
  const algo::Parameters parameters;
  const algo::RobotSpec spec{.radius = 0.35};
  algo::ControlInput in;
  in.scene = &scene;
  in.goal = algo::SetGoal{{4, 0}, std::nullopt};
  in.spec = &spec;
  const std::pair<const char*, const char*> pairs[] = {{"original", "original_side"},
                                                       {"modified_c1", "modified"}};
  for (const auto& [without, with] : pairs) {
    const algo::StripForces plain = forces_of(without, in, parameters);
    const algo::StripForces chosen = forces_of(with, in, parameters);
    EXPECT_EQ(plain.side, Side::None);
    EXPECT_FALSE(plain.blocked_beam);
    EXPECT_EQ(chosen.side, Side::Right);
    EXPECT_EQ(plain.left_W, chosen.left_W);
    EXPECT_EQ(plain.right_W, chosen.right_W);
    const Vec2 push = chosen.elastic_W - plain.elastic_W;
    EXPECT_NEAR(push.x(), 0, 1e-12) << with;
    EXPECT_NEAR(push.y(), -chosen.side_alpha * plain.elastic_W.norm(), 1e-12) << with;
    EXPECT_LT(push.y(), -0.01) << with;
  }
}

/// A side belongs to one goal.
TEST(SideChoice, AnotherGoalResetsTheSide) {
  const algo::Pose2 pose{0, 0, 0};
  algo::Scene scene;
  worlds::scan_world(pose, post(1.4, 0.02, 0.3), 8, scene.scan);
  algo::perceive(pose, scene);
  const algo::RobotSpec spec{.radius = 0.35};
  algo::ControlInput in;
  in.scene = &scene;
  in.goal = algo::SetGoal{{4, 0}, std::nullopt};
  in.spec = &spec;
  algo::ControlOutput out;
  const auto controller = algo::builtin_controllers().at("modified").make();
  controller->update(in, {}, out);
  EXPECT_EQ(out.measure("strip.side"), -1);  // right
  EXPECT_GT(out.measure("strip.push").value_or(0), 0);
  in.goal = algo::SetGoal{{0, 4}, std::nullopt};  // nothing in that way
  controller->update(in, {}, out);
  EXPECT_EQ(out.measure("strip.side"), 0);
}

}  // namespace
