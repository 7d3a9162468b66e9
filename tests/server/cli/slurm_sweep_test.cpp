// tests/server/cli/slurm_sweep_test.cpp: what is submitted, and when it is merged, with commands
// that stand in for Slurm's.
#include "server/cli/slurm_sweep.hpp"

#include <cstdlib>
#include <string>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/cli/cli.hpp"
#include "server/experiment/sweep/origin.hpp"
#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

sweep::Plan plan_of(int repeats) {
  return sweep::Plan(sweep::document_from_json(
      {{"name", "near"},
       {"scenarios", {{{"name", "near"}, {"goal", {{"x", 1}, {"y", 0}}}}}},
       {"controllers", {"go_to_goal"}},
       {"repeats", repeats},
       {"physics", "kinematic"}},
      ScenarioLibrary("", "")));
}

class SlurmSweepTest : public testing::Test {
 protected:
  SlurmSweepTest() : path_(std::getenv("PATH")) {
    stand_in("squeue", "");
    stand_in("sbatch", "echo \"$@\" >>" + file("submitted") + "; echo 7");
    setenv("PATH", (root_.path().string() + ":" + path_).c_str(), 1);
  }
  ~SlurmSweepTest() override { setenv("PATH", path_.c_str(), 1); }

  void stand_in(const std::string& name, const std::string& lines) const {
    write_text(file(name), "#!/bin/sh\n" + lines + "\n");
    fs::permissions(file(name), fs::perms::owner_all);
  }
  std::string file(const std::string& name) const { return (root_.path() / name).string(); }
  std::string submitted() const { return read_text(file("submitted")); }
  /// As a task would leave it.
  void run_task(std::size_t task) const {
    const fs::path shard = fs::path(file("out")) / "shards" / std::to_string(task);
    sweep::claim_for_shard(shard, {task, 3});
    sweep::run_sweep(plan, shard, {.threads = 1, .shard = {task, 3}});
  }
  int sweep_once(const sweep::Plan& which) const {
    testing::internal::CaptureStdout();
    try {
      const int status = sweep_on_slurm(
          which, {.folder = file("out"), .tasks = 3, .pause = std::chrono::milliseconds(1)});
      testing::internal::GetCapturedStdout();
      return status;
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
  }
  const sweep::Plan plan = plan_of(5);

 private:
  tests::TemporaryFolder root_{};
  std::string path_;
};

TEST_F(SlurmSweepTest, SubmitsAllThenWhatIsMissingAndMergesInTheEnd) {
  EXPECT_EQ(sweep_once(plan), kIncomplete);
  EXPECT_THAT(submitted(), HasSubstr("--array=0-2 "));
  run_task(1);
  stand_in("squeue", "echo 2");
  EXPECT_EQ(sweep_once(plan), kIncomplete);  // 2 is in the queue, 0 is lost
  EXPECT_THAT(submitted(), HasSubstr("--array=0 "));
  run_task(0);
  run_task(2);
  stand_in("squeue", "");
  EXPECT_EQ(sweep_once(plan), kReached);
  const sweep::Rows rows = sweep::run_sweep(plan, file("local"), {.threads = 1});
  write_report(plan, rows, results_of(plan, rows), file("local"));
  for (const char* const name : {"results.json", "runs.csv", "report.html"}) {
    EXPECT_EQ(read_text(fs::path(file("out")) / name), read_text(fs::path(file("local")) / name));
  }
  const std::string before = submitted();
  EXPECT_EQ(sweep_once(plan), kReached);
  EXPECT_EQ(submitted(), before);
}

TEST_F(SlurmSweepTest, TriesABusySchedulerAgainAndThenSaysWhatItSaid) {
  stand_in("sbatch",
           "echo x >>" + file("tries") + "; [ $(wc -l <" + file("tries") +
               ") -lt 3 ] && { echo 'Unable to contact slurm controller' >&2; exit 1; }; echo 7");
  EXPECT_EQ(sweep_once(plan), kIncomplete);
  EXPECT_EQ(read_text(file("tries")), "x\nx\nx\n");
  stand_in("sbatch", "echo 'Invalid partition' >&2; exit 1");
  EXPECT_THAT([&] { sweep_once(plan); },
              ThrowsMessage<std::runtime_error>(
                  HasSubstr("sbatch failed 4 times and said in the end: Invalid partition")));
}

TEST_F(SlurmSweepTest, RefusesAFolderOfAnotherExperiment) {
  sweep_once(plan);
  EXPECT_THAT([&] { sweep_once(plan_of(6)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("repeats is 5 there and 6 here")));
}

}  // namespace
}  // namespace server
