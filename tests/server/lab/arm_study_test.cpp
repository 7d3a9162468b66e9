// tests/server/lab/arm_study_test.cpp: the arm carried past posts, and its hand brought to a pose
// among things: what the study finds.
#include "server/lab/reproduce/arm_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/reproduce/arm_course.hpp"

namespace {

using namespace server::reproduce;

const ArmStudy& short_arm_study() {
  static const ArmStudy study = study_arm(1, 1);
  return study;
}

TEST(ArmStudy, EachFindingHolds) {
  for (const ArmFinding& finding : short_arm_study().findings) {
    // One world of each scene says nothing about how often a straight motion touches.
    if (finding.claim.starts_with("In half of these worlds")) continue;
    EXPECT_TRUE(finding.holds) << finding.claim << ": " << finding.figures;
  }
}

TEST(ArmStudy, EveryReadingMeetsEveryPostAndCourse) {
  const ArmStudy& study = short_arm_study();
  EXPECT_EQ(study.strips.size(), 3 * arm_readings().size());
  EXPECT_EQ(study.drives.size(), 2 * arm_courses(carried_arm()).size());
  for (const BentStrip& row : study.strips) EXPECT_LT(row.before, -0.1) << row.place;
}

TEST(ArmStudy, AFindingThatFailsIsSaid) {
  ArmStudy study = short_arm_study();
  for (ArmFinding& finding : study.findings) finding.holds = true;
  EXPECT_TRUE(all_hold(study));
  study.findings.front().holds = false;
  EXPECT_FALSE(all_hold(study));
  EXPECT_NE(to_text(study).find("A finding FAILS."), std::string::npos);
  EXPECT_EQ(to_json(study).at("all_hold"), false);
}

TEST(ArmStudy, RandomThingsLeaveStartAndBaseFree) {
  const ArmCarried carried = carried_arm();
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto solids = random_solids(carried, ArmTrialKind::Anywhere, seed);
    const auto frames = body_frames(carried.body, carried.path.front());
    EXPECT_GT(clearance(carried.body, frames, solids).smallest(), 0.3);
    for (const algo::Solid& solid : solids) EXPECT_LE(solid.velocity_W.y(), 0);
  }
}

TEST(ReachStudy, CountsEachSceneOnceReachable) {
  const ReachStudy& reach = short_arm_study().reach;
  ASSERT_EQ(reach.scenes.size(), kReachScenes.size());
  for (const ReachTrials& row : reach.scenes) {
    EXPECT_EQ(row.worlds, 1U) << row.scene;
    EXPECT_EQ(row.reached + row.refused + row.given_up, row.worlds) << row.scene;
  }
  EXPECT_EQ(reach.all.worlds, kReachScenes.size());
}

TEST(ReachStudy, AGoalInTheAirIsNotReachable) {
  ReachWorld world = random_world(ReachScene::Table, 0);
  world.hand_W.translation().z() = 3;
  const Reach one = reach_in(world, 0);
  EXPECT_FALSE(one.reachable);
  EXPECT_FALSE(one.reached);
  EXPECT_THAT(one.words,
              ::testing::HasSubstr("m from the shoulder, and the farthest it can be is"));
}

TEST(ReachStudy, ASeedGivesOneWorld) {
  for (const ReachScene scene : kReachScenes) {
    const ReachWorld one = random_world(scene, 7);
    const ReachWorld two = random_world(scene, 7);
    EXPECT_EQ(one.hand_W.matrix(), two.hand_W.matrix());
    ASSERT_EQ(one.solids.size(), two.solids.size());
    for (std::size_t i = 0; i < one.solids.size(); ++i) {
      EXPECT_EQ(one.solids[i].centre_W, two.solids[i].centre_W);
    }
    EXPECT_NE(one.hand_W.matrix(), random_world(scene, 8).hand_W.matrix());
  }
}

}  // namespace
