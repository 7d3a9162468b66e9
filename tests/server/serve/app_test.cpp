// tests/server/serve/app_test.cpp: the program from outside: API description, scenarios, session,
// runs.
#include "server/serve/app.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/frame_codec.hpp"
#include "server/serve/api/api.hpp"

namespace server {
namespace {

using net::test::Answer;
using net::test::eventually;

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
    return static_cast<char>(std::toupper(c));
  });
  return text;
}

/// Follows `$ref` and demands every required key, in the items of a list too.
void expect_required(const json& api, json schema, const json& sample, const std::string& where) {
  if (schema.contains("$ref")) {
    const std::string ref = schema["$ref"];
    schema = api.at(json::json_pointer(ref.substr(1)));
  }
  const json required = schema.value("required", json::array());
  for (const auto& key : required) {
    EXPECT_TRUE(sample.contains(key.get<std::string>())) << where << " lacks " << key;
  }
  if (schema.contains("items") && sample.is_array()) {
    for (const json& item : sample) expect_required(api, schema["items"], item, where + "[]");
  }
  const json properties = schema.value("properties", json::object());
  for (const auto& [key, part] : properties.items()) {
    if (sample.is_object() && sample.contains(key) && !sample[key].is_null()) {
      expect_required(api, part, sample[key], where + "/" + key);
    }
  }
}

/// Splits a page of messages: each is a u32 little-endian length and its bytes.
std::vector<std::span<const std::byte>> messages_of(const std::string& body) {
  std::vector<std::span<const std::byte>> out;
  for (std::size_t offset = 0; offset < body.size(); offset += out.back().size()) {
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      size |= std::uint32_t{static_cast<unsigned char>(body.at(offset + i))} << (8 * i);
    }
    offset += 4;
    if (offset + size > body.size()) throw std::out_of_range("a message runs past its page");
    out.push_back(std::as_bytes(std::span(body).subspan(offset, size)));
  }
  return out;
}

std::vector<std::uint64_t> ticks_of(const std::string& body) {
  std::vector<std::uint64_t> ticks;
  algo::Telemetry t;
  for (const auto& frame : messages_of(body)) {
    decode_frame(frame, t);
    ticks.push_back(t.tick);
  }
  return ticks;
}

TEST_F(AppTest, TheDescriptionListsExactlyTheRoutes) {
  const json api = get("/openapi.json");
  std::multiset<std::string> described;
  for (const auto& [path, methods] : api.at("paths").items()) {
    for (const auto& [method, unused] : methods.items()) {
      described.insert(upper(method) + " " + path);
    }
  }
  const std::string database = (folder_ / "other.db").string();
  Recorder recorder(database);
  Workers workers(database);
  const ScenarioLibrary library({}, {});
  Experiments experiments({}, library);
  RunQueue queue(recorder);
  Scheduler scheduler;
  SessionRegistry sessions({.runs = {.scheduler = scheduler}, .workers = workers}, {});
  ApiContext context{.sessions = sessions,
                     .library = library,
                     .experiments = experiments,
                     .queue = queue,
                     .recorder = recorder,
                     .workers = workers,
                     .checker = workers};
  net::Server server({.port = 0});  // adds the login itself
  add_api(server.router(), context);
  std::multiset<std::string> routes;
  for (const auto& route : server.router().routes())
    routes.insert(route.method + " " + route.pattern);
  EXPECT_EQ(described, routes);
}

