// tests/algo/baselines/behaviour_test.cpp: the published behaviour of the baseline controllers:
// where each reaches the goal, and where it does not.
#include <numbers>
#include <ostream>
#include <set>

#include "tests/algo/baselines/drive.hpp"
#include <gtest/gtest.h>

#include "algo/baselines/edge_detection.hpp"

namespace {

using baselines::Drive;
using baselines::Outcome;
using baselines::Vec2;

const Vec2 kGoal{6, 0};

/// A post beside the line to the goal that the hull would hit.
worlds::World post(double off_line) {
  return {{{{3, off_line}, 0.3}}, {}};
}

std::vector<Vec2> box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// Open towards the robot, 3 m wide and 1.5 m deep, between it and the goal.
worlds::World dead_end() {
  return {{}, {box(3, -1.5, 3.2, 1.5), box(1.5, 1.5, 3.2, 1.7), box(1.5, -1.7, 3.2, -1.5)}};
}

class EveryBaseline : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryBaseline, ReachesAGoalInTheOpen) {
  const Outcome outcome = Drive(GetParam(), {}, {4, 1}).run();
  EXPECT_EQ(outcome.name, "reached");
  EXPECT_LT(outcome.path, 4.5);
}

INSTANTIATE_TEST_SUITE_P(
    Baselines,
    EveryBaseline,
    ::testing::Values(
        "go_to_goal", "edge_detection", "potential_field", "certainty_grid", "vff", "vfh", "dwa"),
    [](const auto& about) { return about.param; });

class EveryAvoider : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryAvoider, PassesAPostBesideItsLine) {
  const Outcome outcome = Drive(GetParam(), post(0.5), kGoal).run();
  EXPECT_EQ(outcome.name, "reached");
  EXPECT_GT(outcome.clearance, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Baselines,
    EveryAvoider,
    ::testing::Values("edge_detection", "potential_field", "certainty_grid", "vff", "vfh", "dwa"),
    [](const auto& about) { return about.param; });

TEST(Baselines, GoToGoalHitsAnObstacleInItsWay) {
  EXPECT_EQ(Drive("go_to_goal", post(0), kGoal).run().name, "collided");
}

/// Forces cancel head-on: Koren and Borenstein's own objection to force fields. The VFF passes this
/// post, since its cells are never quite symmetric.
TEST(Baselines, ThePotentialFieldComesToRestBeforeAPostOnItsLine) {
  const Outcome outcome = Drive("potential_field", post(0), kGoal).run();
  EXPECT_EQ(outcome.name, "out_of_time");
  EXPECT_NEAR(outcome.end.x(), 3 - 0.3 - 0.64, 0.01);  // where the forces balance
  EXPECT_LT(outcome.late_path, 0.01);
}

/// A local minimum: these controllers know only nearby obstacles.
TEST(Baselines, LocalMethodsAreTrappedInADeadEnd) {
  for (const char* name : {"potential_field", "vff", "vfh", "dwa"}) {
    const Outcome outcome = Drive(name, dead_end(), kGoal).run(60);
    EXPECT_EQ(outcome.name, "out_of_time") << name;
    EXPECT_LT(outcome.end.x(), 3) << name;
    EXPECT_GT(outcome.clearance, 0) << name;
  }
}

TEST(Baselines, TheCertaintyGridFindsThePathOutOfADeadEnd) {
  bool replanned_back = false;
  const Outcome outcome = Drive("certainty_grid", dead_end(), kGoal)
                              .watch([&](const algo::ControlOutput& out) {
                                for (const algo::Layer& layer : out.layers) {
                                  if (layer.name != "plan") continue;
                                  for (std::size_t k = 1; k < layer.values.size(); k += 2) {
                                    const float y = layer.values[k];
                                    replanned_back = replanned_back || std::abs(y) > 1.7F;
                                  }
                                }
                              })
                              .run();
  EXPECT_EQ(outcome.name, "reached");
  EXPECT_TRUE(replanned_back);
}

TEST(Baselines, WithoutAPathTheCertaintyGridStopsWithAReason) {
  const worlds::World cell{{},
                           {box(-1.2, -1.2, 1.2, -1.1),
                            box(-1.2, 1.1, 1.2, 1.2),
                            box(1.1, -1.2, 1.2, 1.2),
                            box(-1.2, -1.2, -1.1, 1.2)}};
  bool waits = false;
  const Outcome outcome = Drive("certainty_grid", cell, kGoal)
                              .watch([&](const algo::ControlOutput& out) { waits = out.waits; })
                              .run(40);
  EXPECT_EQ(outcome.name, "out_of_time");
  EXPECT_TRUE(waits);
  EXPECT_GT(outcome.clearance, 0);
}

/// It stands still for half a second at each scan, and only then.
TEST(Baselines, EdgeDetectionStopsForItsScans) {
  int standing = 0;
  int longest = 0;
  int scans = 0;
  const Outcome outcome = Drive("edge_detection", post(0), kGoal)
                              .watch([&](const algo::ControlOutput& out) {
                                const bool stands = out.state == algo::EdgeDetection::kTakingScan;
                                if (stands && standing == 0) ++scans;
                                standing = stands ? standing + 1 : 0;
                                longest = std::max(longest, standing);
                                EXPECT_EQ(stands, out.twist == algo::Twist2{});
                              })
                              .run();
  EXPECT_EQ(outcome.name, "reached");
  EXPECT_GE(scans, 1);
  EXPECT_EQ(longest, 10);  // of 50 ms
}

TEST(Baselines, TheDynamicWindowChoosesReachableSpeedsItCanStopFrom) {
  algo::Twist2 before;
  const Outcome outcome =
      Drive("dwa", post(0), kGoal)
          .watch([&](const algo::ControlOutput& out) {
            ASSERT_EQ(out.layers.size(), 3U);  // refused, allowed, chosen
            const auto& allowed = out.layers[1].values;
            const auto& chosen = out.layers[2].values;
            ASSERT_EQ(chosen.size(), 2U);
            EXPECT_NEAR(chosen[0], 1.5 * out.twist.v, 1e-6);
            EXPECT_NEAR(chosen[1], 1.5 * out.twist.omega, 1e-6);
            bool is_allowed = false;
            for (std::size_t k = 0; k < allowed.size(); k += 2) {
              is_allowed = is_allowed || (allowed[k] == chosen[0] && allowed[k + 1] == chosen[1]);
            }
            EXPECT_TRUE(is_allowed);
            EXPECT_EQ(out.measure("window.allowed"), static_cast<double>(allowed.size() / 2));
          })
          .run();
  EXPECT_EQ(outcome.name, "reached");
  EXPECT_GE(outcome.clearance, 0.04);  // its margin of 5 cm, less the motion of one tick
}

/// A rectangle passes lengthwise where its circumscribed circle does not.
TEST(Baselines, TheDynamicWindowHandlesRectangles) {
  const worlds::World gap{{}, {box(2, 0.32, 4, 9), box(2, -9, 4, -0.32)}};
  Drive disc("dwa", gap, kGoal);
  disc.spec().radius = 0.3327;
  EXPECT_NE(disc.run(60).name, "reached");
  Drive rectangle("dwa", gap, kGoal);
  rectangle.spec().radius = 0.3327;
  rectangle.spec().half_length = 0.254;
  rectangle.spec().half_width = 0.215;
  EXPECT_EQ(rectangle.run(60).name, "reached");
}

}  // namespace
