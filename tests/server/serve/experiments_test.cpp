// tests/server/serve/experiments_test.cpp: experiments of the server: the same numbers as from the
// command line, after any interruption; their turns and their ends.
#include "server/serve/experiments/experiments.hpp"

#include <chrono>
#include <functional>
#include <thread>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_results.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/text_file.hpp"
#include "server/serve/net/http.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// 1 m to the goal: some hundredths of a second a run.
json document(const char* name, int repeats, double goal_x = 1) {
  return {{"name", name},
          {"scenarios", {{{"name", "free"}, {"goal", {{"x", goal_x}, {"y", 0.2}}}}}},
          {"controllers", {"original", "go_to_goal"}},
          {"repeats", repeats},
          {"physics", "kinematic"},
          {"comparisons", {{"baseline", "go_to_goal"}}}};
}

/// Many minutes of CPU, so that it is running for as long as a test lasts; each run of it ends in
/// seconds.
json endless(const char* name) {
  json long_one = document(name, 1000, 500);
  long_one["time_limit"] = 300;
  return long_one;
}

bool comes(const std::function<bool()>& holds) {
  for (int i = 0; i < 2000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

bool comes_to(const Experiment& experiment, ExperimentState state) {
  return comes([&] { return experiment.info().state == state; });
}

class ExperimentsTest : public testing::Test {
 protected:
  fs::path folder() const { return root_.path() / "experiments"; }
  ExperimentRules rules() const { return {.folder = folder(), .workers = 2}; }
  const ScenarioLibrary library{"", ""};

 private:
  tests::TemporaryFolder root_{};
};

std::string results_in(const fs::path& folder) {
  std::string all;
  for (const char* const file : {"results.json", "runs.csv", "report.md", "report.tex"}) {
    all += read_text(folder / file);
  }
  return all;
}

/// The files that `tautline sweep` would write.
std::string expected(const json& source, const ScenarioLibrary& library, const fs::path& folder) {
  const sweep::Plan plan(sweep::document_from_json(source, library));
  const sweep::Rows rows = run_sweep(plan, folder, {.threads = 1});
  write_report(plan, rows, results_of(plan, rows), folder);
  return results_in(folder);
}

TEST_F(ExperimentsTest, GivesTheFilesOfTheCommandLine) {
  Experiments experiments(rules(), library);
  const auto posted = experiments.post(document("short", 4), "", "Ann");
  EXPECT_TRUE(posted.created);
  EXPECT_EQ(posted.experiment->info().by, "Ann");
  EXPECT_EQ(posted.experiment->info().runs, 8U);
  ASSERT_TRUE(comes_to(*posted.experiment, ExperimentState::Finished));
  EXPECT_EQ(posted.experiment->info().done, 8U);
  posted.experiment->write_report();
  EXPECT_EQ(results_in(posted.experiment->folder()),
            expected(document("short", 4), library, folder().parent_path() / "alone"));
  // The same document is the same experiment, which has nothing left to do.
  const auto again = experiments.post(document("short", 4), "", "Bob");
  EXPECT_FALSE(again.created);
  EXPECT_EQ(again.experiment, posted.experiment);
  EXPECT_EQ(again.experiment->info().state, ExperimentState::Finished);
}

TEST_F(ExperimentsTest, GoesOnAfterTheEndOfTheServer) {
  const json source = document("cut", 30);
  std::string id;
  {
    Experiments experiments(rules(), library);
    const auto posted = experiments.post(source, "", "");
    id = posted.experiment->info().id;
    ASSERT_TRUE(comes([&] { return posted.experiment->info().done >= 5; }));
  }
  Experiments experiments(rules(), library);
  const std::shared_ptr<Experiment> experiment = experiments.find(id);
  EXPECT_EQ(experiment->info().state, ExperimentState::Interrupted);
  EXPECT_EQ(experiment->info().name, "cut");
  experiments.resume(id);
  EXPECT_GE(experiment->info().done, 5U);
  ASSERT_TRUE(comes_to(*experiment, ExperimentState::Finished));
  experiment->write_report();
  EXPECT_EQ(results_in(experiment->folder()),
            expected(source, library, folder().parent_path() / "alone"));
}

TEST_F(ExperimentsTest, ItsCopiesOutliveTheRobotsAndScenariosOfTheUser) {
  const fs::path user = folder().parent_path() / "user";
  make_folder(user);
  json robot = robot_document(builtin_robot("jackal"));
  robot["name"] = "carrier";
  write_text(user / "carrier.json", robot.dump());
  write_text(user / "mine.json", R"({"name":"mine","robot":"carrier","goal":{"x":1,"y":0}})");
  const ScenarioLibrary own(user, "", RobotLibrary(user));
  json source = document("copied", 2);
  source["scenarios"][0]["robot"] = "carrier";
  source["scenarios"].push_back("mine");
  source["time_factor"] = 2;
  std::string id;
  {
    Experiments experiments(rules(), own);
    id = experiments.post(source, "", "").experiment->info().id;
    ASSERT_TRUE(comes_to(*experiments.find(id), ExperimentState::Finished));
  }
  for (const bool gone : {false, true}) {
    robot["mass"] = 18;
    write_text(user / "carrier.json", robot.dump());
    write_text(user / "mine.json", R"({"name":"mine","goal":{"x":2,"y":0}})");
    if (gone) fs::remove_all(user);
    Experiments experiments(rules(), own);
    EXPECT_EQ(experiments.find(id)->write_report().results->at("runs"), 8) << gone;
    experiments.resume(id);
    EXPECT_EQ(experiments.find(id)->info().state, ExperimentState::Finished) << gone;
  }
}

TEST_F(ExperimentsTest, ARunUnderWayAtTwoDeathsOfTheServerFailsAndTheOthersFinish) {
  std::string id;
  {
    Experiments experiments(rules(), library);
    id = experiments.post(document("deadly", 4), "", "").experiment->info().id;
    ASSERT_TRUE(comes_to(*experiments.find(id), ExperimentState::Finished));
  }
  // As if it had died twice, with the runs 2 and 5, and then with the run 5 alone.
  const fs::path log = folder() / id / "runs.jsonl";
  const std::string text = read_text(log);
  write_text(log,
             text.substr(0, text.find('\n') + 1) + "{\"begun\":2}\n{\"begun\":5}\n{\"begun\":5}\n");
  Experiments experiments(rules(), library);
  const std::shared_ptr<Experiment> experiment = experiments.find(id);
  experiments.resume(id);
  ASSERT_TRUE(comes_to(*experiment, ExperimentState::Finished));
  EXPECT_EQ(experiment->info().done, 8U);
  EXPECT_EQ(experiment->info().failed, 1U);
  experiment->look([](const sweep::Plan&, const sweep::Rows& rows) {
    EXPECT_THAT(rows.reason(5), HasSubstr("killed the program twice"));
    EXPECT_FALSE(rows.broken(2));
  });
  experiments.resume(id);  // has nothing to make
  EXPECT_EQ(experiment->info().failed, 1U);
}

TEST_F(ExperimentsTest, ARunThatMayHaveKilledTheServerWaitsUntilItIsAlone) {
  const sweep::Plan plan(sweep::document_from_json(document("alone", 1), library));
  ExperimentInfo info{.id = "alone", .name = "alone"};
  const fs::path own = folder() / "alone";
  make_folder(own);
  sweep::open_log(plan, own);
  write_text(own / "runs.jsonl", read_text(own / "runs.jsonl") + "{\"begun\":1}\n");
  Experiment experiment(own, plan, info);
  EXPECT_TRUE(experiment.next_is_alone());
  const auto first = experiment.next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->run, 1U);
  EXPECT_TRUE(first->alone);
  EXPECT_FALSE(experiment.next_is_alone());
  experiment.put_back(1);  // stopped: it still may be the cause
  EXPECT_TRUE(experiment.next_is_alone());
  const auto again = experiment.next();
  experiment.take(again->run, run_one(*again->plan, again->run, {}));
  EXPECT_FALSE(experiment.next_is_alone());
  EXPECT_FALSE(experiment.next()->alone);
  experiment.put_back(0);
}

TEST_F(ExperimentsTest, PausesAndReportsTheRunsSoFar) {
  Experiments experiments(rules(), library);
  const auto posted = experiments.post(document("some", 1000), "", "");
  const std::shared_ptr<Experiment>& experiment = posted.experiment;
  const std::string id = experiment->info().id;
  ASSERT_TRUE(comes([&] { return experiment->info().done >= 3; }));
  experiments.pause(id);
  EXPECT_THROW(experiments.pause(id), net::HttpError);
  ASSERT_TRUE(comes([&] { return !experiment->at_work(); }));
  const std::size_t done = experiment->info().done;
  ASSERT_LT(done, 2000U);
  experiment->write_report();
  EXPECT_THAT(read_text(experiment->folder() / "report.md"), HasSubstr("INCOMPLETE: of 2000 runs"));
  EXPECT_EQ(experiment->info().done, done);
  experiments.cancel(id);
  EXPECT_EQ(experiment->info().state, ExperimentState::Cancelled);
  EXPECT_THROW(experiments.cancel(id), net::HttpError);
  experiments.resume(id);
  EXPECT_TRUE(comes([&] { return experiment->info().done > done; }));
}

TEST_F(ExperimentsTest, IsReadWhileItsMemoryIsGivenBack) {
  Experiments experiments(rules(), library);
  const auto posted = experiments.post(document("read", 2), "", "");
  Experiment& experiment = *posted.experiment;
  ASSERT_TRUE(comes_to(experiment, ExperimentState::Finished));
  ASSERT_TRUE(comes([&] { return !experiment.at_work(); }));
  const std::jthread giver([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      experiment.unload();
      std::this_thread::sleep_for(std::chrono::microseconds(20));  // so that reads come between
    }
  });
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(experiment.plan()->size(), 4U);
    experiment.look(
        [](const sweep::Plan&, const sweep::Rows& rows) { EXPECT_EQ(rows.size(), 4U); });
    EXPECT_EQ(experiment.write_report().results->at("runs"), 4);
  }
}

