// tests/server/lab/locate_test.cpp: robots that drive by their pose on a map.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/mapping/locate_log.hpp"
#include "server/lab/mapping/locate_study.hpp"

namespace server::mapping {
namespace {

TEST(StartOf, IsThreeNumbers) {
  EXPECT_FALSE(start_of(""));
  EXPECT_EQ(start_of("1,-2.5,0.5"), (algo::Pose2{1, -2.5, 0.5}));
  for (const char* bad : {"1,2", "1;2;3", "1,2,3,4", "x"}) {
    EXPECT_THROW(start_of(bad), std::runtime_error) << bad;
  }
}

TEST(LocatedLog, NamesItsScansAlikeInTextAndJson) {
  LocatedLog found;
  found.poses_M.resize(3);
  found.last = "The robot is nowhere.";
  EXPECT_TRUE(to_json(found)["deviation_m"].is_null());
  EXPECT_TRUE(to_json(found)["first_located"].is_null());
  EXPECT_EQ(to_text(found), "Located at 0 of 3 scans.\nAt the end: The robot is nowhere.");
  found.located = 1;
  found.first = 2;
  found.deviation = 0.125;
  EXPECT_EQ(to_json(found)["deviation_m"], 0.125);
  EXPECT_EQ(to_json(found)["first_located"], 2);
  EXPECT_THAT(to_text(found), testing::HasSubstr("first at scan 2, counted from 0;"));
}

TEST(LocateStudy, RobotsReachFarGoalsByTheMapAndNotByTheirWheels) {
  LocateOptions options;
  options.seeds = 1;
  const std::vector<LocateRun> runs = study_locate(options);
  ASSERT_EQ(runs.size(), 9U);
  for (const LocateRun& run : runs) {
    const std::string about = run.drawing + " " + std::to_string(static_cast<int>(run.by));
    EXPECT_EQ(run.passenger_false, 0) << about;
    EXPECT_EQ(run.false_time, 0) << about;
    if (run.by == DrivesBy::Wheels) {
      EXPECT_FALSE(run.outcome == algo::Outcome::Reached && run.goal_off < 1) << about;
    } else if (run.by == DrivesBy::Map) {
      EXPECT_EQ(run.outcome, algo::Outcome::Reached) << about;
      EXPECT_LT(run.goal_off, 0.3) << about;
      // Between two corridors that look alike, only the lobby decides.
      if (run.drawing == "wings") {
        EXPECT_TRUE(run.passenger_found < 0 || run.passenger_found > 50) << about;
      }
    } else if (run.drawing == "wings") {
      EXPECT_EQ(run.located, 0) << about;
      EXPECT_GT(run.goal_off, 60) << about;  // it stands
    }
  }
}

TEST(Outdated, IsWrongByTheShareAskedFor) {
  const Drawing drawing = drawing_of("offices", 3);
  EXPECT_EQ(outdated(drawing, 0, 1).size(), drawing.pieces.size());
  EXPECT_NE(outdated(drawing, 0.1, 1).size(), drawing.pieces.size());
  EXPECT_THROW(drawing_of("castle", 1), std::invalid_argument);
}

}  // namespace
}  // namespace server::mapping
