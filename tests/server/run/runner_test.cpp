// tests/server/run/runner_test.cpp: the loop with a fake robot: ends of a run, refusals, and that
// the robot is stopped at every exit.
#include "server/run/runner.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "algo/gate.hpp"
#include "algo/strip/strip_law.hpp"

namespace server {
namespace {

/// Follows commands on an endless plain; can lose its link, run out of data, or be real.
class PaperRobot final : public algo::Robot, public algo::Editing, public algo::Arming {
 public:
  PaperRobot() {
    spec_.name = "paper";
    spec_.radius = 0.35;
    spec_.period = 0.05;
    spec_.max_v = 0.5;
    spec_.max_omega = 1.0;
    spec_.max_acceleration = 0.5;
    spec_.drives = true;
  }
  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& o) override { observe(o); }
  bool step(const algo::Command& command, algo::Observation& o) override {
    ++steps;
    if (steps == link_lost_at) throw algo::RobotError("The cable is out.", moments);
    if (steps == log_ends_at) return false;
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
  algo::Editing* editing() override { return real ? nullptr : this; }
  algo::Arming* arming() override { return real ? this : nullptr; }
  std::optional<std::string> arm() override { return std::nullopt; }
  void disarm(const std::string& /*why*/) override {}
  std::uint32_t epoch() const override { return 1; }
  algo::HealthReport health() const override { return {.missed_periods = 7}; }
  std::optional<std::string> edit(const algo::Request& request) override {
    if (std::holds_alternative<algo::RemoveObstacle>(request)) return "There is no obstacle 9.";
    return std::nullopt;
  }

  algo::RobotSpec spec_{};
  int steps = 0;
  int link_lost_at = -1;
  std::vector<algo::Moment> moments{};
  int log_ends_at = -1;
  bool real = false;
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

const algo::Request kNearGoal = algo::SetGoal{{1.0, 0.0}, std::nullopt};

TEST_F(RunnerTest, EndsWhenTheGoalIsReachedAndStopsTheRobot) {
  std::uint64_t frames = 0;
  links.listeners.push_back([&](const Frame& frame) { EXPECT_EQ(frame.telemetry.tick, frames++); });
  const RunResult result = go({kNearGoal}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.metrics.ticks, frames);
  EXPECT_NEAR(result.metrics.path_length, 0.9, 0.03);
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, EndsAtTheLastOfSeveralGoals) {
  const algo::AddGoal then{{{2.0, 0.0}, std::nullopt}};
  const RunResult result = go({kNearGoal, then}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_NEAR(result.metrics.path_length, 1.9, 0.03);
}

TEST_F(RunnerTest, RunsOutOfTime) {
  const RunResult result = go({kNearGoal}, {.until_outcome = true, .time_limit = 0.5});
  EXPECT_EQ(result.outcome, algo::Outcome::OutOfTime);
  EXPECT_NEAR(result.metrics.time, 0.5, 1e-9);
}

TEST_F(RunnerTest, ALostLinkFailsTheRunWithTheReason) {
  robot.link_lost_at = 5;
  const RunResult result = go({kNearGoal}, {});
  EXPECT_EQ(result.outcome, algo::Outcome::Failed);
  EXPECT_EQ(result.reason, "The cable is out.");
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, AHeldRealRobotBrakesAndASimulatedOneGetsZero) {
  for (const bool real : {true, false}) {
    robot = PaperRobot();
    robot.real = real;
    go({algo::Stop{true}}, {.until_outcome = true, .time_limit = 0.5});
    EXPECT_EQ(robot.stops, real ? robot.steps + 1 : 1);  // the last at the end
  }
}

TEST_F(RunnerTest, TheEndOfALogIsNotAFault) {
  robot.log_ends_at = 5;
  const RunResult result = go({}, {});
  EXPECT_EQ(result.outcome, algo::Outcome::EndOfLog);
  EXPECT_EQ(result.reason, "The log ended after 5 scans.");
}

TEST_F(RunnerTest, AnswersRequestsAndRecordsOnlyWhatWasAccepted) {
  links.rings = &rings;
  rings.requests.push({1, algo::Stop{true}});
  rings.requests.push({2, algo::RemoveObstacle{9}});
  rings.requests.push({3, algo::SetParameter{&algo::kRepulsionGain, 99.0}});
  std::vector<std::size_t> recorded;
  links.listeners.push_back([&](const Frame& frame) {
    recorded.push_back(frame.telemetry.requests.size());
    if (recorded.size() == 2) stop.request_stop();
  });
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

TEST_F(RunnerTest, AStopThatMetAFullRingActsAfterAnEarlierRelease) {
  links.rings = &rings;
  rings.requests.push({1, algo::Stop{false}});
  while (rings.requests.push({2, algo::Joystick{1, 0}})) {
  }
  rings.stop_now = true;
  links.listeners.push_back([&](const Frame& frame) {
    EXPECT_EQ(frame.telemetry.hold, algo::holds::kStopped);
    stop.request_stop();
  });
  go({kNearGoal}, {});
}

TEST_F(RunnerTest, AFullStreamDropsOnlyAViewersFrame) {
  links.rings = &rings;  // never drained
  const RunResult result = go({kNearGoal}, {.until_outcome = true, .time_limit = 100});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.lost_ticks, 0u);
}

TEST_F(RunnerTest, APausedWorldServesRequestsAndKeepsItsTick) {
  Pacer pacer({.paused = true});
  links.rings = &rings;
  links.pacer = &pacer;
  std::vector<algo::Telemetry> seen;
  links.listeners.push_back([&](const Frame& frame) { seen.push_back(frame.telemetry); });
  algo::Pipeline pipeline({}, robot.spec());
  server::Run one(robot, pipeline, {}, links, stop.get_token());
  one.begin({});
  EXPECT_EQ(one.advance().when, Run::Next::When::Asked);
  rings.requests.push({1, algo::RemoveObstacle{9}});
  rings.requests.push({2, kNearGoal});
  EXPECT_EQ(one.advance().when, Run::Next::When::Asked);
  EXPECT_EQ(rings.replies.read_available(), 2U);
  ASSERT_EQ(seen.size(), 1U);
  // WHEN a single step is requested THEN it reaches the goal, and no further step follows.
  pacer.set({.paused = true, .single_steps = 1});
  EXPECT_EQ(one.advance().when, Run::Next::When::Asked);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[1].requests.size(), 1U);
  EXPECT_TRUE(seen[1].goal);
  EXPECT_EQ(one.advance().when, Run::Next::When::Asked);
  EXPECT_EQ(seen.size(), 2U);
  one.finish();
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, AdvancedTooEarlyItOnlyReturnsTheNextTime) {
  Pacer pacer({.speed = 0.05});  // a period of 0.05 s lasts a second
  links.pacer = &pacer;
  links.rings = &rings;
  algo::Pipeline pipeline({}, robot.spec());
  server::Run one(robot, pipeline, {}, links, stop.get_token());
  one.begin({});
  const Run::Next first = one.advance();
  const Run::Next second = one.advance();
  EXPECT_EQ(first.when, Run::Next::When::At);
  EXPECT_EQ(first.time, second.time);
  EXPECT_EQ(robot.steps, 0);
  rings.requests.push({1, kNearGoal});  // still answered
  one.advance();
  EXPECT_EQ(rings.replies.read_available(), 1U);
  stop.request_stop();
  EXPECT_EQ(one.advance().when, Run::Next::When::Over);
}

TEST_F(RunnerTest, ARealRobotIsNeitherPacedNorEdited) {
  robot.real = true;
  Pacer pacer({.paused = true});
  links.pacer = &pacer;
  links.rings = &rings;
  rings.requests.push({1, algo::RemoveObstacle{1}});
  const RunResult result = go({}, {.until_outcome = true, .time_limit = 0.5});
  EXPECT_EQ(result.outcome, algo::Outcome::OutOfTime);
  EXPECT_EQ(result.missed_periods, 7U);
  std::optional<std::string> refusal;
  rings.replies.consume_all([&](const Reply& reply) { refusal = reply.refusal; });
  EXPECT_EQ(refusal, "This is real hardware: obstacles are put in its way by hand.");
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

TEST_F(RunnerTest, ARequiredRecordThatFailsStopsTheRobot) {
  BrokenSink sink;
  links.record = &sink;
  const RunResult result = go({kNearGoal}, {.require_record = true});
  EXPECT_EQ(result.outcome, algo::Outcome::Failed);
  EXPECT_EQ(result.reason, "The disk is full.");
  EXPECT_TRUE(robot.stopped);
}

TEST_F(RunnerTest, AFailedOptionalRecordStopsNoRobot) {
  BrokenSink sink;
  links.record = &sink;
  const RunResult result = go(
      {kNearGoal},
      {.until_outcome = true, .time_limit = 100, .record_patience = std::chrono::milliseconds(1)});
  EXPECT_EQ(result.outcome, algo::Outcome::Reached);
  EXPECT_EQ(result.lost_ticks + 9, result.metrics.ticks);
  // It waited once, not at every tick.
  EXPECT_LT(sink.pushed, 9 + 100 + static_cast<int>(result.metrics.ticks));
}

/// Records its ticks and counts its pauses.
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

TEST_F(RunnerTest, TheRecordPausesAtRestAndResumesWithTheNextGoal) {
  NotingSink sink;
  links.record = &sink;
  links.rings = &rings;
  std::optional<std::uint64_t> reached;
  std::uint64_t asked = 0;
  links.listeners.push_back([&](const Frame& frame) {
    const algo::Telemetry& t = frame.telemetry;
    rings.stream.consume_all([](const FrameRef&) {});
    if (t.mission == algo::Mission::Arrived && !reached) reached = t.tick;
    if (reached && asked == 0 && t.tick == *reached + 400) {
      rings.requests.push({1, algo::SetGoal{{0.0, 0.0}, std::nullopt}});
      asked = t.tick;
    }
    if (asked != 0 && t.tick == asked + 20) stop.request_stop();
  });
  go({kNearGoal}, {.pause_record_after = 5});
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

TEST(FramePool, GrowsWithThoseWhoHoldFramesAndShrinksWhenTheyLetGo) {
  const auto room = std::make_shared<FrameRoom>(3);
  const auto pool = FramePool::growing<Frame>(2, 64, room);
  const auto other = FramePool::growing<Frame>(2, 64, room);
  EXPECT_EQ(pool->size(), 0U);
  { const FrameRef one = pool->take(); }
  { const FrameRef one = pool->take(); }
  EXPECT_EQ(pool->size(), 1U);
  std::vector<FrameRef> held;
  while (FrameRef frame = pool->take()) held.push_back(std::move(frame));
  EXPECT_EQ(held.size(), 5U);  // two of its own and all the shared room
  std::vector<FrameRef> others;
  while (FrameRef frame = other->take()) others.push_back(std::move(frame));
  EXPECT_EQ(others.size(), 2U);
  // WHEN no reader holds more than one frame for a while THEN the others are freed.
  held.clear();
  for (int i = 0; i < 600; ++i) EXPECT_TRUE(pool->take());
  EXPECT_EQ(pool->size(), 1U);
  while (FrameRef frame = other->take()) others.push_back(std::move(frame));
  EXPECT_EQ(others.size(), 5U);
}

TEST(FramePool, FramesOutliveTheirRun) {
  const auto room = std::make_shared<FrameRoom>(8);
  auto pool = FramePool::growing<Frame>(1, 8, room);
  FrameRef kept = pool->take();
  FrameRef more = pool->take();
  ASSERT_TRUE(kept && more);
  kept->telemetry.tick = 7;
  pool.reset();
  more.reset();
  EXPECT_EQ(kept->telemetry.tick, 7U);
  kept.reset();
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(room->take()) << i;  // all room is free again
  EXPECT_FALSE(room->take());
}

}  // namespace
}  // namespace server