TEST_F(AppTest, EveryReadAnswersWithTheKeysItsSchemaRequires) {
  const Answer accepted = ask("POST", "/runs", R"({"scenario":"case1","vehicle":"kinematic"})");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::int64_t run = json::parse(accepted.body)["runs"][0];
  ASSERT_TRUE(comes_to(run, "finished"));
  const Answer posted = ask("POST",
                            "/experiments",
                            R"({"name":"one","scenarios":["case1"],"controllers":["strip"],)"
                            R"("physics":"kinematic","time_limit":1})");
  ASSERT_EQ(posted.status, 202) << posted.body;
  const std::string experiment = json::parse(posted.body)["id"];
  const json api = get("/openapi.json");
  int read = 0;
  for (const auto& [path, methods] : api.at("paths").items()) {
    if (!methods.contains("get")) continue;
    std::string target = path.substr(std::string("/api/v1").size());
    if (const auto at = target.find("{id}"); at != std::string::npos) {
      target.replace(
          at,
          4,
          path.find("/experiments/") != std::string::npos ? experiment : std::to_string(run));
    }
    if (const auto at = target.find("{file}"); at != std::string::npos) {
      const bool picture = path.find("/pictures/") != std::string::npos;
      target.replace(at, 6, picture ? "success.svg" : "results.json");
    }
    if (const auto at = target.find("{name}"); at != std::string::npos) {
      target.replace(at, 6, "case1");
    }
    if (const auto at = target.find("{session}"); at != std::string::npos) {
      target.replace(at, 9, "main");
    }
    if (target.ends_with("/map")) continue;  // this robot knows none: see MapTest
    if (target == "/view_link") continue;    // there is none where no token is asked for
    if (target.ends_with("/experiments/" + experiment + "/events"))
      continue;  // it does not end; the page's tests read it
    const Answer answer = ask("GET", target);
    EXPECT_EQ(answer.status, 200) << target;
    const json& content = methods["get"]["responses"]["200"]["content"];
    const std::string type = answer.headers.at("Content-Type");
    EXPECT_TRUE(content.contains(type.substr(0, type.find(';')))) << target << ' ' << type;
    ++read;
    if (!content.contains("application/json")) continue;
    const json sample = json::parse(answer.body, nullptr, false);
    ASSERT_FALSE(sample.is_discarded()) << target;
    expect_required(api, content["application/json"]["schema"], sample, target);
  }
  EXPECT_GE(read, 18);
}

TEST_F(AppTest, AThousandScenariosAreKeptAndOnesThatCannotBeWrittenAreNot) {
  const std::filesystem::path own = folder_ / "scenarios";
  std::filesystem::create_directories(own / "blocked.json.new");
  const std::string world = R"({"goal":{"x":1,"y":0}})";
  expect_problem(ask("PUT", "/scenarios/blocked", world), 503, "Cannot write blocked.json");
  for (int i = 0; i < 1000; ++i) std::ofstream(own / fmt::format("mine-{}.json", i)) << world;
  expect_problem(ask("PUT", "/scenarios/another", world), 503, "as many as may. Delete one.");
  EXPECT_EQ(ask("PUT", "/scenarios/mine-7", world).status, 200);
  EXPECT_EQ(ask("DELETE", "/scenarios/mine-8").status, 204);
  EXPECT_EQ(ask("PUT", "/scenarios/another", world).status, 200);
}

TEST_F(AppTest, TwelveMalformedScenariosAreRefusedByFieldAndNotKept) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"period":"fast"})", "period"},
      {R"({"obstacles":[{"type":"cylinder","x":3,"y":3,"radius":-1}]})", "obstacles/0: radius"},
      {R"({"goal":{"x":1}})", "goal/y: is missing"},
      {R"({"colour":"red"})", "unknown field 'colour'"},
      {R"({"vehicle":"hover"})", "vehicle"},
      {R"({"controller":"magic"})", "controller: 'magic' is unknown"},
      {R"({"lasers":[{"unit":"furlong"}]})", "lasers/0/unit"},
      {R"({"parameters":{"k_r":99}})", "k_r"},
      {R"({"obstacles":[{"id":1,"type":"cylinder","x":3,"y":3,"radius":1},)"
       R"({"id":1,"type":"cylinder","x":6,"y":3,"radius":1}]})",
       "obstacles/1/id: 1 is used twice"},
      {R"({"robot":"tank"})", "robot: 'tank' is unknown"},
      {R"({"robot":{"name":"tank"}})", "robot/hull: is missing"},
      {R"({"obstacles":[{"id":7,"type":"cylinder","x":0,"y":0.1,"radius":0.3}]})", "overlap"},
  };
  for (const auto& [body, word] : cases) {
    SCOPED_TRACE(body);
    expect_problem(ask("PUT", "/scenarios/x", body), 422, word);
    expect_problem(ask("GET", "/scenarios/x"), 404, "x");
  }
  expect_problem(ask("PUT", "/scenarios/x", R"({"name":"y"})"), 422, "name");
  expect_problem(ask("PUT", "/scenarios/Bad%20Name", R"({"goal":{"x":1,"y":1}})"), 422, "name");
  expect_problem(ask("PUT", "/scenarios/case1", R"({"goal":{"x":1,"y":1}})"), 409, "case1");
  const json kept = get("/scenarios");
  for (const json& item : kept["items"]) EXPECT_TRUE(item["builtin"]) << item;
}

