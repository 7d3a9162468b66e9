// tests/algo/explain_test.cpp: the sentences contain the numbers of the tick.
#include "algo/explain.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "algo/full_strip/full_strip_controller.hpp"
#include "algo/gate.hpp"
#include "algo/pipeline/controllers.hpp"

namespace algo {
namespace {

Telemetry driving() {
  Telemetry t;
  t.observation.stamp = 10.0;
  t.goal = SetGoal{.position_W = {3, 4}};
  t.mission = Mission::Driving;
  t.behaviour = behaviours::kAvoid;
  t.scene.left = Nearest{.beam = 200, .point_W = {1, 0}, .distance = 1.0};
  return t;
}

/// The sentences of `controller` for `t`.
Explanation said(const char* controller, const Telemetry& t) {
  Explanation words{"of a tick before", "and its why"};
  explain(t, *builtin_controllers().at(controller).make(), words);
  return words;
}

TEST(Explain, FreeDrivingTellsTheDistanceToGo) {
  const Explanation words = said("modified", driving());
  EXPECT_EQ(words.what, "Driving to the goal");
  EXPECT_EQ(words.why, "5.00 m to go. The nearest return is 1.00 m from the robot's centre.");
}

TEST(Explain, ADriverIsToldWhatLimitsHim) {
  Telemetry t = driving();
  t.behaviour = behaviours::kManual;
  t.command.base = {0.1, 0};
  const std::string free = said("modified", t).why;
  EXPECT_EQ(free,
            "0.10 m/s ahead, 0.00 rad/s. The nearest return is 1.00 m from the robot's centre.");
  t.limit = {"ground", "Ground that the robot cannot drive over lies just ahead."};
  EXPECT_EQ(said("modified", t).why,
            free + " Ground that the robot cannot drive over lies just ahead.");
}

TEST(Explain, ThePlannerTellsThePathLength) {
  Telemetry t = driving();
  t.output.state = 1;
  t.output.measures.push_back({"plan.length", "m", 2.5});
  EXPECT_EQ(said("certainty_grid", t).what, "Following its plan");
  EXPECT_EQ(said("certainty_grid", t).why, "The path over the grid is 2.50 m long.");
}

TEST(Explain, TheHistogramTellsTheFreeSectors) {
  Telemetry t = driving();
  t.output.state = 1;
  t.output.measures.push_back({"histogram.free", "", 41});
  t.output.pass_W = Vec2{4, -3};  // at right angles to the goal
  EXPECT_EQ(said("vfh", t).why, "41 of 72 sectors are free; the way is 90 degrees off the goal.");
  t.mission = Mission::Stuck;
  t.output.state = 2;
  EXPECT_EQ(said("vfh", t).what, "Stuck");
  EXPECT_EQ(said("vfh", t).why,
            "No sector of the histogram is free. 5.00 m to go. Move an obstacle or the goal.");
}

TEST(Explain, TheWindowTellsItsCandidates) {
  Telemetry t = driving();
  t.output.state = 1;
  t.output.twist = {0.25, -0.5};
  t.output.measures.push_back({"window.allowed", "", 17});
  EXPECT_EQ(said("dwa", t).why,
            "17 of 189 motions can be stopped in time; the best is 0.25 m/s, -0.50 rad/s.");
}

TEST(Explain, TheFullStripTellsTheDistanceAlongIt) {
  Telemetry t = driving();
  t.output.state = FullStripController::kFollowing;
  t.output.twist.v = 0.5;
  t.output.measures.push_back({"strip.length", "m", 6.25});
  EXPECT_EQ(said("strip", t).why,
            "6.25 m along it to the goal, at 0.50 m/s. The nearest return is 1.00 m from the "
            "robot's centre.");
  t.output.state = FullStripController::kGivingWay;
  t.output.measures.push_back({"moving.count", "", 3});
  EXPECT_EQ(said("strip_moving", t).what, "Giving way");
  EXPECT_EQ(said("strip_moving", t).why, "3 things move; waiting costs less than driving on.");
}

TEST(Explain, EveryStateOfEveryControllerHasItsSentences) {
  for (const auto& about : builtin_controllers().entries()) {
    const auto controller = builtin_controllers().at(about.name).make();
    for (std::uint8_t state = 0; state <= FullStripController::kPlanning; ++state) {
      Telemetry t = driving();
      t.output.state = state;
      explain(t, *controller, t.words);
      EXPECT_FALSE(t.words.what.empty()) << about.name << " " << int{state};
      EXPECT_FALSE(t.words.why.empty()) << about.name << " " << int{state};
    }
  }
}

TEST(Explain, AHoldComesBeforeEverythingElse) {
  Telemetry t = driving();
  t.hold = holds::kStaleScan;
  t.scene.scan.resize(1);
  t.scene.scan.stamp = 9.7;
  EXPECT_EQ(said("modified", t).what, "Waiting for the laser");
  EXPECT_EQ(said("modified", t).why, "Scan is 0.3 s old. The robot waits.");
}

TEST(Explain, EveryStateHasItsSentences) {
  for (const Hold hold : {Hold{},
                          holds::kStopped,
                          holds::kBumper,
                          holds::kStaleScan,
                          holds::kNotFinite,
                          holds::kDazzled}) {
    for (const Mission mission :
         {Mission::Idle, Mission::Driving, Mission::Arrived, Mission::Stuck, Mission::Held}) {
      for (const bool with_goal : {false, true}) {
        Telemetry t;
        t.hold = hold;
        t.mission = mission;
        if (with_goal) t.goal = SetGoal{};
        EXPECT_FALSE(said("modified", t).what.empty());
        EXPECT_FALSE(said("modified", t).why.empty());
      }
    }
  }
}

}  // namespace
}  // namespace algo
