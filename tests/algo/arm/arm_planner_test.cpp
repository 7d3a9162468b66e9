// tests/algo/arm/arm_planner_test.cpp: ways of the arm past things while the base stands.
#include "algo/arm/arm_planner.hpp"

#include <array>

#include "tests/algo/arm/carried_arm.hpp"
#include <gtest/gtest.h>

namespace {

using algo::ArmJoints;
using algo::ArmPlanRules;
using algo::MobileArm;

/// The stretched arm swings ahead; a small thing hangs half way.
struct ArmPastThing {
  MobileArm body{};
  ArmJoints from = algo::arm_of(carried_arm::stretched_aside(0.65));
  ArmJoints to = from;
  std::array<algo::Solid, 1> thing{};

  ArmPastThing() {
    to[0] += 1.0;
    const algo::Vec3 half_way = body_frames(body, algo::body_joints({}, (from + to) / 2)).hand();
    thing[0].centre_W = half_way.head<2>();
    thing[0].rounding = 0.05;
    thing[0].bottom = half_way.z() - 0.05;
    thing[0].top = half_way.z() + 0.05;
  }
  auto plan(std::uint64_t seed, const ArmPlanRules& rules = {}) const {
    return plan_arm(body, {}, from, to, thing, seed, rules);
  }
};

TEST(ArmPlanner, GoesStraightWhereNothingStands) {
  const ArmPastThing past;
  const auto way = plan_arm(past.body, {}, past.from, past.to, {}, 1);
  ASSERT_TRUE(way);
  EXPECT_EQ(*way, (std::vector<ArmJoints>{past.from, past.to}));
}

TEST(ArmPlanner, EveryPieceOfAWayKeepsItsMargins) {
  const ArmPastThing past;
  const auto bodies = [](const ArmJoints& q) { return algo::body_joints({}, q); };
  ASSERT_FALSE(is_clear(past.body, bodies(past.from), bodies(past.to), past.thing));
  ArmPlanRules finer;
  finer.look /= 10;
  finer.margin -= 0.005;  // between two looks of the search
  finer.own_margin -= 0.005;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto way = past.plan(seed);
    ASSERT_TRUE(way) << seed;
    EXPECT_EQ(way->front(), past.from);
    EXPECT_EQ(way->back(), past.to);
    for (std::size_t i = 0; i + 1 < way->size(); ++i) {
      EXPECT_GE(limit_margin(past.body.arm, (*way)[i]), 0);
      EXPECT_TRUE(is_clear(past.body, bodies((*way)[i]), bodies((*way)[i + 1]), past.thing, finer));
    }
  }
}

TEST(ArmPlanner, TheSeedAloneDecides) {
  const ArmPastThing past;
  EXPECT_EQ(past.plan(3), past.plan(3));
  EXPECT_NE(past.plan(3), past.plan(4));
}

TEST(ArmPlanner, FindsNoneWhereAnEndTouchesOrTheSearchEnds) {
  const ArmPastThing past;
  EXPECT_FALSE(past.plan(1, {.samples = 0}));
  EXPECT_FALSE(plan_arm(past.body, {}, past.from, ArmJoints::Zero(), {}, 1));  // in its own base
}

}  // namespace
