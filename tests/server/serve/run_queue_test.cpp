// tests/server/serve/run_queue_test.cpp: queued runs at the end of the program and with a full
// store.
#include "server/serve/run_queue.hpp"

#include <atomic>
#include <future>
#include <optional>

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>

#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

using db::RunReader;
using db::RunStatus;
using testing::HasSubstr;

RunSpec case1() {
  RunOverrides kinematic;
  kinematic.physics = sim::PhysicsKind::Kinematic;
  return make_spec(ScenarioLibrary({}, {}).load("case1"), kinematic);
}

class RunQueueTest : public test::RecorderFiles {
 protected:
  static std::vector<db::RunId> start(RunQueue& queue, const RepeatedRun& asked) {
    std::promise<std::vector<db::RunId>> runs;
    queue.start(asked, [&](std::vector<db::RunId> given, const std::string& failure) {
      EXPECT_EQ(failure, "");
      runs.set_value(std::move(given));
    });
    return runs.get_future().get();
  }
  static std::string refused(RunQueue& queue, const RepeatedRun& asked) {
    std::promise<std::string> why;
    queue.start(asked, [&](const std::vector<db::RunId>&, const std::string& failure) {
      why.set_value(failure);
    });
    return why.get_future().get();
  }
  static std::string resume(RunQueue& queue, db::RunId run) {
    std::promise<std::string> refusal;
    queue.resume(run, case1(), 0, 1000, [&](const std::string& why) { refusal.set_value(why); });
    return refusal.get_future().get();
  }
  bool comes_to(db::RunId run, RunStatus status) {
    RunReader reader(path);
    return comes([&] { return get(reader, run).status == status; });
  }
};

TEST_F(RunQueueTest, InterruptedRunsRunAgainUnderTheirNumbers) {
  std::vector<db::RunId> runs;
  {
    Recorder recorder(path, recorder_options());
    RunQueue queue(recorder);
    runs = start(queue, {.spec = case1(), .repeats = 2, .pace = 0.5});
    ASSERT_EQ(runs.size(), 2u);
    ASSERT_TRUE(comes_to(runs[0], RunStatus::Recording));
    RunReader reader(path);
    ASSERT_TRUE(comes([&] { return get(reader, runs[0]).ticks > 0; }));
  }
  Recorder recorder(path, recorder_options());
  RunQueue queue(recorder);
  RunReader reader(path);
  for (const db::RunId run : runs) {
    EXPECT_EQ(get(reader, run).status, RunStatus::Interrupted);
    EXPECT_THAT(get(reader, run).reason, HasSubstr("stopped"));
    EXPECT_EQ(resume(queue, run), "");
  }
  for (const db::RunId run : runs) {
    ASSERT_TRUE(comes_to(run, RunStatus::Finished));
    EXPECT_EQ(get(reader, run).outcome, "reached");
    const Verification verification = verify_run(reader, run);
    EXPECT_EQ(verification.difference, std::nullopt);
    EXPECT_EQ(verification.incomplete, std::nullopt);
    EXPECT_EQ(verification.ticks, get(reader, run).ticks);
    EXPECT_THAT(resume(queue, run), HasSubstr("neither interrupted"));
  }
}

TEST_F(RunQueueTest, RunsWaitForRoomAndCanBeCancelledAndDeletedMeanwhile) {
  std::atomic<std::uint64_t> free = 100 << 20;
  RecorderOptions options = recorder_options();
  options.wait_for_room = true;
  options.commit_interval = std::chrono::milliseconds(5);
  options.disk = [&](const std::string&) { return DiskSpace{.free = free, .total = 160 << 20}; };
  Recorder recorder(path, std::move(options));
  RunQueue queue(recorder);
  const auto runs = start(queue, {.spec = case1(), .repeats = 3, .pace = 16});
  RunReader reader(path);
  ASSERT_TRUE(comes([&] { return get(reader, runs[0]).ticks > 0; }));
  free = 0;
  ASSERT_TRUE(comes([&] { return !recorder.takes_more(); }));
  EXPECT_THAT(refused(queue, {.spec = case1()}), HasSubstr("almost full"));
  // The active run has ticks that wait for room: it ends anyway.
  for (const db::RunId run : {runs[0], runs[1]}) {
    EXPECT_TRUE(queue.cancel(run));
    EXPECT_TRUE(comes_to(run, RunStatus::Cancelled)) << run;
    EXPECT_EQ(recorder.ask([&](db::RunStore& store) { return store.delete_run(run); }),
              db::RunStore::Deletion::Deleted);
  }
  EXPECT_EQ(get(reader, runs[2]).status, RunStatus::Queued);
  free = 100 << 20;
  EXPECT_TRUE(comes_to(runs[2], RunStatus::Finished));
  EXPECT_EQ(verify_run(reader, runs[2]).incomplete, std::nullopt);
}

