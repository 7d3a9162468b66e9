// tests/server/record/determinism_test.cpp: the same spec gives the same run; a replayed record
// gives the same commands.
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "algo/strip/strip_law.hpp"
#include "db/sqlite.hpp"
#include "server/record/headless.hpp"
#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

RunSpec case1(const std::string& physics, std::uint64_t seed = 1) {
  RunOverrides overrides;
  overrides.physics = physics_named(physics, "physics");
  overrides.seed = seed;
  return make_spec(ScenarioLibrary({}, {}).load("case1"), overrides);
}

std::uint64_t hash_of(const RunSpec& spec) {
  const auto robot = make_robot(spec);
  HeadlessOptions options;
  options.hash_frames = true;
  const HeadlessResult result = run_headless(spec, *robot, options, {});
  EXPECT_EQ(result.run.outcome, algo::Outcome::Reached) << result.run.reason;
  return result.telemetry_hash;
}

TEST(Determinism, SeveralRobotsGiveTheSameBytesAgain) {
  const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("swap"), {});
  HeadlessOptions options;
  options.hash_frames = true;
  const auto once = run_headless(spec, *make_robot(spec), options, {});
  const auto again = run_headless(spec, *make_robot(spec), options, {});
  EXPECT_EQ(once.telemetry_hash, again.telemetry_hash);
  EXPECT_EQ(once.run.outcome, algo::Outcome::Reached) << once.run.reason;
}

TEST(Determinism, TheSameSpecGivesTheSameBytesAndAnotherSeedOthers) {
  for (const char* vehicle : {"bullet", "kinematic"}) {
    SCOPED_TRACE(vehicle);
    const std::uint64_t first = hash_of(case1(vehicle));
    EXPECT_EQ(first, hash_of(case1(vehicle)));
    EXPECT_NE(first, hash_of(case1(vehicle, 2)));
  }
}

/// Keeps frames like a run's record, with one of them changed.
class TamperingSink final : public FrameSink {
 public:
  TamperingSink(std::shared_ptr<RunChannel> channel, std::uint64_t tick)
      : sink_(std::move(channel)), tick_(tick) {}
  bool push(const FrameRef& frame) override {
    if (frame->telemetry.tick == tick_ && !done_) {
      frame->telemetry.command.base.omega += 1e-12;
      done_ = true;
    }
    return sink_.push(frame);
  }

 private:
  RecordSink sink_;
  std::uint64_t tick_;
  bool done_ = false;
};

