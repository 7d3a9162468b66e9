// tests/server/serve/app_runs_test.cpp: the list of runs over REST: search, order, groups, remarks,
// deletion with undo, and the verdict of a live run.
#include <string>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include <gmock/gmock.h>

namespace server {
namespace {

using net::test::Answer;
using net::test::eventually;
using testing::ElementsAre;
using testing::IsEmpty;

class AppRuns : public AppTest {
 protected:
  /// Numbers of background runs, which have ended.
  std::vector<std::int64_t> run(const json& experiment) {
    const Answer accepted = ask("POST", "/runs", experiment.dump());
    EXPECT_EQ(accepted.status, 202) << accepted.body;
    const std::vector<std::int64_t> runs = json::parse(accepted.body)["runs"];
    for (const std::int64_t id : runs) EXPECT_TRUE(comes_to(id, "finished"));
    return runs;
  }
  std::vector<std::int64_t> ids(const std::string& query) const {
    std::vector<std::int64_t> found;
    const json list = get("/runs?" + query);
    for (const json& item : list["items"]) found.push_back(item["id"]);
    return found;
  }
  json change(const std::string& path, const json& body) const {
    const Answer answer = ask("POST", path, body.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body, nullptr, false);
  }
};

const json kCase1 = {{"scenario", "case1"}, {"physics", "kinematic"}};

TEST_F(AppRuns, FindsSortsAndGroups) {
  json batch = kCase1;
  batch["repeats"] = 2;
  batch["seed"] = 7;
  const auto pair = run(batch);
  json original = kCase1;
  original["controller"] = "original";
  const auto alone = run(original);
  EXPECT_THAT(ids("kind=background&q=original%20CASE1"), ElementsAre(alone[0]));
  EXPECT_THAT(ids("kind=background&seed=8"), ElementsAre(pair[1]));
  EXPECT_THAT(ids("kind=background&sort=seed&order=asc&q=modified"), ElementsAre(pair[0], pair[1]));
  EXPECT_THAT(ids("q=nowhere"), IsEmpty());
  const json row = get("/runs/" + std::to_string(pair[1]));
  EXPECT_EQ(row["batch"], pair[0]);
  EXPECT_EQ(row["kind"], "background");
  EXPECT_EQ(row["later"], nullptr);
  EXPECT_EQ(row["time"], row["metrics"]["time"]);
  EXPECT_EQ(get("/runs/" + std::to_string(alone[0]))["batch"], nullptr);
  const json lines = get("/runs?kind=background&group=batch");
  ASSERT_EQ(lines["items"].size(), 2u);
  EXPECT_EQ(lines["total"], 2);
  EXPECT_EQ(lines["items"][1]["group"]["runs"], 2);
  EXPECT_EQ(lines["items"][1]["group"]["first"], pair[0]);
  EXPECT_EQ(lines["results"][row["result"].get<std::string>()].get<int>() >= 2, true);
  // A page at a time, over figures.
  const json first = get("/runs?kind=background&sort=time&limit=2");
  const std::string next = first["next"];
  const json second = get("/runs?kind=background&sort=time&limit=2&cursor=" + next);
  EXPECT_EQ(second["items"].size(), 1u);
  EXPECT_LE(second["items"][0]["time"].get<double>(), first["items"][1]["time"].get<double>());
}

TEST_F(AppRuns, RefusesQueriesItDoesNotKnow) {
  expect_problem(ask("GET", "/runs?colour=red"), 400, "does not know the query 'colour'");
  expect_problem(ask("GET", "/runs?colour=red"), 400, "controller, outcome, status");
  expect_problem(ask("GET", "/catalog?a=1"), 400, "it takes none");
  expect_problem(ask("POST", "/runs?scenario=case1", "{}"), 400, "'scenario'");
  expect_problem(ask("GET", "/runs?sort=colour"), 422, "'colour' is unknown");
  expect_problem(ask("GET", "/runs?order=up"), 422, "asc, desc");
  expect_problem(ask("GET", "/runs?kind=live"), 422, "session, background");
  expect_problem(ask("GET", "/runs?group=day"), 422, "known are batch");
  expect_problem(ask("GET", "/runs?sort=time&cursor=5"), 422, "no cursor");
  EXPECT_EQ(ask("GET", "/scenarios?limit=200").status, 200);
}

TEST_F(AppRuns, KeepsWhatPeopleWriteOnARun) {
  const auto one = run(kCase1)[0];
  const std::string path = "/runs/" + std::to_string(one);
  const Answer answer =
      ask("PATCH", path, R"({"label":"Wet floor","note":"Left wheel","tags":["wet","slow"]})");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(json::parse(answer.body)["label"], "Wet floor");
  EXPECT_EQ(ask("PATCH", path, R"({"label":"Dry floor"})").status, 200);
  const json row = get(path);
  EXPECT_EQ(row["label"], "Dry floor");
  EXPECT_EQ(row["note"], "Left wheel");
  EXPECT_EQ(row["tags"], json({"wet", "slow"}));
  change("/runs/tag", {{"ids", {one}}, {"add", {"oil"}}, {"remove", {"wet"}}});
  EXPECT_EQ(get(path)["tags"], json({"slow", "oil"}));
  EXPECT_THAT(ids("tag=oil"), ElementsAre(one));
  EXPECT_THAT(ids("q=left%20dry"), ElementsAre(one));
  expect_problem(ask("PATCH", "/runs/4711", R"({"label":"x"})"), 404, "no run 4711");
  expect_problem(ask("PATCH", path, R"({"tags":["a,b"]})"), 422, "tags/0");
  expect_problem(ask("PATCH", path, R"({"colour":"red"})"), 422, "unknown field 'colour'");
}

TEST_F(AppRuns, DeletesManyAndBringsThemBack) {
  json batch = kCase1;
  batch["repeats"] = 2;
  const auto pair = run(batch);
  const json gone = change("/runs/delete", {{"batches", {pair[0]}}, {"ids", {4711}}});
  EXPECT_EQ(gone["runs"], json(pair));
  EXPECT_EQ(gone["refused"][0]["id"], 4711);
  EXPECT_THAT(ids("kind=background"), IsEmpty());
  expect_problem(ask("GET", "/runs/" + std::to_string(pair[0])), 404, "no run");
  expect_problem(ask("GET", "/runs/" + std::to_string(pair[0]) + "/frames"), 404, "no run");
  const json back = change("/runs/restore", {{"ids", pair}});
  EXPECT_EQ(back["runs"], json(pair));
  EXPECT_THAT(ids("kind=background"), ElementsAre(pair[1], pair[0]));
  EXPECT_EQ(change("/runs/restore", {{"ids", pair}})["refused"].size(), 2u);
  const std::int64_t live = get("/session")["run"]["id"];
  EXPECT_EQ(change("/runs/delete", {{"ids", {live}}})["refused"][0]["why"],
            "Cancel or end the run first.");
  expect_problem(ask("POST", "/runs/delete", "{}"), 422, "at least one run");
  expect_problem(ask("POST", "/runs/delete", R"({"ids":["a"]})"), 422, "ids/0");
}

TEST_F(AppRuns, CancelsManyAtOnce) {
  json batch = kCase1;
  batch["repeats"] = 500;
  batch["pace"] = 1;
  const Answer accepted = ask("POST", "/runs", batch.dump());
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::vector<std::int64_t> runs = json::parse(accepted.body)["runs"];
  const json answer = change("/runs/cancel", {{"batches", {runs[0]}}});
  EXPECT_EQ(answer["runs"].size(), 500u);
  EXPECT_TRUE(eventually([&] { return get("/runs?result=cancelled&limit=1")["total"] == 500; }));
}

TEST_F(AppRuns, ALiveRunKeepsItsFirstOutcomeAndItsTime) {
  const std::int64_t live = get("/session")["run"]["id"];
  const std::string path = "/runs/" + std::to_string(live);
  const auto outcome = [&] { return get("/session")["run"]["outcome"].get<std::string>(); };
  EXPECT_EQ(post("/session/control", {{"action", "speed"}, {"speed", 20}}), 200);
  const json pose = get("/session")["pose"];
  const json near = {{"x", pose["x"].get<double>() + 0.4}, {"y", pose["y"]}};
  ASSERT_EQ(ask("PUT", "/session/goal", near.dump()).status, 200);
  ASSERT_TRUE(eventually([&] { return outcome() == "reached"; }));
  ASSERT_TRUE(eventually([&] { return get(path)["outcome"] == "reached"; }));
  const double reached = get(path)["time"];
  ASSERT_EQ(ask("PUT", "/session/goal", R"({"x":3.0,"y":4.0})").status, 200);
  ASSERT_TRUE(eventually([&] { return get(path)["later"].is_object(); }));
  EXPECT_EQ(get(path)["later"]["outcome"], "running");
  EXPECT_EQ(get(path)["outcome"], "reached");
  ASSERT_TRUE(eventually([&] { return get(path)["end_time"].get<double>() > reached + 5; }));
  EXPECT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  ASSERT_TRUE(comes_to(live, "finished"));
  const json row = get(path);
  EXPECT_EQ(row["kind"], "session");
  EXPECT_EQ(row["result"], "reached");
  EXPECT_EQ(row["time"], reached);
  EXPECT_EQ(row["metrics"]["outcome"], "reached");
  EXPECT_EQ(row["later"]["outcome"], "stopped");
  EXPECT_GT(row["later"]["time"].get<double>(), reached + 5);
}

}  // namespace
}  // namespace server
