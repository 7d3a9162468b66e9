// tests/server/serve/external_test.cpp: a controller of the user in catalogue, sessions and runs; a
// silent one delays nobody else.
#include <chrono>

#include "tests/folders.hpp"
#include "tests/server/serve/app_fixture.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/external/registration.hpp"

namespace server {
namespace {

using net::test::eventually;
using ::testing::HasSubstr;

external::Registration own(const std::string& name, const std::string& script) {
  const std::filesystem::path root = tests::folder().parent_path();
  return {.name = name,
          .command = "PYTHONPATH=" + (root / "docs" / "examples").string() + " python3 -B " +
                     (root / script).string()};
}

RunSpec with_own_controllers() {
  RunOverrides overrides;
  overrides.physics = sim::PhysicsKind::Kinematic;
  overrides.controllers = std::make_shared<const algo::ControllerCatalogue>(
      external::catalogue_with({own("mine", "docs/examples/go_to_goal.py"),
                                own("silent", "tests/server/external/faulty.py silent"),
                                own("dies", "tests/server/external/faulty.py raises")}));
  return make_spec(ScenarioLibrary({}, {}).load("case1"), overrides);
}

class ExternalApp : public AppTest {
 protected:
  ExternalApp() : AppTest(with_own_controllers()) {}

  int load(const std::string& controller, const std::string& session = "/session") const {
    const json body{{"action", "load"}, {"scenario", "case1"}, {"controller", controller}};
    return post(session + "/control", body);
  }
  std::uint64_t ticks(const std::string& session = "/session") const {
    return get(session).value("tick", std::uint64_t{0});
  }
};

TEST_F(ExternalApp, StandsInTheCatalogueAndDrivesALiveSession) {
  std::string names;
  const json catalog = get("/catalog");
  for (const json& each : catalog.at("controllers")) {
    names += each.at("name").get<std::string>() + " ";
  }
  EXPECT_THAT(names, HasSubstr(" mine silent dies "));
  ASSERT_EQ(load("mine"), 200);
  EXPECT_EQ(get("/session").at("controller"), "mine");
  EXPECT_TRUE(eventually([&] { return ticks() > 20; }));
  EXPECT_GT(get("/session").at("pose").at("x").get<double>(), 0.0);
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const std::uint64_t before = ticks();
  ASSERT_EQ(post("/session/control", {{"action", "step"}, {"ticks", 5}}), 200);
  EXPECT_TRUE(eventually([&] { return ticks() >= before + 5; }));
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_EQ(get("/session").at("controller"), "mine");
}

TEST_F(ExternalApp, NobodyRunsCodeByPosting) {
  for (const char* controller : {"python3 mine.py", "./mine.so", "x=true", "unix:/tmp/x"}) {
    const json body{{"action", "load"}, {"controller", controller}};
    expect_problem(ask("POST", "/session/control", body.dump()), 422, "is unknown");
    const json run{{"scenario", "case1"}, {"controller", controller}};
    expect_problem(ask("POST", "/runs", run.dump()), 422, "is unknown");
  }
}

TEST_F(ExternalApp, ASilentOneDelaysNoOtherSession) {
  const std::string other =
      "/sessions/" + json::parse(ask("POST", "/sessions", "{}").body).at("id").get<std::string>();
  ASSERT_EQ(load("modified", other), 200);
  ASSERT_EQ(load("silent"), 200);
  EXPECT_TRUE(eventually([&] { return ticks() >= 2; }));
  const std::uint64_t before = ticks(other);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_GT(ticks(other), before + 20);
  EXPECT_LE(ticks(), 3U);
  // And it may be left at once.
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(load("modified"), 200);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST_F(ExternalApp, ADeadOneEndsItsRunWithItsTraceback) {
  ASSERT_EQ(load("dies"), 200);
  const std::int64_t run = get("/session").at("run").at("id");
  ASSERT_TRUE(comes_to(run, "failed"));
  EXPECT_THAT(get("/runs/" + std::to_string(run)).at("reason").get<std::string>(),
              HasSubstr("ValueError: no way at tick 3"));
  ASSERT_EQ(load("mine"), 200);
  EXPECT_TRUE(eventually([&] { return ticks() > 5; }));
}

TEST_F(ExternalApp, DrivesBackgroundRuns) {
  const json body{
      {"scenario", "case1"}, {"controller", "mine"}, {"repeats", 2}, {"physics", "kinematic"}};
  const auto answer = ask("POST", "/runs", body.dump());
  ASSERT_EQ(answer.status, 202) << answer.body;
  const json made = json::parse(answer.body);
  for (const json& run : made.at("runs")) {
    EXPECT_TRUE(comes_to(run.get<std::int64_t>(), "finished"));
  }
}

}  // namespace
}  // namespace server
