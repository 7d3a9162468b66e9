// tests/algo/metrics_test.cpp: the figures of a run on hand-computed paths.
#include "algo/metrics.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace algo {
namespace {

struct MetricsTest : ::testing::Test {
  MetricsTest() {
    spec.radius = 0.35;
    spec.period = 0.1;
    recorder.reset(spec);
  }
  void at(double x, double y, double distance) {
    Telemetry t;
    t.observation.stamp = 5.0 + 0.1 * tick++;  // a run need not start at zero
    t.ground_truth = GroundTruth{{x, y, 0}, distance, distance - spec.radius, false};
    t.clearance = distance - spec.radius;
    t.scene.left = Nearest{.beam = 200, .point_W = {x, y + distance}, .distance = distance};
    t.output.pass_W = Vec2{x + 0.2, y};
    t.output.measures.push_back({"strip.length", "m", 0.2});
    recorder.add(t, parameters);
  }
  RobotSpec spec{};
  Parameters parameters{};  // safety distance 1 m, so influence 1.35 m
  MetricsRecorder recorder{};
  int tick = 0;
};

TEST_F(MetricsTest, StraightLineAtADistance) {
  for (int i = 0; i <= 10; ++i) at(0.1 * i, 0, 2.0);
  const Metrics& m = recorder.metrics();
  EXPECT_EQ(m.ticks, 11u);
  EXPECT_NEAR(m.time, 1.0, 1e-12);
  EXPECT_NEAR(m.path_length, 1.0, 1e-12);
  EXPECT_NEAR(m.min_clearance, 1.65, 1e-12);
  EXPECT_EQ(m.intrusion, 0);
  EXPECT_EQ(m.turning, 0);
  EXPECT_EQ(m.via_points, 0u);  // never within 1.35 m
}

TEST_F(MetricsTest, IntrusionIsMeasuredFromTheCentre) {
  at(0, 0, 1.2);
  at(0.1, 0, 0.8);
  at(0.2, 0, 0.7);
  at(0.3, 0, 1.1);
  const Metrics& m = recorder.metrics();
  EXPECT_NEAR(m.intrusion, 0.3, 1e-12);       // 1.0 - 0.7
  EXPECT_NEAR(m.infringed_time, 0.2, 1e-12);  // two ticks
  EXPECT_NEAR(m.min_clearance, 0.35, 1e-12);  // 0.7 - 0.35
}

TEST_F(MetricsTest, TurningSumsTheChangesOfTheResampledPath) {
  // East, then north, then west: two quarter turns, in steps of 0.1 m > 50 mm.
  at(0, 0, 2), at(0.1, 0, 2), at(0.2, 0, 2), at(0.2, 0.1, 2), at(0.2, 0.2, 2), at(0.1, 0.2, 2);
  EXPECT_NEAR(recorder.metrics().turning, std::numbers::pi, 1e-12);
}

TEST_F(MetricsTest, JitterBelowFiftyMillimetresIsNotTurning) {
  for (int i = 0; i < 50; ++i) at(i % 2 == 0 ? 0.0 : 0.01, i % 3 == 0 ? 0.0 : 0.01, 2);
  EXPECT_EQ(recorder.metrics().turning, 0);
}

TEST_F(MetricsTest, ViaPointsAreHalfAMetreApartPerAxis) {
  for (int i = 0; i <= 20; ++i) at(0.1 * i, 0, 1.2);  // pass point moves from 0.2 to 2.2
  // Counted at 0.2, 0.7, 1.2, 1.7, 2.2 (give or take a rounding at the border).
  EXPECT_NEAR(recorder.metrics().via_points, 5, 1);
  EXPECT_GE(recorder.metrics().via_points, 4u);
}

TEST_F(MetricsTest, WithoutTruthUsesOdometryAndScan) {
  Telemetry t;
  t.clearance = 0.5;
  recorder.add(t, parameters);
  t.observation.odometry.pose.x = 1;
  recorder.add(t, parameters);
  EXPECT_NEAR(recorder.metrics().path_length, 1, 1e-12);
  EXPECT_NEAR(recorder.metrics().min_clearance, 0.5, 1e-12);
}

}  // namespace
}  // namespace algo