class RecordedRun : public ::testing::Test {
 protected:
  RecordedRun()
      : folder_(std::filesystem::temp_directory_path() /
                ("tautline_determinism_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    database_ = (folder_ / "runs.db").string();
  }
  ~RecordedRun() override { std::filesystem::remove_all(folder_); }

  /// Records case1 while `script` says which requests come after which tick.
  db::RunId record(const RunSpec& spec,
                   const std::multimap<std::uint64_t, algo::Request>& script,
                   std::optional<std::uint64_t> tampered = std::nullopt) {
    Recorder recorder(database_, recorder_options());
    const auto robot = make_robot(spec);
    const auto channel = recorder.open(new_run(spec, robot->spec()));
    RecordSink honest(channel);
    TamperingSink tampering(channel, tampered.value_or(0));
    const auto pool = FramePool::make<EncodedFrame>(kPoolFrames);
    Rings rings;
    algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
    RunLinks links;
    links.pool = pool.get();
    links.rings = &rings;
    links.record = tampered ? static_cast<FrameSink*>(&tampering) : &honest;
    links.listeners.push_back([&](const Frame& frame) {
      applied_ += frame.telemetry.requests.size();
      const auto [begin, end] = script.equal_range(frame.telemetry.tick);
      for (auto it = begin; it != end; ++it) rings.requests.push({1, it->second});
    });
    result_ = run(*robot,
                  pipeline,
                  first_requests(spec),
                  {.until_outcome = true, .time_limit = 40},
                  links,
                  {});
    rings.stream.consume_all([](const FrameRef&) {});
    rings.replies.consume_all(
        [](const Reply& reply) { EXPECT_FALSE(reply.refusal) << *reply.refusal; });
    channel->close(run_end(result_));
    recorder.flush();
    return channel->run();
  }
  void change(const std::string& sql) const {
    db::detail::Connection(database_, db::detail::Connection::Mode::Write).execute(sql);
  }
  /// First and last tick of the second block. A block also ends where the recorder's clock asks for
  /// a commit.
  std::pair<std::uint64_t, std::uint64_t> second_block() const {
    db::detail::Connection connection(database_, db::detail::Connection::Mode::Read);
    db::detail::Statement block = connection.prepare(
        "SELECT first_tick, last_tick FROM block ORDER BY first_tick LIMIT 1 OFFSET 1");
    EXPECT_TRUE(block.step()) << "the run has one block";
    return {block.count(0), block.count(1)};
  }
  Verification verify(db::RunId run) const {
    db::RunReader reader(database_);
    return verify_run(reader, run);
  }

  std::filesystem::path folder_{};
  std::string database_{};
  RunResult result_{};
  std::size_t applied_ = 0;
};

TEST_F(RecordedRun, FedBackItGivesTheSameCommands) {
  for (const char* vehicle : {"bullet", "kinematic"}) {
    SCOPED_TRACE(vehicle);
    const Verification verification = verify(record(case1(vehicle), {}));
    EXPECT_EQ(verification.ticks, result_.metrics.ticks);
    EXPECT_EQ(verification.difference, std::nullopt);
  }
}

class RecordedSwap : public RecordedRun, public ::testing::WithParamInterface<const char*> {};

TEST_P(RecordedSwap, OfTheFirstRobotFedBackGivesTheSameCommands) {
  const algo::Obstacle obstacle{.id = 9, .pose_W = {1.0, 1.0, 0}, .shape = algo::Cylinder{0.2}};
  RunOverrides overrides;
  overrides.physics = physics_named(GetParam(), "physics");
  const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("swap"), overrides);
  const db::RunId first = record(spec, {{50, algo::AddObstacle{obstacle}}});
  const Verification verification = verify(first);
  EXPECT_EQ(verification.ticks, result_.metrics.ticks);
  EXPECT_EQ(verification.difference, std::nullopt);
  EXPECT_EQ(verification.incomplete, std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Physics, RecordedSwap, ::testing::Values("bullet", "kinematic"));

TEST_F(RecordedRun, FedBackWithEditsStickAndStopItGivesTheSameCommands) {
  const algo::Obstacle obstacle{.id = 9, .pose_W = {1.0, -1.0, 0}, .shape = algo::Cylinder{0.2}};
  const std::multimap<std::uint64_t, algo::Request> script{
      {50, algo::AddObstacle{obstacle}},
      {100, algo::SetParameter{&algo::kRepulsionGain, 0.5}},
      {100, algo::SetParameter{&algo::kMaxSpeed, 0.3}},
      {150, algo::MoveObstacle{9, {1.5, -1.0, 0.3}}},
      {200, algo::Stop{true}},
      {240, algo::Stop{false}},
      {300, algo::Joystick{0.5, -0.4}},
      {310, algo::Joystick{0.2, 0.4, algo::StickMode::Wall}},
      {318, algo::Joystick{1, 0, algo::StickMode::Wall}},
      {320, algo::Joystick{}},
      {330, algo::RemoveObstacle{9}},
      {360, algo::SetGoal{{3.5, 5.0}, 0.9}},
      {420, algo::ClearGoal{}},
      {430, algo::SetGoal{{3.0, 5.0}, std::nullopt}},
      {431, algo::AddGoal{{{0.0, 4.0}, std::nullopt}}},
  };
  for (const char* vehicle : {"bullet", "kinematic"}) {
    SCOPED_TRACE(vehicle);
    applied_ = 0;
    const Verification verification = verify(record(case1(vehicle), script));
    EXPECT_EQ(applied_, script.size() + 1);  // and the scenario's goal
    EXPECT_GT(verification.ticks, 431u);
    EXPECT_EQ(verification.ticks, result_.metrics.ticks);
    EXPECT_EQ(verification.difference, std::nullopt);
  }
}

TEST_F(RecordedRun, ATamperedFrameIsFound) {
  const Verification verification = verify(record(case1("kinematic"), {}, 100));
  ASSERT_TRUE(verification.difference);
  EXPECT_EQ(verification.difference->substr(0, 10), "Tick 100: ") << *verification.difference;
}

TEST_F(RecordedRun, AGapOrACutIsIncompleteAndSaysSo) {
  const db::RunId run = record(case1("kinematic"), {});
  EXPECT_EQ(verify(run).incomplete, std::nullopt);
  const auto [first, last] = second_block();
  change("DELETE FROM block WHERE first_tick = " + std::to_string(first));
  const Verification gap = verify(run);
  EXPECT_EQ(gap.difference, std::nullopt);
  const std::string missing =
      "Ticks " + std::to_string(first) + " to " + std::to_string(last) + " are missing";
  EXPECT_THAT(gap.incomplete, ::testing::Optional(::testing::HasSubstr(missing)));
  EXPECT_EQ(gap.compared, first);

  const db::RunId cut = record(case1("kinematic"), {});
  change("UPDATE run SET status = 'interrupted', reason = 'It was cut.' WHERE id = " +
         std::to_string(cut));
  EXPECT_EQ(verify(cut).incomplete, "It was cut.");
}

TEST_F(RecordedRun, EveryAcceptedRunIsVerified) {
  RunSpec spec = case1("kinematic");
  spec.scenario.period = 0.5;
  spec.scenario.drive.delay_ticks = 100;      // 50 s
  for (std::uint32_t i = 0; i < 1900; ++i) {  // a document of more than a megabyte
    algo::Polygon far;
    for (int k = 0; k < 16; ++k) {
      far.points.emplace_back(std::cos(k * 0.39) * 0.123456789, std::sin(k * 0.39) * 0.123456789);
    }
    spec.scenario.obstacles.push_back(
        {.id = 100 + i, .pose_W = {1000.0 + i, 1000, 0}, .shape = far});
  }
  ASSERT_GT(run_document(spec, make_robot(spec)->spec()).dump().size(), 1u << 20);
  const Verification verification = verify(record(spec, {}));
  EXPECT_EQ(verification.difference, std::nullopt);
  EXPECT_EQ(verification.incomplete, std::nullopt);
}

TEST_F(RecordedRun, AnUnknownRunIsReportedMissing) {
  const db::RunId run = record(case1("kinematic"), {});
  EXPECT_THROW(verify(run + 1), std::runtime_error);
}

}  // namespace
}  // namespace server
