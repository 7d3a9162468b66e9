// tests/server/run/runner_test.cpp: the loop with a robot of paper: what ends a run, what is
// refused, and that the robot is stopped on every way out.
#include "server/run/runner.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "algo/strip/strip_law.hpp"

namespace server {
namespace {

/// Drives where it is told on an endless plain; can lose its link, pause, or run out of data.
class PaperRobot final : public algo::Robot {
 public:
  PaperRobot() {
    spec_.name = "paper";
    spec_.radius = 0.35;
    spec_.period = 0.05;
    spec_.max_v = 0.5;
    spec_.max_omega = 1.0;
    spec_.max_acceleration = 0.5;
    spec_.paceable = true;
    spec_.drives = true;
    spec_.editable = true;
  }
  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& o) override { observe(o); }
  bool step(const algo::Command& command, algo::Observation& o) override {
    if (paused_steps > 0) {
      --paused_steps;
      return false;
    }
    ++steps;
    if (steps == link_lost_at) throw algo::RobotError("The cable is out.");
    if (steps == log_ends_at) throw algo::EndOfLog("The log has ended.");
    pose_.heading = algo::wrap_angle(pose_.heading + command.base.omega * spec_.period);
    pose_.x += command.base.v * spec_.period * std::cos(pose_.heading);
    pose_.y += command.base.v * spec_.period * std::sin(pose_.heading);
    stamp_ += spec_.period;
    observe(o);
    return true;
  }
  void stop() noexcept override {
    stopped = true;
    ++stops;
  }
  std::optional<std::string> edit(const algo::Request& request) override {
    if (std::holds_alternative<algo::RemoveObstacle>(request)) return "There is no obstacle 9.";
    return std::nullopt;
  }

  algo::RobotSpec spec_{};
  int steps = 0;
  int link_lost_at = -1;
  int log_ends_at = -1;
  int paused_steps = 0;
  bool stopped = false;
  int stops = 0;

