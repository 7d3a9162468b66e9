// tests/server/lab/crowd_scenario_test.cpp: a recording as a scenario for the page.
#include "server/lab/crowd/crowd_scenario.hpp"

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/lab/crowd/crossing.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/world.hpp"

namespace server::crowd {
namespace {

/// Two people far aside, who make a scene of 10 x 6 m from frame 100 on, and `more` lines.
sim::Scenario crowd_with(const std::string& more, const std::string& name = "square") {
  std::istringstream lines("100 a 0 0\n2600 a 0 0\n100 b 10 6\n2600 b 10 6\n" + more);
  return scenario_of(read_people(lines, name), ScenarioLibrary({}, {}).load("people"));
}

TEST(CrowdScenario, PeopleWalkAtTheirTimesAndTheRobotCrosses) {
  const sim::Scenario scenario = crowd_with("225 7 9.87654 3\n250 7 8.5 3.00049\n300 8 1 1\n");
  EXPECT_EQ(scenario.name, "square");
  EXPECT_EQ(scenario.start, (algo::Pose2{0.5, 3, 0}));
  EXPECT_EQ(scenario.goal->position_W, algo::Vec2(9.5, 3));
  EXPECT_EQ(scenario.controller, "strip_moving");
  ASSERT_EQ(scenario.obstacles.size(), 3U) << "one seen once is never there";
  const algo::ObstaclePath expected{
      .period = 105, .keys = {{5, {9.877, 3}}, {6, {8.5, 3}}}, .comes_and_goes = true};
  EXPECT_EQ(scenario.obstacles[2].path, expected);
  EXPECT_EQ(scenario.obstacles[2].pose_W, (algo::Pose2{9.877, 3, 0}));
  EXPECT_EQ(scenario.obstacles[2].height, kPersonHeight);
  EXPECT_EQ(scenario_from_json(to_json(scenario), RobotLibrary(std::filesystem::path{})).obstacles,
            scenario.obstacles);
}

TEST(CrowdScenario, SomebodyBesideTheRobotAtTheBeginningIsLeftOut) {
  EXPECT_EQ(crowd_with("100 w 1.5 3\n200 w 5 3\n").obstacles.size(), 2U);
  EXPECT_EQ(crowd_with("110 w 1.5 3\n200 w 5 3\n").obstacles.size(), 3U);
}

TEST(CrowdScenario, ItsNameIsOneThatTheServerTakes) {
  EXPECT_EQ(crowd_with("", " Zara 01 (UCY)").name, "zara_01_ucy");
  EXPECT_EQ(crowd_with("", "???").name, "world");
}

TEST(CrowdScenario, ARecordingThatMakesNoneSaysWhy) {
  const auto fault = [](const std::string& text) -> std::string {
    std::istringstream lines(text);
    try {
      scenario_of(read_people(lines, "square"), {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(fault("0 1 0 0\n0 2 5 5\n"), testing::HasSubstr("square: nobody in it walks"));
  EXPECT_THAT(fault("0 1 0 0\n10 1 1 1\n"), testing::HasSubstr("a crossing needs 2 m"));
  const std::string square = "100 a 0 0\n2600 a 0 0\n100 b 10 6\n2600 b 10 6\n";
  EXPECT_THAT(fault(square + "1e9 7 5 5\n"),
              testing::HasSubstr("square lasts 39999996 s, from frame 100 to frame 1000000000 of "
                                 "person 7; a scenario holds 999995 s"));
  EXPECT_THAT(
      fault(square + "200 7 5 5\n200.01 7 5 6\n"),
      testing::HasSubstr("square: frames 200 and 200.01 of person 7 fall on one millisecond"));
  std::string longest = square;
  for (int i = 0; i < 10'000; ++i) longest += fmt::format("{} 7 5 5\n", 200 + i);
  EXPECT_EQ(fault(longest), "none");
  EXPECT_THAT(fault(longest + "20000 7 5 5\n"),
              testing::HasSubstr("person 7 is in 10001 frames; a scenario holds 10000"));
  std::string many;
  for (std::size_t i = 0; i <= kMaxObstacles; ++i)
    many += fmt::format("0 {0} {0} 9\n9 {0} {0} 20\n", i);
  EXPECT_THAT(fault(many), testing::HasSubstr("square holds 2001 people; a world holds 2000"));
}

/// Who is there in the world at a tick is who is there in the recording.
TEST(CrowdScenario, TheWorldHoldsWhomTheRecordingHolds) {
  sim::World world(crowd_with("225 7 9.8 3\n250 7 8.5 3\n"), 1);
  algo::Observation observation;
  algo::Recycled<algo::Moved> moved;
  world.reset(observation);
  std::size_t with_seven = 0;
  for (int tick = 1; tick <= 160; ++tick) {
    world.step({}, observation);
    world.find_moved(moved);
    const bool seven = moved.size() == 3;
    EXPECT_EQ(moved.size(), seven ? 3U : 2U);
    with_seven += seven ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(with_seven) * world.spec().period, 1, 0.06);
}

}  // namespace
}  // namespace server::crowd
