// tests/server/experiment/sweep_death_test.cpp: an experiment of which a run kills the program
// finishes without it; a program killed from outside costs nothing.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <set>
#include <string>
#include <vector>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "algo/controller.hpp"
#include "algo/pipeline/controllers.hpp"
#include "server/experiment/arithmetic.hpp"
#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Log = std::vector<std::string>;

std::atomic<int> alive{0};
std::atomic<int> most_alive{0};

/// Drives to the goal; counts how many of them there are, and kills the program where the start is
/// not the origin.
class Watched final : public algo::Controller {
 public:
  Watched() : driver_(algo::builtin_controllers().at("go_to_goal").make()) {
    const int now = ++alive;
    int most = most_alive;
    while (now > most && !most_alive.compare_exchange_weak(most, now)) {
    }
  }
  ~Watched() override { --alive; }
  void reset(const algo::Pose2& start_W) override {
    if (start_W.x != 0) std::raise(SIGKILL);
    driver_->reset(start_W);
  }
  void update(const algo::ControlInput& in,
              const algo::Parameters& parameters,
              algo::ControlOutput& out) override {
    driver_->update(in, parameters, out);
  }
  void explain(const algo::Telemetry& t, algo::Explanation& words) const override {
    driver_->explain(t, words);
  }

 private:
  std::unique_ptr<algo::Controller> driver_;
};

/// Two scenarios, in the second of which the controller `watched` kills the program if `deadly`.
Plan plan_with(bool deadly) {
  std::vector<algo::ControllerInfo> entries = algo::builtin_controllers().entries();
  algo::ControllerInfo watched = *algo::builtin_controllers().find("go_to_goal");
  watched.name = "watched";
  watched.make = [] { return std::make_unique<Watched>(); };
  entries.push_back(watched);
  const json document = {{"name", "deaths"},
                         {"scenarios",
                          {{{"name", "mild"}, {"goal", {{"x", 1}, {"y", 0.2}}}},
                           {{"name", "wild"},
                            {"start", {{"x", deadly ? 0.1 : 0.0}, {"y", 0}}},
                            {"goal", {{"x", 1}, {"y", 0.2}}}}}},
                         {"controllers", {"go_to_goal", "watched"}},
                         {"repeats", 2},
                         {"physics", "kinematic"}};
  return Plan(
      document_from_json(document,
                         ScenarioLibrary("", ""),
                         std::make_shared<const algo::ControllerCatalogue>(std::move(entries))));
}

constexpr std::size_t kDeadly[] = {6, 7};  // the runs of `watched` in the second scenario

/// Runs the experiment in a process of its own. True if that was killed.
bool dies(const Plan& plan, const fs::path& folder, unsigned threads) {
  const pid_t child = fork();
  if (child == 0) {
    run_sweep(plan, folder, {.threads = threads});
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

std::vector<std::size_t> broken_in(const Rows& rows) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.has(i) && rows.broken(i)) runs.push_back(i);
  }
  return runs;
}

class SweepDeath : public testing::TestWithParam<unsigned> {
 protected:
  fs::path folder(const char* name = "out") const { return root_.path() / name; }
  /// Writes lines at the end of the log, as a program leaves it that was killed.
  void add_to_log(const Log& lines) const {
    std::string text = read_text(folder() / "runs.jsonl");
    for (const std::string& line : lines) text += line + '\n';
    write_text(folder() / "runs.jsonl", text);
  }
  /// The log of no run at all.
  void begin_log(const Plan& plan) const {
    make_folder(folder());
    open_log(plan, folder());
  }

 private:
  tests::TemporaryFolder root_{};
};

TEST_P(SweepDeath, ARunThatKillsTheProgramTwiceFailsAndTheOthersFinish) {
  const Plan plan = plan_with(true);
  std::size_t deaths = 0;
  while (dies(plan, folder(), GetParam())) ASSERT_LT(++deaths, 5U);
  EXPECT_GE(deaths, 3U);  // two runs, the last death of each alone
  const Rows rows = open_log(plan, folder())->found();
  EXPECT_THAT(broken_in(rows), ElementsAre(kDeadly[0], kDeadly[1]));
  EXPECT_THAT(rows.reason(6), HasSubstr("killed the program twice"));
  const Results results = results_of(plan, rows);
  EXPECT_EQ(results.missing, 0U);
  EXPECT_EQ(results.failed, 2U);
  EXPECT_THAT(runs_to_make(rows), IsEmpty());
  EXPECT_THAT(runs_to_make(rows, Wanted::Failed), ElementsAre(6, 7));
}

INSTANTIATE_TEST_SUITE_P(Workers, SweepDeath, testing::Values(1U, 2U, 4U));

