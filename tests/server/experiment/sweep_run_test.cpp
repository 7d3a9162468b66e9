// tests/server/experiment/sweep_run_test.cpp: an experiment gives the same files for any number of
// workers and interruptions, and never mixes two documents.
#include "server/experiment/sweep/sweep_run.hpp"

#include <chrono>
#include <set>
#include <string>
#include <utility>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "db/run_reader.hpp"
#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr const char* kFiles[] = {"results.json",
                                  "runs.csv",
                                  "report.md",
                                  "report.tex",
                                  "report.html",
                                  "pictures/success.svg",
                                  "pictures/paths_post.svg"};

/// 1 m to the goal past a post: some hundredths of a second a run.
json short_document() {
  return {{"name", "short"},
          {"scenarios",
           {{{"name", "post"},
             {"goal", {{"x", 1}, {"y", 0}}},
             {"obstacles", {{{"type", "cylinder"}, {"x", 0.5}, {"y", 0.9}, {"radius", 0.1}}}}},
            {{"name", "free"}, {"goal", {{"x", 1}, {"y", 0.2}}}}}},
          {"controllers", {"original", "go_to_goal"}},
          {"sweep", {{"grid", {{"v_max", {0.3, 0.5}}}}}},
          {"repeats", 3},
          {"physics", "kinematic"},
          {"comparisons", {{"baseline", "go_to_goal"}}}};
}

Plan short_plan(const json& source) {
  return Plan(document_from_json(source, ScenarioLibrary("", "")));
}

Results run_and_write(const Plan& plan, const fs::path& folder, unsigned threads = 1) {
  const Rows rows = run_sweep(plan, folder, {.threads = threads});
  Results results = results_of(plan, rows);
  write_report(plan, rows, results, folder);
  return results;
}

std::string files_of(const fs::path& folder) {
  std::string all;
  for (const char* const file : kFiles) all += read_text(folder / file);
  return all;
}

/// Keeps `lines` whole lines of the log and `more` bytes of the next.
void cut_log(const fs::path& folder, std::size_t lines, std::size_t more) {
  const std::string text = read_text(folder / "runs.jsonl");
  std::size_t at = 0;
  for (std::size_t i = 0; i < lines; ++i) at = text.find('\n', at) + 1;
  write_text(folder / "runs.jsonl", text.substr(0, at + more));
}

std::vector<std::string> outcomes_in(const fs::path& store) {
  std::vector<std::string> outcomes;
  db::RunReader reader(store.string());
  for (const db::RunRow& row : reader.list({}, 100).runs) outcomes.push_back(row.outcome);
  return outcomes;
}

class SweepRun : public testing::Test {
 protected:
  fs::path folder(const char* name) const { return root_.path() / name; }
  const Plan plan = short_plan(short_document());

 private:
  tests::TemporaryFolder root_{};
};

TEST_F(SweepRun, GivesTheSameFilesForAnyNumberOfWorkers) {
  EXPECT_TRUE(run_and_write(plan, folder("one"), 1).complete());
  EXPECT_TRUE(run_and_write(plan, folder("four"), 4).complete());
  EXPECT_EQ(files_of(folder("one")), files_of(folder("four")));
}

std::size_t ended_in(const fs::path& folder) {
  const std::string text = read_text(folder / "runs.jsonl");
  std::size_t count = 0;
  for (std::size_t at = text.find("{\"broken\""); at != std::string::npos; ++count) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;  // torn
    at = text.find("{\"broken\"", end);
  }
  return count;
}

TEST_F(SweepRun, AGoalOfTheHandIsAGoal) {
  const json document = {{"name", "hand"},
                         {"scenarios", {"arm_table"}},
                         {"controllers", {"modified"}},
                         {"physics", "kinematic"}};
  const Plan hand = short_plan(document);
  const Rows rows = run_sweep(hand, folder("hand"), {.threads = 1});
  write_report(hand, rows, results_of(hand, rows), folder("hand"));
  EXPECT_THAT(read_text(folder("hand") / "runs.csv"), HasSubstr("reached"));
  EXPECT_THAT(read_text(folder("hand") / "pictures/paths_arm_table.svg"), HasSubstr(">goal<"));
}