TEST_F(AppTest, AGoodScenarioIsKeptReadRunAndDeleted) {
  const std::string body =
      R"({"title":"Short","vehicle":"kinematic","goal":{"x":1.5,"y":0},"obstacles":[)"
      R"({"type":"wall","from":[-2,2],"to":[4,2],"thickness":0.1}]})";
  const Answer put = ask("PUT", "/scenarios/x", body);
  ASSERT_EQ(put.status, 200) << put.body;
  const json kept = get("/scenarios/x");
  EXPECT_EQ(kept, json::parse(put.body));
  EXPECT_EQ(kept["goal"]["x"], 1.5);
  EXPECT_EQ(kept["obstacles"][0]["length"], 6.0);
  EXPECT_EQ(ask("PUT", "/scenarios/x", kept.dump()).status, 200);
  EXPECT_EQ(get("/scenarios/x"), kept);

  const Answer accepted = ask("POST", "/runs", R"({"scenario":"x"})");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::int64_t run = json::parse(accepted.body)["runs"][0];
  ASSERT_TRUE(comes_to(run, "finished"));
  EXPECT_EQ(get("/runs/" + std::to_string(run))["outcome"], "reached");

  EXPECT_EQ(ask("DELETE", "/scenarios/x").status, 204);
  expect_problem(ask("GET", "/scenarios/x"), 404, "x");
  expect_problem(ask("DELETE", "/scenarios/x"), 404, "x");
  expect_problem(ask("DELETE", "/scenarios/case1"), 409, "case1");
}

TEST_F(AppTest, EveryScenarioThatCanBeSavedCanBeLoaded) {
  // With every value written out, each is longer than a request may be.
  json many = {{"vehicle", "kinematic"}, {"goal", {{"x", 1.5}, {"y", 0}}}};
  for (int i = 0; i < 2000; ++i) {
    many["obstacles"].push_back(
        {{"type", "cylinder"}, {"x", 100 + i}, {"y", 100.25}, {"radius", 0.3}});
  }
  json large = {{"vehicle", "kinematic"}, {"goal", {{"x", 1.5}, {"y", 0}}}};
  for (int i = 0; i < 500; ++i) {
    large["obstacles"].push_back(
        {{"type", "wall"}, {"from", {100 + i, 50}}, {"to", {100 + i, 60}}});
    large["obstacles"].push_back(
        {{"type", "polygon"}, {"points", {{-50 - i, 9}, {-49 - i, 9}, {-49 - i, 9.5}}}});
  }
  large["description"] = std::string(4000, 'x');
  for (const json& world : {many, large}) {
    const Answer put = ask("PUT", "/scenarios/big", world.dump());
    ASSERT_EQ(put.status, 200) << put.body.substr(0, 300);
    EXPECT_EQ(get("/scenarios/big"), json::parse(put.body));
    EXPECT_EQ(post("/session/control", {{"action", "load"}, {"scenario", "big"}}), 200);
  }
}