 private:
  void observe(algo::Observation& o) {
    o.clear_sensors();
    o.stamp = stamp_;
    o.odometry = {stamp_, pose_, {}};
    algo::LaserScan& scan = o.scans.append();
    scan.stamp = stamp_;
    scan.angle_min = -1.5707963267948966;
    scan.angle_increment = 0.008726646259971648;
    scan.range_max = 8.191;
    scan.resize(361);
    for (std::size_t i = 0; i < 361; ++i) scan.set_free(i);
  }
  algo::Pose2 pose_{};
  double stamp_ = 0;
};

struct RunnerTest : ::testing::Test {
  RunnerTest() { links.pool = pool.get(); }
  RunResult go(const std::vector<algo::Request>& first, const RunPolicy& policy) {
    algo::Pipeline pipeline({}, robot.spec());
    return run(robot, pipeline, first, policy, links, stop.get_token());
  }
  PaperRobot robot{};
  std::shared_ptr<FramePool> pool = FramePool::make(256);
  Rings rings{};
  RunLinks links{};
  std::stop_source stop{};
};

const algo::Request kGoal = algo::SetGoal{{1.0, 0.0}, std::nullopt};

TEST_F(RunnerTest, EndsWhenTheGoalIsReachedAndStopsTheRobot) {
  std::uint64_t frames = 0;
  links.observer = [&](const Frame& frame) { EXPECT_EQ(frame.telemetry.tick, frames++); };
  const RunResult result = go({kGoal}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.metrics.ticks, frames);
  EXPECT_NEAR(result.metrics.path_length, 0.9, 0.03);
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, IsOverAtTheLastOfSeveralGoals) {
  const algo::AddGoal then{{{2.0, 0.0}, std::nullopt}};
  const RunResult result = go({kGoal, then}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_NEAR(result.metrics.path_length, 1.9, 0.03);
}

TEST_F(RunnerTest, RunsOutOfTime) {
  const RunResult result = go({kGoal}, {.until_outcome = true, .time_limit = 0.5});
  EXPECT_EQ(result.outcome, algo::Outcome::OutOfTime);
  EXPECT_NEAR(result.metrics.time, 0.5, 1e-9);
}

TEST_F(RunnerTest, ALostLinkFailsTheRunWithTheReason) {
  robot.link_lost_at = 5;
  const RunResult result = go({kGoal}, {});
  EXPECT_EQ(result.outcome, algo::Outcome::Failed);
  EXPECT_EQ(result.reason, "The cable is out.");
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, RealRobotThatIsHeldBrakesAndASimulatedOneTakesItsZero) {
  for (const bool real : {true, false}) {
    robot = PaperRobot();
    robot.spec_.paceable = !real;
    go({algo::Stop{true}}, {.until_outcome = true, .time_limit = 0.5});
    EXPECT_EQ(robot.stops, real ? robot.steps + 1 : 1);  // the last at the end
  }
}

TEST_F(RunnerTest, TheEndOfALogIsNotAFault) {
  robot.log_ends_at = 5;
  EXPECT_EQ(go({}, {}).outcome, algo::Outcome::EndOfLog);
}

TEST_F(RunnerTest, AnswersRequestsAndRecordsOnlyWhatWasAccepted) {
  links.rings = &rings;
  robot.paused_steps = 3;
  rings.requests.push({1, algo::Stop{true}});
  rings.requests.push({2, algo::RemoveObstacle{9}});
  rings.requests.push({3, algo::SetParameter{&algo::kRepulsionGain, 99.0}});
  std::vector<std::size_t> recorded;
  links.observer = [&](const Frame& frame) {
    recorded.push_back(frame.telemetry.requests.size());
    if (recorded.size() == 2) stop.request_stop();
  };
  go({}, {});
  ASSERT_GE(recorded.size(), 1u);
  EXPECT_EQ(recorded[0], 1u);

  std::vector<Reply> replies;
  rings.replies.consume_all([&](const Reply& reply) { replies.push_back(reply); });
  ASSERT_EQ(replies.size(), 3u);
  EXPECT_FALSE(replies[0].refusal);
  EXPECT_EQ(replies[1].refusal, "There is no obstacle 9.");
  EXPECT_TRUE(replies[2].refusal);
}

TEST_F(RunnerTest, AStopThatFoundTheRingFullComesAfterAReleaseInIt) {
  links.rings = &rings;
  rings.requests.push({1, algo::Stop{false}});
  while (rings.requests.push({2, algo::Joystick{1, 0}})) {
  }
  rings.stop_now = true;
  links.observer = [&](const Frame& frame) {
    EXPECT_EQ(frame.telemetry.hold, algo::Hold::Stopped);
    stop.request_stop();
  };
  go({kGoal}, {});
}

TEST_F(RunnerTest, AFullStreamCostsOnlyTheViewersAFrame) {
  links.rings = &rings;  // nobody drains it
  const RunResult result = go({kGoal}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.lost_ticks, 0u);
}

class BrokenSink final : public FrameSink {
 public:
  bool push(const FrameRef& /*frame*/) override { return ++pushed < 10; }
  std::optional<std::string> failure() const override {
    if (pushed < 10) return std::nullopt;
    return "The disk is full.";
  }
  int pushed = 0;
};

TEST_F(RunnerTest, ARecordThatIsRequiredStopsTheRobotWhenItBreaks) {
  BrokenSink sink;
  links.record = &sink;
  const RunResult result = go({kGoal}, {.require_record = true});
  EXPECT_EQ(result.outcome, algo::Outcome::Failed);
  EXPECT_EQ(result.reason, "The disk is full.");
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, ARecordThatTakesNothingStopsNoRobot) {
  BrokenSink sink;
  links.record = &sink;
  const RunResult result = go(
      {kGoal},
      {.until_outcome = true, .time_limit = 100, .record_patience = std::chrono::milliseconds(1)});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.lost_ticks + 9, result.metrics.ticks);
  // It waited once, not at every tick.
  EXPECT_LT(sink.pushed, 9 + 100 + static_cast<int>(result.metrics.ticks));
}

/// Notes which ticks it was given and how often it was told to pause.
class NotingSink final : public FrameSink {
 public:
  bool push(const FrameRef& frame) override {
    ticks.push_back(frame->telemetry.tick);
    return true;
  }
  void pause() override { ++pauses; }
  std::vector<std::uint64_t> ticks{};
  int pauses = 0;
};

TEST_F(RunnerTest, TheRecordPausesWhenNothingHappensAndGoesOnWithTheNextGoal) {
  NotingSink sink;
  links.record = &sink;
  links.rings = &rings;
  std::optional<std::uint64_t> reached;
  std::uint64_t asked = 0;
  links.observer = [&](const Frame& frame) {
    const algo::Telemetry& t = frame.telemetry;
    rings.stream.consume_all([](const FrameRef&) {});
    if (t.mission == algo::Mission::Arrived && !reached) reached = t.tick;
    if (reached && asked == 0 && t.tick == *reached + 400) {
      rings.requests.push({1, algo::SetGoal{{0.0, 0.0}, std::nullopt}});
      asked = t.tick;
    }
    if (asked != 0 && t.tick == asked + 20) stop.request_stop();
  };
  go({kGoal}, {.pause_record_after = 5});
  ASSERT_TRUE(reached);
  const double period = robot.spec().period;
  EXPECT_GT(sink.pauses, 400 - static_cast<int>(7 / period));
  EXPECT_LT(sink.pauses, 400 - static_cast<int>(4 / period));
  // The request's own tick is kept, and every one after it.
  ASSERT_GT(sink.ticks.size(), 20u);
  EXPECT_EQ(sink.ticks[sink.ticks.size() - 20], asked + 1);
  EXPECT_EQ(sink.ticks.size() + static_cast<std::size_t>(sink.pauses), asked + 21);
}

TEST(FramePool, HandsOutEachFrameOnceAndTakesItBack) {
  const auto pool = FramePool::make(2);
  FrameRef a = pool->take();
  FrameRef b = pool->take();
  ASSERT_TRUE(a && b);
  EXPECT_NE(a.get(), b.get());
  EXPECT_FALSE(pool->take());
  b.reset();
  EXPECT_TRUE(pool->take());
}

}  // namespace
}  // namespace server