TEST_F(ExperimentsTest, AShortOneNeedNotWaitForALongOne) {
  Experiments experiments({.folder = folder(), .workers = 1}, library);
  json many = document("many", 10'000, 2);
  const auto first = experiments.post(many, "", "");
  const auto second = experiments.post(document("few", 3), "", "");
  ASSERT_TRUE(comes_to(*second.experiment, ExperimentState::Finished));
  EXPECT_EQ(first.experiment->info().state, ExperimentState::Running);
  EXPECT_LT(first.experiment->info().done, 20'000U);
}

TEST_F(ExperimentsTest, ADeletedOneTakesItsFilesWithItWhenItsRunsHaveEnded) {
  std::string id;
  {
    Experiments experiments(rules(), library);
    id = experiments.post(endless("endless"), "", "").experiment->info().id;
    ASSERT_TRUE(comes([&] { return experiments.find(id)->at_work(); }));
    experiments.remove(id);
    EXPECT_THROW(experiments.find(id), net::HttpError);
    EXPECT_TRUE(experiments.list().empty());
  }
  EXPECT_FALSE(fs::exists(folder() / id));
}

/// One run that would take hours.
json everlasting(const char* name) {
  json forever = document(name, 1, 9000);
  forever["controllers"] = {"go_to_goal"};
  forever.erase("comparisons");
  forever["physics"] = "bullet";
  forever["time_limit"] = 1e6;
  return forever;
}

TEST_F(ExperimentsTest, ADeletedOneLeavesItsWorkerToTheOthersAndItsPlaceToANewOne) {
  Experiments experiments({.folder = folder(), .workers = 1}, library);
  const std::string id = experiments.post(everlasting("forever"), "", "").experiment->info().id;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(comes([&] { return experiments.find(id)->at_work(); }));
    experiments.remove(id);
    EXPECT_TRUE(experiments.post(everlasting("forever"), "", "").created);
  }
  experiments.remove(id);
  const auto next = experiments.post(document("next", 2), "", "");
  EXPECT_TRUE(comes_to(*next.experiment, ExperimentState::Finished));
}

TEST_F(ExperimentsTest, ACancelledOneStopsItsRunWhichIsMadeAgainWhenResumed) {
  Experiments experiments({.folder = folder(), .workers = 1}, library);
  const std::shared_ptr<Experiment> forever =
      experiments.post(everlasting("forever"), "", "").experiment;
  const std::string id = forever->info().id;
  ASSERT_TRUE(comes([&] { return forever->at_work(); }));
  experiments.cancel(id);
  ASSERT_TRUE(comes([&] { return !forever->at_work(); }));
  EXPECT_EQ(forever->info().state, ExperimentState::Cancelled);
  EXPECT_EQ(forever->info().done, 0U);
  experiments.resume(id);
  EXPECT_TRUE(comes([&] { return forever->at_work(); }));
  EXPECT_EQ(forever->info().state, ExperimentState::Running);
}

TEST_F(ExperimentsTest, OnesThatCannotWriteStillEndAreReadAndGo) {
  Experiments experiments({.folder = folder(), .workers = 1}, library);
  const std::shared_ptr<Experiment> forever =
      experiments.post(everlasting("forever"), "", "").experiment;
  const std::string id = forever->info().id;
  ASSERT_TRUE(comes([&] { return forever->at_work(); }));
  // As on a full disk, for a user whom no permission stops.
  fs::create_directory(forever->folder() / "state.json.new");
  fs::create_directory(forever->folder() / "runs.csv");
  const Experiment::Report report = forever->write_report();
  EXPECT_EQ(report.results->at("runs"), 1);
  EXPECT_EQ(report.problem, "runs.csv: cannot be written");
  experiments.cancel(id);
  EXPECT_EQ(forever->info().state, ExperimentState::Cancelled);
  EXPECT_EQ(forever->info().problem, "state.json.new: cannot be written: Is a directory");
  ASSERT_TRUE(comes([&] { return !forever->at_work(); }));
  experiments.resume(id);
  ASSERT_TRUE(comes([&] { return forever->at_work(); }));
  experiments.remove(id);
  EXPECT_TRUE(comes([&] { return !fs::exists(forever->folder()); }));
}

TEST_F(ExperimentsTest, ANewOneThatCannotBeWrittenIsRefused) {
  write_text(folder().parent_path() / "file", "no folder");
  Experiments experiments({.folder = folder().parent_path() / "file", .workers = 1}, library);
  EXPECT_THROW(experiments.post(document("new", 1), "", ""), net::HttpError);
  EXPECT_TRUE(experiments.list().empty());
}

/// So many worlds, each with many robots, which take long to make.
json crowded(const char* name, int worlds, int robots) {
  json crowd = document(name, 1);
  const json one = crowd["scenarios"][0];
  crowd["scenarios"] = json::array();
  for (int i = 0; i < worlds; ++i) {
    json& world = crowd["scenarios"].emplace_back(one);
    world["name"] = "crowd-" + std::to_string(i);
    for (int k = 0; k < robots; ++k) {
      world["robots"].push_back({{"start", {{"x", 2 * (k % 14)}, {"y", 3 + 2 * (k / 14)}}}});
    }
  }
  crowd["physics"] = "bullet";
  return crowd;
}

TEST_F(ExperimentsTest, TheCheckOfManyWorldsEndsWithTheServer) {
  Experiments experiments(rules(), library);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(experiments.post(crowded("crowd", 400, 150), "", "", stop.get_token()),
               net::HttpError);
  EXPECT_TRUE(experiments.list().empty());
}

TEST_F(ExperimentsTest, RunningOnesHaveALimitedNumberOfWorlds) {
  ExperimentRules few = rules();
  few.most_worlds = 5;
  Experiments experiments(few, library);
  json three = endless("three");
  three["scenarios"] = {{{"random_layouts", {{"count", 3}}}}};
  const std::string id = experiments.post(three, "", "").experiment->info().id;
  json other = three;
  other["name"] = "other";
  EXPECT_THAT([&] { experiments.post(other, "", ""); },
              ThrowsMessage<net::HttpError>(HasSubstr("would have 6 worlds; at most 5")));
  experiments.pause(id);
  experiments.post(other, "", "");
  EXPECT_THAT([&] { experiments.resume(id); },
              ThrowsMessage<net::HttpError>(HasSubstr("6 worlds")));
  json many = three;
  many["scenarios"] = {{{"random_layouts", {{"count", 9000}}}},
                       {{"random_layouts", {{"count", 1001}}}}};
  EXPECT_THAT([&] { experiments.post(many, "", ""); },
              ThrowsMessage<DocumentError>(HasSubstr("scenarios: are 10001; a server takes")));
}

TEST_F(ExperimentsTest, OneEstimateIsMadeAtATimeAndEndsWithTheServer) {
  Experiments experiments(rules(), library);
  json slow = everlasting("slow");
  for (int i = 0; i < 40; ++i) {
    slow["scenarios"][0]["obstacles"].push_back(
        {{"type", "cylinder"}, {"x", 3}, {"y", i}, {"radius", 0.1}});
  }
  std::stop_source stop;
  std::thread first([&] {
    for (bool made = false; !made;) {
      try {
        experiments.estimate(slow, stop.get_token());
        made = true;
      } catch (const net::HttpError&) {  // the other one's turn
      }
    }
  });
  bool refused = false;
  for (int i = 0; i < 2000 && !refused; ++i) {
    try {
      experiments.estimate(document("other", 1), {});
    } catch (const net::HttpError& e) {
      refused = e.status() == 429;
    }
  }
  EXPECT_TRUE(refused);
  stop.request_stop();
  first.join();
  EXPECT_EQ(experiments.estimate(document("other", 1), {}).first.size(), 2U);
}

TEST_F(ExperimentsTest, AKeyBelongsToOneDocument) {
  Experiments experiments(rules(), library);
  const auto posted = experiments.post(document("a", 1), "key", "");
  EXPECT_EQ(experiments.post(document("a", 1), "key", "").experiment, posted.experiment);
  EXPECT_THAT([&] { experiments.post(document("b", 1), "key", ""); },
              ThrowsMessage<net::HttpError>(HasSubstr("another document has this key")));
}

TEST_F(ExperimentsTest, ADocumentMayNotNameAFileOfTheServer) {
  Experiments experiments(rules(), library);
  json source = document("files", 1);
  source["scenarios"] = {{{"barn", {{"worlds", "/etc/passwd"}}}}};
  EXPECT_THAT([&] { experiments.post(source, "", ""); },
              ThrowsMessage<DocumentError>(
                  testing::StartsWith("scenarios/0/barn/worlds: is a file, which only")));
  EXPECT_TRUE(experiments.list().empty());
}

TEST_F(ExperimentsTest, AsManyRunAsMayAndAsManyAreKept) {
  ExperimentRules few = rules();
  few.most_running = 1;
  few.most_kept = 2;
  Experiments experiments(few, library);
  const auto first = experiments.post(endless("first"), "", "");
  EXPECT_THAT([&] { experiments.post(document("second", 1), "", ""); },
              ThrowsMessage<net::HttpError>(HasSubstr("1 experiments are running")));
  experiments.pause(first.experiment->info().id);
  const auto second = experiments.post(document("second", 1), "", "");
  ASSERT_TRUE(comes_to(*second.experiment, ExperimentState::Finished));
  EXPECT_THAT([&] { experiments.post(document("third", 1), "", ""); },
              ThrowsMessage<net::HttpError>(HasSubstr("2 experiments are kept, as many as may.")));
}

TEST_F(ExperimentsTest, TheOldestFinishedOnesMakeRoomIfTheyMay) {
  ExperimentRules small = rules();
  small.keep_bytes = 1;
  Experiments experiments(small, library);
  const auto first = experiments.post(document("first", 1), "", "");
  ASSERT_TRUE(comes_to(*first.experiment, ExperimentState::Finished));
  EXPECT_THAT([&] { experiments.post(document("second", 1), "", ""); },
              ThrowsMessage<net::HttpError>(HasSubstr("that --keep gives them. Delete one.")));
  small.evict_oldest = true;
  small.keep_bytes = 0;
  small.most_kept = 2;
  small.folder = folder() / "other";
  Experiments others(small, library);
  const auto oldest = others.post(document("oldest", 1), "", "");
  ASSERT_TRUE(comes_to(*oldest.experiment, ExperimentState::Finished));
  const auto running = others.post(endless("running"), "", "");
  others.post(document("newest", 1), "", "");
  EXPECT_FALSE(fs::exists(oldest.experiment->folder()));
  EXPECT_EQ(others.list().size(), 2U);
  EXPECT_TRUE(fs::exists(running.experiment->folder()));
  others.cancel(running.experiment->info().id);
  others.post(document("after", 1), "", "");
  EXPECT_TRUE(comes([&] { return !fs::exists(running.experiment->folder()); }))
      << "a cancelled one is not kept for ever";
}

TEST_F(ExperimentsTest, FilesThatCannotBeReadAreNamedAndLeftAlone) {
  std::string id;
  {
    Experiments experiments(rules(), library);
    const auto posted = experiments.post(document("torn", 2), "", "");
    id = posted.experiment->info().id;
    ASSERT_TRUE(comes_to(*posted.experiment, ExperimentState::Finished));
  }
  write_text(folder() / id / "runs.jsonl", "nonsense\n");
  fs::create_directory(folder() / "empty");
  Experiments experiments(rules(), library);
  ASSERT_EQ(experiments.list().size(), 1U);
  EXPECT_EQ(experiments.list()[0].done, 4U);
  EXPECT_THAT([&] { experiments.find(id)->plan(); },
              ThrowsMessage<net::HttpError>(HasSubstr("runs.jsonl")));
  EXPECT_EQ(read_text(folder() / id / "runs.jsonl"), "nonsense\n");
  write_text(folder() / id / "runs.jsonl",
             R"({"sweep":"0","identity":{"tautline":"0.0.1"}})"
             "\n");
  Experiments others(rules(), library);
  EXPECT_THAT([&] { others.find(id)->plan(); },
              ThrowsMessage<net::HttpError>(testing::AllOf(HasSubstr("another experiment"),
                                                           testing::Not(HasSubstr("--out")))));
}

}  // namespace
}  // namespace server