TEST_F(SweepDeath, ADeathFromOutsideFailsNoRunThatWasUnderWay) {
  const Plan plan = plan_with(false);
  const Rows whole = run_sweep(plan, folder("whole"), {.threads = 2});
  begin_log(plan);
  add_to_log({R"({"begun":0})", R"({"begun":5})"});  // and killed
  EXPECT_THAT(open_log(plan, folder())->lost(), ElementsAre(0, 5));
  const Rows rows = run_sweep(plan, folder(), {.threads = 2});
  EXPECT_THAT(broken_in(rows), IsEmpty());
  for (const auto& [made, name] : {std::pair{&whole, "whole"}, {&rows, "out"}}) {
    write_report(plan, *made, results_of(plan, *made), folder(name));
  }
  EXPECT_EQ(read_text(folder() / "runs.csv"), read_text(folder("whole") / "runs.csv"));
  EXPECT_THAT(open_log(plan, folder())->lost(), IsEmpty());
}

TEST_F(SweepDeath, OnlyARunUnderWayAtBothDeathsFails) {
  const Plan plan = plan_with(false);
  begin_log(plan);
  add_to_log({R"({"begun":0})", R"({"begun":5})", R"({"begun":5})"});
  const auto log = open_log(plan, folder());
  EXPECT_THAT(broken_in(log->found()), ElementsAre(5));
  EXPECT_THAT(log->lost(), ElementsAre(0));
}

TEST_F(SweepDeath, ARunThatWasStoppedIsNotLost) {
  const Plan plan = plan_with(false);
  begin_log(plan);
  {
    const auto log = open_log(plan, folder());
    log->begin(3);
    log->begin(4);
    log->leave(3);
  }  // leaves 4
  EXPECT_THAT(open_log(plan, folder())->lost(), IsEmpty());
  add_to_log({R"({"begun":3})"});
  open_log(plan, folder())->begin(3);  // stopped again
  EXPECT_THAT(open_log(plan, folder())->lost(), ElementsAre(3));
}

TEST_F(SweepDeath, RunsThatMayHaveKilledTheProgramRunOneByOne) {
  const Plan plan = plan_with(false);
  begin_log(plan);
  add_to_log({R"({"begun":2})", R"({"begun":3})", R"({"begun":6})", R"({"begun":7})"});
  most_alive = 0;
  std::vector<std::size_t> done;
  run_sweep(plan, folder(), {.threads = 4, .progress = [&](std::size_t count, std::size_t all) {
                               EXPECT_EQ(all, 8U);
                               done.push_back(count);
                             }});
  EXPECT_EQ(most_alive, 1);  // these four are all runs of `watched`
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST_F(SweepDeath, ARerunMakesTheFailedOrTheLostRunsOnly) {
  const Plan plan = plan_with(false);
  begin_log(plan);
  add_to_log({R"({"begun":1})",
              R"({"begun":2})",
              R"({"begun":2})",
              R"({"run":4,"outcome":"failed","reason":"Lost.","broken":true,"figures":[]})"});
  const auto ended = [&](Wanted wanted) {
    const Rows rows = run_sweep(plan, folder(), {.threads = 1}, wanted);
    std::set<std::size_t> runs;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows.has(i) && !rows.broken(i)) runs.insert(i);
    }
    return runs;
  };
  EXPECT_THAT(ended(Wanted::Lost), ElementsAre(1));
  EXPECT_THAT(ended(Wanted::Failed), ElementsAre(1, 2, 4));
  EXPECT_EQ(ended(Wanted::Missing).size(), plan.size());
}

TEST_F(SweepDeath, RunsOfAnotherMathematicalLibraryAreWarnedOf) {
  const Plan plan = plan_with(false);
  const auto warnings = [&] {
    std::vector<std::string> all;
    run_sweep(plan, folder(), {.threads = 1}, Wanted::Missing, [&](const std::string& text) {
      all.push_back(text);
    });
    return all;
  };
  EXPECT_THAT(warnings(), IsEmpty());
  EXPECT_THAT(read_text(folder() / "runs.jsonl"), HasSubstr(experiment::arithmetic()));
  EXPECT_THAT(warnings(), IsEmpty());
  add_to_log({R"({"arithmetic":"0123456789abcdef"})", R"({"begun":1})"});
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("another mathematical library")));
}

TEST_F(SweepDeath, ALogThatNamesARunOfNoneIsDamaged) {
  const Plan plan = plan_with(false);
  for (const char* const line : {R"({"begun":8})", R"({"left":0})"}) {
    fs::remove_all(folder());
    begin_log(plan);
    add_to_log({line, R"({"begun":0})"});
    EXPECT_THAT([&] { open_log(plan, folder()); },
                testing::ThrowsMessage<std::runtime_error>(HasSubstr("line 2 is damaged")));
  }
}

}  // namespace
}  // namespace server::sweep