TEST_F(AppTest, AScenarioWithWaypointsDrivesThroughThem) {
  const std::string body = R"({"name":"round","vehicle":"kinematic","goal":{"x":0.6,"y":1},)"
                           R"("waypoints":[{"x":0.6,"y":0},{"x":1.2,"y":0.5}],"time_limit":90})";
  const Answer accepted = ask("POST", "/runs", R"({"scenario":)" + body + "}");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::int64_t run = json::parse(accepted.body)["runs"][0];
  ASSERT_TRUE(comes_to(run, "finished"));
  const json row = get("/runs/" + std::to_string(run));
  EXPECT_EQ(row["outcome"], "reached");
  EXPECT_GT(row["metrics"]["path_length"], 1.7);  // 0.6 + 0.78 + 0.78, less the reach of each
}

TEST_F(AppTest, BothRunsOfAnExperimentReachAndAgree) {
  const Answer accepted =
      ask("POST", "/runs", R"({"scenario":"case1","vehicle":"kinematic","repeats":2,"seed":7})");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const json runs = json::parse(accepted.body)["runs"];
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(accepted.headers.at("Location"), "/api/v1/runs/" + runs[0].dump());
  std::uint64_t seed = 7;
  for (const json& id : runs) {
    ASSERT_TRUE(comes_to(id, "finished"));
    const std::string path = "/runs/" + id.dump();
    const json row = get(path);
    EXPECT_EQ(row["outcome"], "reached");
    EXPECT_EQ(row["seed"], seed++);
    EXPECT_EQ(row["lost_ticks"], 0);
    const json metrics = get(path + "/metrics");
    EXPECT_EQ(metrics, row["metrics"]);
    EXPECT_EQ(metrics["outcome"], "reached");
    EXPECT_FALSE(metrics["collided"]);
    EXPECT_GT(metrics["path_length"], 5.5);
    EXPECT_GT(metrics["min_clearance"], 0.0);
    EXPECT_EQ(metrics["ticks"], row["ticks"]);

    const json ticks = get(path + "/ticks?limit=10000")["items"];
    ASSERT_EQ(ticks.size(), row["ticks"].get<std::size_t>());
    std::istringstream csv(ask("GET", path + "/csv").body);
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line.substr(0, 4), "tick");
    std::size_t at = 0;
    for (; std::getline(csv, line); ++at) {
      ASSERT_LT(at, ticks.size());
      std::istringstream cells(line);
      std::string cell;
      for (const char* column : {"tick", "t", "x", "y", "heading"}) {
        std::getline(cells, cell, ',');
        ASSERT_EQ(std::stod(cell), ticks[at][column].get<double>()) << at << ' ' << column;
      }
    }
    EXPECT_EQ(at, ticks.size());
    const Answer with_units = ask("GET", path + "/csv?units=1");
    EXPECT_THAT(with_units.body, testing::StartsWith("tick,t [s],x [m],"));
    EXPECT_EQ(with_units.headers.at("Content-Disposition"),
              "attachment; filename=\"run-" + id.dump() + "-case1.csv\"");
    EXPECT_THAT(ask("GET", path + "/csv?arrays=1").body.substr(0, 2000),
                testing::HasSubstr(",scan[0].ranges,moved\n"));
    expect_problem(ask("GET", path + "/csv?units=2"), 422, "must be 0 or 1");

    std::size_t frames = 0;
    algo::Telemetry t;
    std::vector<std::uint64_t> changed{0};  // ticks with another mission, hold or contact
    algo::Telemetry before;
    for (std::string from = "0"; !from.empty();) {
      const Answer page = ask("GET", path + "/frames?limit=700&from=" + from);
      ASSERT_EQ(page.status, 200);
      for (const auto& frame : messages_of(page.body)) {
        decode_frame(frame, t);
        ASSERT_LT(frames, ticks.size());
        ASSERT_EQ(t.tick, ticks[frames]["tick"]);
        ASSERT_EQ(t.observation.odometry.pose.x, ticks[frames]["x"]);
        ASSERT_EQ(t.command.base.v, ticks[frames]["v"]);
        if (t.tick > 0 && (t.mission != before.mission || t.hold != before.hold ||
                           t.ground_truth->collided != before.ground_truth->collided)) {
          changed.push_back(t.tick);
        }
        before = t;
        ++frames;
      }
      const auto next = page.headers.find("X-Next-Tick");
      from = next == page.headers.end() ? "" : next->second;
    }
    EXPECT_EQ(frames, ticks.size());
    EXPECT_GT(changed.size(), 1u);
    EXPECT_EQ(ticks_of(ask("GET", path + "/events?limit=20000").body), changed);
    EXPECT_EQ(ticks_of(ask("GET", path + "/events?limit=1&from=1").body),
              std::vector<std::uint64_t>{1});
  }
}

