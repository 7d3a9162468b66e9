// tests/algo/arm/reach_planner_test.cpp: ways of base and arm to a pose of the hand, and the
// reasons where there is none.
#include "algo/arm/reach_planner.hpp"

#include <numbers>

#include "tests/algo/arm/reach_scene.hpp"
#include <gtest/gtest.h>

namespace {

using algo::ReachLeg;
using algo::ReachPlan;
using reach_scene::Scene;

ReachPlan planned_in(const Scene& scene, const algo::ReachRules& rules = {}) {
  return plan_reach(scene.body, scene.start, scene.hand_W, scene.solids, 5, rules);
}

TEST(FoldedArm, StaysWithinTheBasesCircleAndOffTheBody) {
  const algo::MobileArm body;
  const auto frames = body_frames(body, algo::body_joints({}, algo::folded_arm()));
  for (const auto part :
       {algo::BodyLink::UpperArm, algo::BodyLink::Forearm, algo::BodyLink::Hand}) {
    const algo::LinkAxis link = link_axis(body, frames, part);
    for (const algo::Vec3& end : {link.from_W, link.to_W}) {
      EXPECT_LE(end.head<2>().norm() + link.radius, body.base_radius) << name(part);
    }
  }
  EXPECT_GT(self_clearance(body, frames), algo::ArmPlanRules{}.own_margin);
  EXPECT_GT(limit_margin(body.arm, algo::folded_arm()), 0);
}

TEST(ReachPlanner, EveryPieceOfAPlanKeepsItsMarginsAndTheHandGetsThere) {
  const Scene scene = reach_scene::over_a_table();
  const ReachPlan plan = planned_in(scene);
  ASSERT_FALSE(plan.legs.empty()) << plan.why;
  algo::BodyJoints last = scene.start;
  for (const ReachLeg& leg : plan.legs) {
    EXPECT_EQ(leg.path.front(), last) << name(leg.kind);
    for (std::size_t i = 0; i + 1 < leg.path.size(); ++i) {
      EXPECT_TRUE(is_clear(scene.body, leg.path[i], leg.path[i + 1], scene.solids))
          << name(leg.kind);
    }
    last = leg.path.back();
  }
  EXPECT_LT((body_frames(scene.body, last).hand() - scene.hand_W.translation()).norm(), 1e-9);
}

TEST(ReachPlanner, TheSameArgumentsGiveTheSamePlan) {
  const Scene scene = reach_scene::over_a_table();
  const ReachPlan one = planned_in(scene);
  const ReachPlan two = planned_in(scene);
  ASSERT_EQ(one.legs.size(), two.legs.size());
  for (std::size_t i = 0; i < one.legs.size(); ++i) {
    EXPECT_EQ(one.legs[i].kind, two.legs[i].kind);
    EXPECT_EQ(one.legs[i].path, two.legs[i].path);
  }
}

TEST(ReachPlanner, ATightPlaceComesAfterAnAmpleOne) {
  Scene scene = reach_scene::over_a_table();
  scene.solids.clear();
  const algo::Vec2 from = scene.start.head<2>();
  const auto free = reach_places(scene.body, from, scene.hand_W, {});
  ASSERT_FALSE(free.empty());
  // A post beside the best place leaves it its margin, and no more.
  const algo::Vec2 best = free.front().base_W.position();
  const algo::Vec2 away = (best - scene.hand_W.translation().head<2>()).normalized();
  scene.solids = {reach_scene::post(best + (0.35 + 0.10 + 0.09) * away)};
  const auto beside = reach_places(scene.body, from, scene.hand_W, scene.solids);
  ASSERT_FALSE(beside.empty());
  EXPECT_GT((beside.front().base_W.position() - best).norm(), 0.05);
}

TEST(ReachPlanner, SaysWhyThereIsNoWay) {
  const Scene table = reach_scene::over_a_table();
  const std::string no_place =
      "From no place of the base does the hand reach its goal clear of everything.";
  Scene high = table;
  high.hand_W.translation().z() = 3;
  EXPECT_EQ(planned_in(high).why, no_place);
  Scene enclosed = table;
  enclosed.solids = {reach_scene::post(table.hand_W.translation().head<2>())};
  EXPECT_EQ(planned_in(enclosed).why, no_place);

  Scene walled = table;
  for (int k = 0; k < 4; ++k) {
    const algo::Vec2 out = algo::direction(k * std::numbers::pi / 2);
    algo::Solid wall;
    wall.centre_W = walled.hand_W.translation().head<2>() + 1.8 * out;
    wall.axis_W = out;
    wall.half = {0.05, 1.9};
    walled.solids.push_back(wall);
  }
  EXPECT_EQ(planned_in(walled).why,
            "The base finds no way to a place from which the hand reaches its goal.");

  Scene near = table;
  near.solids.push_back(reach_scene::post({0.47, 0}));
  EXPECT_EQ(planned_in(near).why, "The robot stands too near to something to move its arm.");
}

TEST(ReachPlanner, SaysThatTheArmsSearchEnded) {
  algo::ReachRules rules;
  rules.arm.samples = 0;
  const ReachPlan plan = planned_in(reach_scene::in_a_shelf(), rules);
  EXPECT_TRUE(plan.legs.empty());
  EXPECT_EQ(plan.why, "The arm finds no way between the obstacles to its goal.");
}

}  // namespace
