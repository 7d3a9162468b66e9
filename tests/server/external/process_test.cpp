// tests/server/external/process_test.cpp: a controller in a process of its own drives, and each way
// in which it may fail ends its run with a sentence.
#include <chrono>
#include <thread>

#include "tests/server/external/own.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"

namespace server::external {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

RunSpec faulty(const std::string& fault, double answer_limit = 10) {
  return spec_of(catalogue_of({.name = "mine",
                               .command = python("faulty.py") + " " + fault,
                               .answer_limit = answer_limit}));
}

TEST(ExternalProcess, DrivesToTheGoalTheSameWayEachTime) {
  const auto catalogue = catalogue_of({.name = "mine", .command = example("go_to_goal.py")});
  const HeadlessResult first = drive(spec_of(catalogue, "case1"));
  EXPECT_EQ(first.run.outcome, algo::Outcome::Collided) << first.run.reason;
  EXPECT_GT(first.run.metrics.path_length, 1);
  // The same process again, then another one.
  EXPECT_EQ(drive(spec_of(catalogue, "case1")).telemetry_hash, first.telemetry_hash);
  const auto fresh = catalogue_of({.name = "mine", .command = example("go_to_goal.py")});
  EXPECT_EQ(drive(spec_of(fresh, "case1")).telemetry_hash, first.telemetry_hash);
  EXPECT_NE(drive(spec_of(fresh, "case1", 2)).telemetry_hash, first.telemetry_hash);
}

TEST(ExternalProcess, EachFaultEndsTheRunWithASentence) {
  struct Case {
    const char* fault;
    const char* sentence;
  };
  for (const Case& each : {Case{"raises", "ended with status 1. Its last lines:\nTraceback"},
                           Case{"raises", "ValueError: no way at tick 3"},
                           Case{"exits", "It ended with status 7."},
                           Case{"babbles", "It sent bytes that are no message of controller.fbs."},
                           Case{"huge", "It sent a message of more than 1048576 bytes."},
                           Case{"nan", "It commanded a speed that is not a finite number."},
                           Case{"wrong_tick", "It answered tick 4 where tick 3 was asked."}}) {
    SCOPED_TRACE(each.fault);
    const HeadlessResult result = drive(faulty(each.fault));
    EXPECT_EQ(result.run.outcome, algo::Outcome::Failed);
    EXPECT_THAT(
        result.run.reason,
        AllOf(HasSubstr("The controller 'mine' failed at tick 3. "), HasSubstr(each.sentence)));
    EXPECT_EQ(result.run.metrics.ticks, 3U);
  }
}

TEST(ExternalProcess, ASilentOneEndsTheRunAfterTheAnswerLimit) {
  const auto begin = std::chrono::steady_clock::now();
  const HeadlessResult result = drive(faulty("silent", 0.3));
  EXPECT_EQ(result.run.outcome, algo::Outcome::Failed);
  EXPECT_THAT(result.run.reason, HasSubstr("failed at tick 3. It did not answer within 0.3 s."));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
}

TEST(ExternalProcess, AStopEndsTheWaitForASilentOne) {
  std::stop_source stop;
  const std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    stop.request_stop();
  });
  const HeadlessResult result = drive(faulty("silent", 0), stop.get_token());
  EXPECT_EQ(result.run.outcome, algo::Outcome::Stopped) << result.run.reason;
}

TEST(ExternalProcess, AnotherOneTakesThePlaceOfOneThatCrashed) {
  const RunSpec spec = faulty("raises");
  EXPECT_EQ(drive(spec).run.outcome, algo::Outcome::Failed);
  const HeadlessResult again = drive(spec);
  EXPECT_THAT(again.run.reason, HasSubstr("failed at tick 3"));
}

TEST(ExternalProcess, MayPrintAsMuchAsItLikes) {
  RunSpec spec = faulty("prints");
  spec.scenario.time_limit = 5;
  const HeadlessResult result = drive(spec);
  EXPECT_NE(result.run.outcome, algo::Outcome::Failed) << result.run.reason;
  EXPECT_GT(result.run.metrics.ticks, 50U);
}

TEST(ExternalProcess, ACommandThatIsNoneSaysSo) {
  const auto catalogue = catalogue_of({.name = "mine", .command = "/no/such/program here"});
  const HeadlessResult result = drive(spec_of(catalogue));
  EXPECT_EQ(result.run.outcome, algo::Outcome::Failed);
  EXPECT_THAT(result.run.reason,
              AllOf(HasSubstr("failed before its first run. It ended with status 127."),
                    HasSubstr("not found")));
}

TEST(ExternalProcess, AFixedThinkTimeDelaysEachAnswer) {
  Registration own{.name = "mine", .command = python("faulty.py") + " none"};
  const HeadlessResult at_once = drive(spec_of(catalogue_of(own)));
  own.think = {.kind = ThinkTime::Kind::Fixed, .ticks = 4};
  std::vector<double> speeds;
  const RunSpec spec = spec_of(catalogue_of(own));
  const auto robot = make_robot(spec);
  HeadlessOptions options;
  options.watch = [&](const algo::Telemetry& t) {
    speeds.push_back(t.output.twist.v);
    return std::nullopt;
  };
  run_headless(spec, *robot, options, {});
  ASSERT_GT(speeds.size(), 6U);
  EXPECT_THAT(std::vector<double>(speeds.begin(), speeds.begin() + 6),
              ::testing::ElementsAre(0, 0, 0, 0, 0.2, 0.2));
  EXPECT_NE(at_once.run.metrics.ticks, speeds.size());
}

/// Records a run and verifies it when its controller is gone.
Verification recorded(const Registration& own) {
  const tests::TemporaryFolder folder;
  const std::string database = (folder.path() / "runs.db").string();
  db::RunId id = 0;
  {
    const RunSpec spec = spec_of(catalogue_of(own), "case1");
    Recorder recorder(database, recorder_options());
    const auto robot = make_robot(spec);
    HeadlessOptions options;
    options.record = recorder.open(headless_run(spec, robot->spec(), 0));
    run_headless(spec, *robot, options, {});
    recorder.flush();
    id = options.record->run();
  }
  db::RunReader reader(database);
  return verify_run(reader, id);
}

TEST(ExternalProcess, ARecordedRunIsVerifiedWithoutTheController) {
  for (const ThinkTime think : {ThinkTime{},
                                ThinkTime{.kind = ThinkTime::Kind::Measured},
                                ThinkTime{.kind = ThinkTime::Kind::Fixed, .ticks = 3}}) {
    const Verification result =
        recorded({.name = "mine", .command = example("go_to_goal.py"), .think = think});
    EXPECT_FALSE(result.difference) << *result.difference;
    EXPECT_FALSE(result.incomplete) << *result.incomplete;
    EXPECT_GT(result.compared, 50U);
    EXPECT_EQ(result.compared, result.ticks);
  }
}

TEST(ExternalProcess, SeveralRunsHaveAProcessEach) {
  const auto catalogue = catalogue_of({.name = "mine", .command = example("go_to_goal.py")});
  const std::uint64_t expected = drive(spec_of(catalogue, "case1")).telemetry_hash;
  std::vector<std::uint64_t> hashes(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t& hash : hashes) {
      threads.emplace_back([&] { hash = drive(spec_of(catalogue, "case1")).telemetry_hash; });
    }
  }
  EXPECT_THAT(hashes, ::testing::Each(expected));
}

}  // namespace
}  // namespace server::external
