// tests/algo/explain_test.cpp: the sentences carry the numbers of the tick.
#include "algo/explain.hpp"

#include <gtest/gtest.h>

namespace algo {
namespace {

Telemetry driving() {
  Telemetry t;
  t.observation.stamp = 10.0;
  t.goal = SetGoal{.position_W = {3, 4}};
  t.mission = Mission::Driving;
  t.behaviour = BehaviourId::Avoid;
  t.scene.left = Nearest{.beam = 200, .point_W = {1, 0}, .distance = 1.0};
  t.output.external_left_W = {-0.21, 0};
  return t;
}

TEST(Explain, PassingAnObstacle) {
  Telemetry t = driving();
  t.output.side = Side::Right;
  t.output.side_since = 6.6;
  const Explanation e = explain(t);
  EXPECT_EQ(e.what, "Passing the obstacle on its right");
  EXPECT_EQ(e.why,
            "External force 0.21 m from the nearest left return at 1.00 m; side chosen 3.4 s ago.");
}

TEST(Explain, FreeDrivingSaysHowFarToGo) {
  Telemetry t = driving();
  t.output.external_left_W = {0, 0};
  EXPECT_EQ(explain(t).what, "Driving to the goal");
  EXPECT_EQ(explain(t).why, "5.00 m to go. The nearest return is 1.00 m from the robot's centre.");
}

TEST(Explain, AControllerWithoutAStripSaysWhatItIsAbout) {
  Telemetry t = driving();
  t.output.manner = Manner::Planned;
  for (const double x : {0.0, 1.0, 2.5}) t.output.plan_W.push_back({x, 0});
  EXPECT_EQ(explain(t).what, "Following its plan");
  EXPECT_EQ(explain(t).why, "The path over the grid is 2.50 m long.");

  t.output.manner = Manner::Valley;
  t.output.histogram = {10, 200, 400, 299};
  t.output.histogram_threshold = 300;
  t.output.pass_W = {4, -3};  // at right angles to the goal
  EXPECT_EQ(explain(t).why, "3 of 4 sectors are free; the way is 90 degrees off the goal.");

  t.output.manner = Manner::Window;
  t.output.twist = {0.25, -0.5};
  t.output.candidates.push_back({.twist = {0.25, -0.5}, .allowed = true, .chosen = true});
  t.output.candidates.push_back({.twist = {0.5, 0}});
  EXPECT_EQ(explain(t).why,
            "1 of 2 motions can be stopped in time; the best is 0.25 m/s, -0.50 rad/s.");
  t.mission = Mission::Stuck;
  t.output.manner = Manner::Walled;
  EXPECT_EQ(explain(t).why,
            "No sector of the histogram is free. 5.00 m to go. Move an obstacle or the goal.");
}

TEST(Explain, EveryMannerHasItsSentences) {
  for (int manner = 0; manner <= static_cast<int>(Manner::NoWindow); ++manner) {
    Telemetry t = driving();
    t.output.external_left_W = {0, 0};
    t.output.manner = static_cast<Manner>(manner);
    EXPECT_FALSE(explain(t).what.empty()) << manner;
    EXPECT_FALSE(explain(t).why.empty()) << manner;
  }
}

TEST(Explain, AHoldComesBeforeEverythingElse) {
  Telemetry t = driving();
  t.hold = Hold::StaleScan;
  t.scene.scan.resize(1);
  t.scene.scan.stamp = 9.7;
  EXPECT_EQ(explain(t).what, "Waiting for the laser");
  EXPECT_EQ(explain(t).why, "Scan is 0.3 s old. The robot waits.");
}

TEST(Explain, EveryStateHasItsSentences) {
  for (const Hold hold : {Hold::None,
                          Hold::Stopped,
                          Hold::Bumper,
                          Hold::StaleScan,
                          Hold::NotFinite,
                          Hold::LinkLost,
                          Hold::Dazzled}) {
    for (const Mission mission :
         {Mission::Idle, Mission::Driving, Mission::Arrived, Mission::Stuck, Mission::Held}) {
      for (const bool with_goal : {false, true}) {
        Telemetry t;
        t.hold = hold;
        t.mission = mission;
        if (with_goal) t.goal = SetGoal{};
        EXPECT_FALSE(explain(t).what.empty());
        EXPECT_FALSE(explain(t).why.empty());
      }
    }
  }
}

}  // namespace
}  // namespace algo
