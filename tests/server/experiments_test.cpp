// tests/server/experiments_test.cpp: queued runs when the program ends and when there is no room.
#include "server/experiments.hpp"

#include <atomic>
#include <future>
#include <optional>

#include "tests/server/recorder_fixture.hpp"
#include <gmock/gmock.h>

#include "server/record_sink.hpp"
#include "server/run_json.hpp"
#include "server/scenario_library.hpp"
#include "server/verify.hpp"

namespace server {
namespace {

using db::RunReader;
using db::RunStatus;
using testing::HasSubstr;

RunSpec case1() {
  RunOverrides kinematic;
  kinematic.vehicle = "kinematic";
  return make_spec(ScenarioLibrary({}, {}).load("case1"), kinematic);
}

class ExperimentsTest : public test::RecorderFiles {
 protected:
  static std::vector<db::RunId> start(Experiments& experiments, const Experiment& experiment) {
    std::promise<std::vector<db::RunId>> runs;
    experiments.start(experiment, [&](std::vector<db::RunId> given, const std::string& failure) {
      EXPECT_EQ(failure, "");
      runs.set_value(std::move(given));
    });
    return runs.get_future().get();
  }
  static std::string resume(Experiments& experiments, db::RunId run) {
    std::promise<std::string> refusal;
    experiments.resume(run, case1(), 0, [&](const std::string& why) { refusal.set_value(why); });
    return refusal.get_future().get();
  }
  bool comes_to(db::RunId run, RunStatus status) {
    RunReader reader(path);
    return comes([&] { return get(reader, run).status == status; });
  }
};

TEST_F(ExperimentsTest, RunsThatWereCutAreInterruptedAndRunAgainUnderTheirNumbers) {
  std::vector<db::RunId> runs;
  {
    Recorder recorder(path, recorder_options());
    Experiments experiments(recorder);
    runs = start(experiments, {.spec = case1(), .repeats = 2, .pace = 0.5});
    ASSERT_EQ(runs.size(), 2u);
    ASSERT_TRUE(comes_to(runs[0], RunStatus::Recording));
    RunReader reader(path);
    ASSERT_TRUE(comes([&] { return get(reader, runs[0]).ticks > 0; }));
  }
  Recorder recorder(path, recorder_options());
  Experiments experiments(recorder);
  RunReader reader(path);
  for (const db::RunId run : runs) {
    EXPECT_EQ(get(reader, run).status, RunStatus::Interrupted);
    EXPECT_THAT(get(reader, run).reason, HasSubstr("stopped"));
    EXPECT_EQ(resume(experiments, run), "");
  }
  for (const db::RunId run : runs) {
    ASSERT_TRUE(comes_to(run, RunStatus::Finished));
    EXPECT_EQ(get(reader, run).outcome, "reached");
    const Verification verification = verify_run(reader, run);
    EXPECT_EQ(verification.difference, std::nullopt);
    EXPECT_EQ(verification.incomplete, std::nullopt);
    EXPECT_EQ(verification.ticks, get(reader, run).ticks);
    EXPECT_THAT(resume(experiments, run), HasSubstr("neither interrupted"));
  }
}

TEST_F(ExperimentsTest, QueuedRunsWaitForRoomAndCanBeCancelledMeanwhile) {
  std::atomic<std::uint64_t> free = 0;
  RecorderOptions options = recorder_options();
  options.wait_for_room = true;
  options.commit_interval = std::chrono::milliseconds(5);
  options.disk = [&](const std::string&) { return DiskSpace{.free = free, .total = 160 << 20}; };
  Recorder recorder(path, std::move(options));
  ASSERT_TRUE(comes([&] { return !recorder.takes_more(); }));
  Experiments experiments(recorder);
  const auto runs = start(experiments, {.spec = case1(), .repeats = 2});
  EXPECT_TRUE(experiments.cancel(runs[0]));
  EXPECT_TRUE(comes_to(runs[0], RunStatus::Cancelled));
  RunReader reader(path);
  EXPECT_EQ(get(reader, runs[1]).status, RunStatus::Queued);
  EXPECT_EQ(recorder.ask([&](db::RunStore& store) { return store.delete_run(runs[0]); }),
            db::RunStore::Deletion::Deleted);
  free = 100 << 20;
  EXPECT_TRUE(comes_to(runs[1], RunStatus::Finished));
}

}  // namespace
}  // namespace server