TEST_F(RunQueueTest, SeveralThreadsWorkOffOneQueue) {
  Recorder recorder(path, recorder_options());
  RunQueue queue(recorder, 2);
  const auto runs = start(queue, {.spec = case1(), .repeats = 4, .pace = 0.5});
  ASSERT_TRUE(comes_to(runs[0], RunStatus::Recording));
  ASSERT_TRUE(comes_to(runs[1], RunStatus::Recording));
  RunReader reader(path);
  EXPECT_EQ(get(reader, runs[2]).status, RunStatus::Queued);
  // Each is cancelled separately, and the next takes its place.
  EXPECT_TRUE(queue.cancel(runs[1]));
  EXPECT_TRUE(comes_to(runs[1], RunStatus::Cancelled));
  EXPECT_TRUE(comes_to(runs[2], RunStatus::Recording));
  EXPECT_EQ(get(reader, runs[0]).status, RunStatus::Recording);
  for (const db::RunId run : {runs[0], runs[2], runs[3]}) EXPECT_TRUE(queue.cancel(run));
  for (const db::RunId run : runs) EXPECT_TRUE(comes_to(run, RunStatus::Cancelled)) << run;
}

TEST_F(RunQueueTest, ASlowlyPacedRunHoldsUpNoOther) {
  Recorder recorder(path, recorder_options());
  RunQueue queue(recorder);
  const auto slow = start(queue, {.spec = case1(), .repeats = 2, .pace = 0.01});
  ASSERT_TRUE(comes_to(slow[0], RunStatus::Recording));
  const auto fast = start(queue, {.spec = case1(), .repeats = 2});
  for (const db::RunId run : fast) EXPECT_TRUE(comes_to(run, RunStatus::Finished));
  RunReader reader(path);
  EXPECT_EQ(get(reader, slow[0]).status, RunStatus::Recording);
  EXPECT_EQ(get(reader, slow[1]).status, RunStatus::Queued);
  for (const db::RunId run : slow) {
    EXPECT_TRUE(queue.cancel(run));
    EXPECT_TRUE(comes_to(run, RunStatus::Cancelled));
  }
}

TEST_F(RunQueueTest, ASlowlyPacedBatchHoldsUpNoOtherPacedRun) {
  Recorder recorder(path, recorder_options());
  RunQueue queue(recorder);
  const auto slow = start(queue, {.spec = case1(), .repeats = 20, .pace = 0.01});
  ASSERT_TRUE(comes_to(slow[0], RunStatus::Recording));
  const auto other = start(queue, {.spec = case1(), .repeats = 2, .pace = 100});
  for (const db::RunId run : other) EXPECT_TRUE(comes_to(run, RunStatus::Finished));
  RunReader reader(path);
  EXPECT_EQ(get(reader, slow[0]).status, RunStatus::Recording);
  EXPECT_EQ(get(reader, slow[1]).status, RunStatus::Queued);
}

TEST_F(RunQueueTest, WaitingWorldsAreLimitedInBytes) {
  Recorder recorder(path, recorder_options());
  RunQueue queue(recorder);
  RepeatedRun large{.spec = case1(), .pace = 0.1};
  for (std::uint32_t id = 100; id < 1900; ++id) {
    algo::Obstacle thing{.id = id, .shape = algo::Cylinder{.radius = 0.1}};
    thing.pose_W = {20.0 + id, 0, 0};
    large.spec.scenario.obstacles.push_back(thing);
  }
  std::size_t taken = 0;
  while (taken < 2000 && queue.start(large, [](const auto&, const auto&) {})) ++taken;
  EXPECT_GT(taken, 20U);
  EXPECT_LT(taken, 1000U);
  EXPECT_TRUE(queue.start({.spec = case1()}, [](const auto&, const auto&) {}));
}

}  // namespace
}  // namespace server