TEST_F(SweepRun, GoesOnAfterATornFile) {
  run_and_write(plan, folder("whole"));
  run_and_write(plan, folder("torn"));
  const std::string one_by_one = read_text(folder("torn") / "runs.jsonl");
  for (const auto& [lines, more] : {std::pair{8, 40}, {1, 1}, {1, 0}, {0, 30}, {0, 0}, {12, 0}}) {
    write_text(folder("torn") / "runs.jsonl", one_by_one);
    cut_log(folder("torn"), static_cast<std::size_t>(lines), static_cast<std::size_t>(more));
    const std::size_t ended = ended_in(folder("torn"));
    EXPECT_EQ(ended, static_cast<std::size_t>(lines > 0 ? (lines - 1) / 2 : 0));  // begun, ended
    std::size_t made = 0;
    run_sweep(plan, folder("torn"), {.threads = 2, .progress = [&](std::size_t, std::size_t all) {
                                       made = all;
                                     }});
    EXPECT_EQ(made, plan.size() - ended);
    run_and_write(plan, folder("torn"));
    EXPECT_EQ(files_of(folder("whole")), files_of(folder("torn"))) << lines << ' ' << more;
  }
}

TEST_F(SweepRun, SaysWhichLineOfItsLogIsDamaged) {
  run_and_write(plan, folder("out"));
  std::string text = read_text(folder("out") / "runs.jsonl");
  text.replace(text.find('\n') + 1, 5, "#####");
  write_text(folder("out") / "runs.jsonl", text);
  EXPECT_THAT([&] { run_sweep(plan, folder("out"), {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("line 2 is damaged")));
}

TEST_F(SweepRun, RefusesTheFolderOfAnotherDocumentAndSaysHowItDiffers) {
  run_and_write(plan, folder("out"));
  const auto refusal = [&](const char* patch) {
    json other = short_document();
    other.merge_patch(json::parse(patch));
    try {
      run_sweep(short_plan(other), folder("out"), {});
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal(R"({"repeats": 4})"), HasSubstr("repeats is 3 there and 4 here"));
  EXPECT_THAT(refusal(R"({"seed": 9})"), HasSubstr("seed is 9 here and not there"));
  EXPECT_THAT(refusal(R"({"physics": null})"), HasSubstr("physics is \"kinematic\" there"));
  EXPECT_THAT(refusal(R"({"sweep": {"grid": {"v_max": [0.3, 0.4]}}})"),
              HasSubstr("sweep/grid/v_max/1 is 0.5 there and 0.4 here"));
  EXPECT_TRUE(run_and_write(plan, folder("out")).complete());
}

TEST_F(SweepRun, ANamedScenarioThatHasChangedIsAnotherExperiment) {
  const json before = identity_of(plan.document());
  Document changed = plan.document();
  changed.scenarios[1].obstacles.push_back({.id = 7, .shape = algo::Cylinder{.radius = 0.2}});
  EXPECT_EQ(difference(before, identity_of(changed)), "the scenario 'free' is another");
}

TEST_F(SweepRun, AnotherVersionIsAnotherExperiment) {
  const json ours = identity_of(plan.document());
  json theirs = ours;
  theirs["tautline"] = "0.0.9";
  EXPECT_THAT(difference(theirs, ours),
              StartsWith("tautline (the version) is \"0.0.9\" there and "));
}

TEST_F(SweepRun, TheCopiesOfTheScenariosGiveTheSameExperiment) {
  json every = short_document();
  every.erase("sweep");
  every["controllers"] = {"go_to_goal"};
  every.erase("comparisons");
  every["time_factor"] = 2;
  every["noise"] = {{"laser", 0.01}};
  const ScenarioLibrary library("", "");
  for (const ScenarioEntry& entry : library.list()) {
    if (library.load(entry.name).end_W()) every["scenarios"].push_back(entry.name);
  }
  every["scenarios"].push_back({{"random_layouts", {{"count", 2}, {"robot", "jackal"}}}});
  const Document document = document_from_json(every, library);
  EXPECT_FALSE(document_in(folder("out"), every).has_value());
  write_scenarios(document, folder("out"));
  const auto copied = document_in(folder("out"), every);
  ASSERT_TRUE(copied.has_value());
  EXPECT_EQ(identity_of(*copied), identity_of(document));
  ASSERT_EQ(copied->scenarios.size(), document.scenarios.size());
  for (std::size_t i = 0; i < document.scenarios.size(); ++i) {
    EXPECT_EQ(copied->scenarios[i].name, document.scenarios[i].name);
    EXPECT_EQ(copied->scenarios[i].time_limit, document.scenarios[i].time_limit);
  }
}

TEST_F(SweepRun, LeavesAForeignFileAlone) {
  make_folder(folder("out"));
  for (const char* const text : {"my notes", "my notes\n", "{}\n", "[1]\n{\n"}) {
    write_text(folder("out") / "runs.jsonl", text);
    EXPECT_THAT([&] { run_sweep(plan, folder("out"), {}); },
                ThrowsMessage<std::runtime_error>(HasSubstr("is no file of finished runs")));
    EXPECT_EQ(read_text(folder("out") / "runs.jsonl"), text);
  }
}

TEST_F(SweepRun, IsRefusedWhileAnotherOneWritesThere) {
  make_folder(folder("out"));
  const RunLog other(folder("out") / "runs.jsonl", identity_of(plan.document()), plan.size());
  EXPECT_THAT([&] { run_sweep(plan, folder("out"), {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("another sweep writes there")));
}

TEST_F(SweepRun, MissingRunsHeadTheReport) {
  std::stop_source stop;
  const Rows rows = run_sweep(plan,
                              folder("out"),
                              {.threads = 1,
                               .progress =
                                   [&](std::size_t done, std::size_t) {
                                     if (done == 5) stop.request_stop();
                                   },
                               .stop = stop.get_token()});
  const Results results = results_of(plan, rows);
  EXPECT_EQ(results.missing, plan.size() - 5);
  write_report(plan, rows, results, folder("out"));
  EXPECT_THAT(read_text(folder("out") / "report.md"),
              StartsWith("**INCOMPLETE: of 24 runs, 19 are missing and 0 failed.**"));
  EXPECT_THAT(read_text(folder("out") / "report.tex"), HasSubstr("INCOMPLETE"));
  EXPECT_THAT(read_text(folder("out") / "runs.csv"), HasSubstr(",missing,"));
}

TEST_F(SweepRun, AFailedRunStaysInTheDenominatorAndIsMadeAgain) {
  Rows rows = run_sweep(plan, folder("out"), {});
  const experiment::Row broken{
      .outcome = algo::Outcome::Failed, .reason = "The link was lost.", .broken = true};
  {
    RunLog log(folder("out") / "runs.jsonl", identity_of(plan.document()), plan.size());
    log.append(0, broken);
  }
  rows.set(0, broken);
  const Results results = results_of(plan, rows);
  EXPECT_EQ(results.failed, 1U);
  EXPECT_FALSE(results.complete());
  EXPECT_EQ(results.arms[0].rates[0].runs, 6U);
  EXPECT_EQ(results.arms[0].rates[0].count, 5U);
  write_report(plan, rows, results, folder("out"));
  EXPECT_THAT(read_text(folder("out") / "runs.csv"), HasSubstr("failed,The link was lost.,,,"));
  std::size_t made = 0;
  run_sweep(plan, folder("out"), {.progress = [&](std::size_t, std::size_t all) { made = all; }});
  EXPECT_EQ(made, 1U);
  EXPECT_TRUE(run_and_write(plan, folder("out")).complete());
}

TEST_F(SweepRun, AnyRunRepeatsFromItsScenarioFileAlone) {
  const Rows rows = run_sweep(plan, folder("out"), {});
  const std::size_t run = 8;  // not of the first arm
  const experiment::Trial trial = plan.trial(run);
  EXPECT_EQ(plan.command(run),
            "tautline run scenarios/post.json --controller go_to_goal --seed 3 --set v_max=0.3");
  RunOverrides overrides{.controller = "go_to_goal", .seed = 3};
  overrides.parameters = {{"v_max", 0.3}};
  experiment::Trial again = trial;
  again.spec =
      make_spec(ScenarioLibrary::from_file(folder("out") / "scenarios/post.json"), overrides);
  EXPECT_EQ(run_trial(again).figures, rows.row(run).figures);
}

TEST_F(SweepRun, PairsRunsOfTheSameScenarioSeedAndSetting) {
  const Results results = run_and_write(plan, folder("out"));
  ASSERT_EQ(results.pairings.size(), 2U);  // a setting each
  EXPECT_EQ(plan.arms()[results.pairings[1].arm].label, "original, v_max=0.5");
  EXPECT_EQ(plan.arms()[results.pairings[1].baseline].label, "go_to_goal, v_max=0.5");
  EXPECT_EQ(results.pairings[0].reached.pairs, 6U);
  EXPECT_EQ(results.pairings[0].time.pairs, 6U);
  EXPECT_EQ(results.pairings[0].time.signed_rank.pairs, 2U);  // scenarios
  EXPECT_GE(results.pairings[0].time.p_holm, results.pairings[0].time.p());
}

TEST_F(SweepRun, TheReportOfManyScenariosHasNoTableByScenario) {
  json source = short_document();
  source["scenarios"] = {{{"random_layouts", {{"count", 150}}}}};
  const auto report = [](const Plan& each) {
    return to_markdown(each, results_of(each, Rows(each.size())));
  };
  EXPECT_THAT(report(short_plan(source)), Not(HasSubstr("## By scenario")));
  EXPECT_THAT(report(plan), HasSubstr("## By scenario"));
}

TEST_F(SweepRun, TheRunsAreWrittenInBlocksAsOneTable) {
  json source = short_document();
  source["repeats"] = 300;  // 2400 runs
  const Plan many = short_plan(source);
  Rows rows(many.size());
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    rows.set(i, experiment::Row{.outcome = algo::Outcome::Failed, .reason = "No, \"it\" broke."});
  }
  make_folder(folder("out"));
  write_report(many, rows, results_of(many, rows), folder("out"));
  EXPECT_EQ(read_text(folder("out") / "runs.csv"), to_csv(runs_table(many, rows)));
}

TEST_F(SweepRun, SaysWhichControllerAndScenarioDoNotGoTogether) {
  json source = short_document();
  source["scenarios"][0]["obstacles"][0]["x"] = 0;
  source["scenarios"][0]["obstacles"][0]["y"] = 0;
  EXPECT_THAT([&] { short_plan(source).check(); },
              ThrowsMessage<DocumentError>(StartsWith("scenarios: 'post': ")));
  EXPECT_NO_THROW(plan.check());
}

TEST_F(SweepRun, EstimatesFromTheFirstSeconds) {
  const Estimate cost = estimate(plan);
  EXPECT_GT(cost.cpu_time, 0);
  EXPECT_GT(cost.bytes, 24 * 500.0);
  EXPECT_LT(cost.bytes, 24 * 5000.0);
}

TEST_F(SweepRun, AnEstimateMeasuresAControllerOnceAndEndsInTime) {
  json slow = short_document();
  slow.erase("sweep");
  slow.erase("comparisons");
  slow["physics"] = "bullet";
  slow["controllers"] = {"original", "go_to_goal"};
  for (int i = 0; i < 20; ++i) {
    slow["controllers"].push_back({{"name", "strip"}, {"label", "strip " + std::to_string(i)}});
  }
  const Plan many = short_plan(slow);
  const auto time_of = [&](const EstimateOptions& options, Estimate& cost) {
    const auto begin = std::chrono::steady_clock::now();
    cost = estimate(many, options);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  Estimate whole;
  Estimate cut;
  const double long_time = time_of({.most_time = 1000}, whole);
  EXPECT_FALSE(whole.extrapolated);
  EXPECT_LT(time_of({.most_time = 0.01}, cut), long_time);
  EXPECT_TRUE(cut.extrapolated);
  EXPECT_GT(cut.cpu_time, 0);
  EXPECT_GT(cut.bytes, 0);
  std::stop_source stop;
  stop.request_stop();
  Estimate none;
  EXPECT_LT(time_of({.most_time = 1000, .stop = stop.get_token()}, none), long_time);
}

TEST_F(SweepRun, RunsWhoseRecordIsIncompleteFailAndAreMadeAgain) {
  make_folder(folder("whole"));
  make_folder(folder("out"));
  std::uint64_t bytes = 0;  // of all records
  {
    Recorder recorder((folder("whole") / "runs.db").string());
    run_sweep(plan, folder("whole"), {.threads = 1}, Wanted::Missing, {}, {&recorder, false});
    bytes = recorder.ask([](db::RunStore& store) { return store.used_bytes(); });
  }
  const std::string store = (folder("out") / "runs.db").string();
  std::size_t failed = 0;
  {
    Recorder recorder(store,
                      {.retention_bytes = bytes * 2 / 3,
                       .wait_for_room = false,
                       .when_full = "Make room.",
                       .commit_interval = std::chrono::milliseconds(5)});
    const Rows rows =
        run_sweep(plan, folder("out"), {.threads = 1}, Wanted::Missing, {}, {&recorder, false});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!rows.broken(i)) continue;
      EXPECT_THAT(rows.reason(i), HasSubstr("record"));
      EXPECT_THAT(rows.reason(i), testing::EndsWith("Make room."));
      ++failed;
    }
    EXPECT_GT(failed, 0U);
    EXPECT_LT(failed, rows.size());
    EXPECT_EQ(results_of(plan, rows).failed, failed);
  }
  std::size_t made = 0;
  {
    Recorder recorder(store);
    const Rows rows =
        run_sweep(plan,
                  folder("out"),
                  {.threads = 1, .progress = [&](std::size_t, std::size_t all) { made = all; }},
                  Wanted::Missing,
                  {},
                  {&recorder, false});
    EXPECT_TRUE(results_of(plan, rows).complete());
  }
  EXPECT_EQ(made, failed);
  std::set<std::string> whole;  // by scenario, controller, settings and seed
  db::RunReader reader(store);
  for (const db::RunRow& row : reader.list({}, 100).runs) {
    if (row.lost_ticks > 0 || row.ticks == 0) continue;
    whole.insert(row.what.scenario + row.what.controller + row.what.parameters +
                 std::to_string(row.what.seed));
  }
  EXPECT_EQ(whole.size(), plan.size());
}

TEST_F(SweepRun, StoresWholeRunsOfAllOrOfThoseThatDoNotReach) {
  json source = short_document();
  source.erase("sweep");
  source["repeats"] = 1;
  source["controllers"] = {"original", "go_to_goal"};
  // go_to_goal drives into the post, the original passes it.
  source["scenarios"] = {
      {{"name", "post"},
       {"goal", {{"x", 3}, {"y", 0}}},
       {"obstacles", {{{"type", "cylinder"}, {"x", 1.5}, {"y", 0.2}, {"radius", 0.1}}}}}};
  const Plan few = short_plan(source);
  for (const bool failures_only : {false, true}) {
    const fs::path out = folder(failures_only ? "failures" : "all");
    make_folder(out);
    {
      Recorder recorder((out / "runs.db").string());
      const Rows rows =
          run_sweep(few, out, {.threads = 2}, Wanted::Missing, {}, {&recorder, failures_only});
      ASSERT_EQ(rows.outcome(0), algo::Outcome::Reached);
      ASSERT_EQ(rows.outcome(1), algo::Outcome::Collided);
    }
    const std::vector<std::string> outcomes = outcomes_in(out / "runs.db");
    if (failures_only) {
      EXPECT_THAT(outcomes, testing::ElementsAre("collided"));
    } else {
      EXPECT_THAT(outcomes, testing::UnorderedElementsAre("reached", "collided"));
    }
  }
}

}  // namespace
}  // namespace server::sweep
