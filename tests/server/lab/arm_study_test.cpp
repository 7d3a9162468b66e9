// tests/server/lab/arm_study_test.cpp: the arm carried past posts: what the study finds.
#include "server/lab/reproduce/arm_study.hpp"

#include <gtest/gtest.h>

#include "server/lab/reproduce/arm_course.hpp"

namespace {

using namespace server::reproduce;

const ArmStudy& short_arm_study() {
  static const ArmStudy study = study_arm(1);
  return study;
}

TEST(ArmStudy, EachFindingHolds) {
  for (const ArmFinding& finding : short_arm_study().findings) {
    EXPECT_TRUE(finding.holds) << finding.claim << ": " << finding.figures;
  }
  EXPECT_TRUE(all_hold(short_arm_study()));
}

TEST(ArmStudy, EveryReadingMeetsEveryPostAndCourse) {
  const ArmStudy& study = short_arm_study();
  EXPECT_EQ(study.strips.size(), 3 * arm_readings().size());
  EXPECT_EQ(study.drives.size(), 2 * arm_courses(carried_arm()).size());
  for (const BentStrip& row : study.strips) EXPECT_LT(row.before, -0.1) << row.place;
}

TEST(ArmStudy, AFindingThatFailsIsSaid) {
  ArmStudy study = short_arm_study();
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

}  // namespace