TEST_F(AppTest, ABatchOfTenThousandIsQueuedWithOneDocument) {
  const Answer accepted = ask(
      "POST", "/runs", R"({"scenario":"case1","vehicle":"kinematic","repeats":10000,"pace":1})");
  ASSERT_EQ(accepted.status, 202) << accepted.body.substr(0, 200);
  const json runs = json::parse(accepted.body)["runs"];
  ASSERT_EQ(runs.size(), 10'000u);
  const json last = get("/runs/" + runs.back().dump());
  EXPECT_EQ(last["seed"], 10'000);
  EXPECT_EQ(last["document"]["scenario"]["name"], "case1");
  EXPECT_EQ(get("/runs?status=queued&limit=500")["items"].size(), 500u);
  // The live run's frames were stored in between: none was lost for lack of room.
  EXPECT_EQ(get("/session")["lost_ticks"], 0);
  // A second one fits into the queue; a third exceeds it.
  const std::string more = R"({"scenario":"case1","vehicle":"kinematic","repeats":10000})";
  EXPECT_EQ(ask("POST", "/runs", more).status, 202);
  expect_problem(ask("POST", "/runs", more), 503, "queued already");
}

TEST_F(AppTest, RunsAreCancelledDeletedAndThenGone) {
  const Answer accepted =
      ask("POST", "/runs", R"({"scenario":"case1","vehicle":"kinematic","repeats":2,"pace":0.5})");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const json ids = json::parse(accepted.body)["runs"];
  const std::string first = "/runs/" + ids[0].dump();
  const std::string second = "/runs/" + ids[1].dump();
  ASSERT_TRUE(comes_to(ids[0], "recording"));
  EXPECT_EQ(get(second)["status"], "queued");
  expect_problem(ask("DELETE", first), 409, "Cancel");
  expect_problem(ask("DELETE", second), 409, "Cancel");
  EXPECT_EQ(ask("POST", second + "/cancel").status, 202);
  EXPECT_EQ(ask("POST", first + "/cancel").status, 202);
  for (const json& id : ids) EXPECT_TRUE(comes_to(id, "cancelled", std::chrono::seconds(10)));
  expect_problem(ask("POST", first + "/cancel"), 409, "neither");
  for (const std::string& path : {first, second}) {
    EXPECT_EQ(ask("DELETE", path).status, 204);
    for (const char* part : {"", "/metrics", "/ticks", "/frames", "/csv"}) {
      expect_problem(ask("GET", path + part), 404, "no run");
    }
    expect_problem(ask("DELETE", path), 404, "no run");
    expect_problem(ask("POST", path + "/cancel"), 404, "no run");
  }
}

TEST_F(AppTest, ARunDrivenByAPersonIsNotRepeatedAlone) {
  const std::string run = get("/session")["run"]["id"].dump();
  ASSERT_TRUE(eventually([&] { return ask("GET", "/runs/" + run).status == 200; }));
  expect_problem(ask("POST", "/runs/" + run + "/resume"), 409, "People drove this run");
  expect_problem(ask("POST", "/runs/4711/resume"), 404, "no run");
}

TEST(App, ARunCutByTheEndOfTheProgramIsInterrupted) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("tautline_cut_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string database = (folder / "runs.db").string();
  {
    AppOptions options;
    options.net.port = 0;
    options.database = database;
    RunOverrides kinematic;
    kinematic.physics = sim::PhysicsKind::Kinematic;
    options.first = make_spec(ScenarioLibrary({}, {}).load("case1"), kinematic);
    App app(std::move(options));
    std::jthread serving([&] { app.run(); });
    db::RunReader reader(database, db::RunReader::Later{});
    EXPECT_TRUE(eventually([&] {
      const auto row = reader.get(1);
      return row && row->ticks > 0;
    }));
    app.stop();
  }
  db::RunReader reader(database);
  const auto row = reader.get(1);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->status, db::RunStatus::Interrupted);
  EXPECT_EQ(row->outcome, "stopped");
  EXPECT_NE(row->reason.find("in the middle"), std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST_F(AppTest, ObstaclesAreAddedMovedRemovedAndKeptOffTheRobot) {
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const Answer added =
      ask("POST", "/session/obstacles", R"({"type":"cylinder","x":-3,"y":1,"radius":0.2})");
  ASSERT_EQ(added.status, 201) << added.body;
  const json id = json::parse(added.body)["id"];
  const auto find = [&] {
    const json all = get("/session/obstacles");
    for (const json& o : all["items"]) {
      if (o["id"] == id) return o;
    }
    return json();
  };
  EXPECT_EQ(find()["x"], -3.0);
  const std::string path = "/session/obstacles/" + id.dump();
  EXPECT_EQ(ask("PUT", path, R"({"x":-4,"y":2})").status, 200);
  EXPECT_EQ(find()["y"], 2.0);

  const json pose = get("/session")["pose"];
  const json on_robot = {{"x", pose["x"]}, {"y", pose["y"]}};
  expect_problem(ask("PUT", path, on_robot.dump()), 409, "overlap");
  EXPECT_EQ(find()["x"], -4.0);
  json cylinder = on_robot;
  cylinder["type"] = "cylinder";
  cylinder["radius"] = 0.1;
  const std::size_t before = get("/session/obstacles")["items"].size();
  expect_problem(ask("POST", "/session/obstacles", cylinder.dump()), 409, "overlap");
  EXPECT_EQ(get("/session/obstacles")["items"].size(), before);

  EXPECT_EQ(ask("DELETE", path).status, 200);
  EXPECT_TRUE(find().is_null());
  expect_problem(ask("DELETE", path), 409, "no obstacle");
}

TEST_F(AppTest, TheLastOfManyStepsIsShown) {
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const int before = get("/session").value("tick", 0);
  for (int i = 1; i <= 5; ++i) {
    ASSERT_EQ(post("/session/control", {{"action", "step"}, {"ticks", 400}}), 200);
    EXPECT_TRUE(eventually([&] { return get("/session")["tick"] >= before + 400 * i; }))
        << get("/session")["tick"] << " of " << before + 400 * i;
  }
}

TEST_F(AppTest, AnEngagedStopOutlivesAReset) {
  ASSERT_EQ(post("/session/control", {{"action", "speed"}, {"speed", 4}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "stop"}}), 200);
  const json run = get("/session")["run"]["id"];
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_NE(get("/session")["run"]["id"], run);
  ASSERT_TRUE(eventually([&] { return get("/session").value("tick", 0) > 30; }));
  const json stopped = get("/session");
  EXPECT_TRUE(stopped["stop"]);
  EXPECT_EQ(stopped["hold"], "stopped");
  EXPECT_EQ(stopped["command"]["v"], 0.0);
  EXPECT_NEAR(stopped["pose"]["x"], 0.0, 1e-6);
  ASSERT_EQ(post("/session/control", {{"action", "release"}}), 200);
  EXPECT_FALSE(get("/session")["stop"]);
  EXPECT_TRUE(eventually([&] { return get("/session")["pose"]["x"] > 0.05; }));
}

}  // namespace
}  // namespace server
