// tests/server/serve/world_test.cpp: a world that people have built outlives loads and resets, and
// can be saved.
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/server/serve/app_fixture.hpp"

namespace server {
namespace {

using net::test::eventually;

class WorldTest : public AppTest {
 protected:
  void build() const {
    const json box = {{"type", "box"}, {"x", -3}, {"y", 2}, {"length", 0.5}, {"width", 0.4}};
    ASSERT_EQ(post("/session/obstacles", box), 201);
    const json goals = {{"goals", {{{"x", 1}, {"y", 4}}, {{"x", -2}, {"y", 4}}}}, {"loop", true}};
    ASSERT_EQ(ask("PUT", "/session/goals", goals.dump()).status, 200);
  }
  void expect_built() const {
    const json world = get("/session/scenario");
    EXPECT_EQ(world["obstacles"].size(), 2U);
    EXPECT_EQ(world["obstacles"][1]["length"], 0.5);
    EXPECT_EQ(world["goal"]["x"], -2.0);
    ASSERT_EQ(world["waypoints"].size(), 1U);
    EXPECT_EQ(world["waypoints"][0]["x"], 1.0);
    EXPECT_EQ(world["loop"], true);
    EXPECT_EQ(get("/session/obstacles")["items"].size(), 2U);
  }
  int load(json body) const {
    body["action"] = "load";
    return post("/session/control", body);
  }
};

TEST_F(WorldTest, OutlivesAResetAndAnotherControllerFilterPhysicsAndRobot) {
  EXPECT_FALSE(get("/session")["edited"]);
  build();
  EXPECT_TRUE(get("/session")["edited"]);
  for (const json& change : {json{{"controller", "strip"}},
                             json{{"filter", "median"}},
                             json{{"physics", "bullet"}},
                             json{{"robot", "jackal"}}}) {
    ASSERT_EQ(load(change), 200) << change;
    expect_built();
    EXPECT_EQ(get("/session/scenario")[change.items().begin().key()],
              change.items().begin().value());
  }
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  expect_built();
  const json session = get("/session");
  EXPECT_TRUE(session["edited"]);
  EXPECT_TRUE(session["loop"]);
  EXPECT_EQ(session["goal"]["x"], 1.0);
  EXPECT_EQ(session["goals_ahead"].size(), 1U);
}

TEST_F(WorldTest, OutlivesDrivingByHandWhichClearsTheGoals) {
  build();
  ASSERT_EQ(post("/session/requests", {{"type", "joystick"}, {"forward", 0.1}, {"turn", 0}}), 200);
  EXPECT_TRUE(eventually([&] { return get("/session")["goal"].is_null(); }));
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  expect_built();
}

TEST_F(WorldTest, OutlivesAResetWithTheGoalsOfAnArm) {
  ASSERT_EQ(load({{"scenario", "arm_post"}}), 200);
  EXPECT_FALSE(get("/session")["edited"]);
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_EQ(get("/session")["carry_goal"]["x"], 4.0);
  EXPECT_FALSE(get("/session")["edited"]);

  const json pose = {{"x", 1.5}, {"y", 0}, {"z", 0.9}, {"qw", 1}};
  ASSERT_EQ(ask("PUT", "/session/hand_goal", pose.dump()).status, 200);
  EXPECT_TRUE(eventually([&] { return get("/session")["edited"].get<bool>(); }));
  ASSERT_EQ(post("/session/requests", {{"type", "joystick"}, {"forward", 0.1}, {"turn", 0}}), 200);
  EXPECT_TRUE(eventually([&] { return get("/session")["hand_goal"].is_null(); }));
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  const json session = get("/session");
  EXPECT_EQ(session["hand_goal"]["z"], 0.9);
  EXPECT_TRUE(session["carry_goal"].is_null());
  EXPECT_TRUE(session["goal"].is_null());

  ASSERT_EQ(ask("PUT", "/session/goal", R"({"x":1,"y":1})").status, 200);
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_TRUE(get("/session")["hand_goal"].is_null());
  EXPECT_EQ(get("/session")["goal"]["x"], 1.0);
}

TEST_F(WorldTest, TheNameOfTheScenarioLoadsItAsItIsInTheLibrary) {
  build();
  ASSERT_EQ(load({{"scenario", "case1"}}), 200);
  EXPECT_EQ(get("/session/obstacles")["items"].size(), 1U);
  EXPECT_FALSE(get("/session")["edited"]);
}

TEST_F(WorldTest, ADocumentIsLoadedWithTheRobotWhereItSays) {
  build();
  const json world = get("/session/scenario");
  ASSERT_EQ(load({{"scenario", "case3"}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const json body = {{"scenario", world}, {"begin", {{"x", -1}, {"y", -1}, {"heading", 1}}}};
  ASSERT_EQ(load(body), 200);
  expect_built();
  ASSERT_EQ(post("/session/control", {{"action", "step"}}), 200);
  ASSERT_TRUE(eventually([&] { return get("/session").contains("pose"); }));
  EXPECT_NEAR(get("/session")["pose"]["x"], -1, 0.05);
  EXPECT_EQ(get("/session/scenario")["start"], world["start"]);  // as before
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "step"}}), 200);
  ASSERT_TRUE(eventually([&] { return get("/session").contains("pose"); }));
  EXPECT_NEAR(get("/session")["pose"]["x"], 0, 0.05);
  expect_problem(ask("POST", "/session/control", R"({"action":"load","begin":{"x":"a","y":1}})"),
                 422,
                 "begin/x");
}

/// A world that somebody sent may be called as one of the library.
TEST_F(WorldTest, OfADocumentKeepsItsFieldsWhenAnotherRobotIsChosen) {
  const json other = {{"start", {{"x", 5}, {"y", 5}}}, {"goal", nullptr}};
  const json world = {{"name", "case1"},
                      {"title", "Mine"},
                      {"physics", "kinematic"},
                      {"period", 0.05},
                      {"time_limit", 77},
                      {"drive", {{"yaw_slip", 0.1}, {"max_v", 0.3}}},
                      {"lasers", {{{"resolution_deg", 1}}}},
                      {"robots", {other}}};
  ASSERT_EQ(load({{"scenario", world}}), 200);
  build();
  const auto expect_mine = [&] {
    const json now = get("/session/scenario");
    EXPECT_EQ(now["title"], "Mine");
    EXPECT_EQ(now["period"], 0.05);
    EXPECT_EQ(now["time_limit"], 77);
    EXPECT_EQ(now["drive"]["yaw_slip"], 0.1);
    EXPECT_EQ(now["robots"].size(), 1U);
    EXPECT_EQ(now["obstacles"].size(), 1U);
  };
  ASSERT_EQ(load({{"robot", "jackal"}}), 200);
  expect_mine();
  EXPECT_EQ(get("/session/scenario")["robot"], "jackal");
  ASSERT_EQ(load({{"robot", "silvermate"}}), 200);  // its own, with the sensors that it gives it
  expect_mine();
  EXPECT_EQ(get("/session/scenario")["lasers"][0]["resolution_deg"], 1);
  EXPECT_EQ(get("/session/scenario")["drive"]["max_v"], 0.3);

  ASSERT_EQ(load({{"scenario", "case1"}}), 200);  // now the library's
  ASSERT_EQ(load({{"robot", "jackal"}}), 200);
  EXPECT_NE(get("/session/scenario")["title"], "Mine");
}

TEST_F(WorldTest, OfADocumentStaysTheSessionsOwnInANewSession) {
  const json world = {{"name", "case1"}, {"physics", "kinematic"}, {"time_limit", 77}};
  const auto made = ask("POST", "/sessions", json{{"scenario", world}}.dump());
  ASSERT_EQ(made.status, 201);
  const std::string at = "/sessions/" + json::parse(made.body)["id"].get<std::string>();
  ASSERT_EQ(post(at + "/control", {{"action", "load"}, {"robot", "jackal"}}), 200);
  EXPECT_EQ(get(at + "/scenario")["time_limit"], 77);
}

/// A file that somebody has changed is read anew, with its scanners.
TEST_F(WorldTest, OfADocumentGetsTheWholeNewestModelOfAUsersRobot) {
  const auto write = [&](double length, const json& lasers) {
    const json robot = {{"name", "carrier"},
                        {"hull", {{"length", length}, {"width", 0.7}}},
                        {"mass", 200},
                        {"track", 0.6},
                        {"wheel_radius", 0.1},
                        {"limits", {{"speed", 0.8}, {"turn", 1.2}}},
                        {"lasers", lasers}};
    std::filesystem::create_directories(folder_ / "robots");
    std::ofstream(folder_ / "robots" / "carrier.json") << robot.dump();
  };
  const json front = {{"mount", {{"x", 0.5}, {"y", 0}}}};
  const json back = {{"mount", {{"x", -0.5}, {"y", 0}, {"heading", 3}}}};
  for (const json& world :
       {json{{"name", "mine"}, {"physics", "kinematic"}},
        json{{"name", "mine"}, {"physics", "kinematic"}, {"robot", "carrier"}}}) {
    write(1.2, json::array({front, back}));
    ASSERT_EQ(load({{"scenario", world}}), 200);
    ASSERT_EQ(load({{"robot", "carrier"}}), 200);
    EXPECT_EQ(get("/session/scenario")["lasers"].size(), 2U);
    write(1.4, json::array({front}));
    ASSERT_EQ(load({{"robot", "carrier"}}), 200);
    const json now = get("/session/scenario");
    EXPECT_EQ(now["robot"]["hull"]["length"], 1.4);
    EXPECT_EQ(now["lasers"].size(), 1U);
  }
}

TEST_F(WorldTest, IsSavedAndOpenedUnderItsName) {
  build();
  ASSERT_EQ(post("/session/scenario", {{"name", "mine"}, {"title", "My room"}}), 201);
  EXPECT_TRUE(eventually([&] { return !get("/session")["edited"].get<bool>(); }));
  EXPECT_EQ(get("/session")["scenario"]["title"], "My room");
  ASSERT_EQ(load({{"scenario", "case1"}}), 200);
  ASSERT_EQ(load({{"scenario", "mine"}}), 200);
  expect_built();
  EXPECT_FALSE(get("/session")["edited"]);
}

TEST_F(WorldTest, AnObstacleIsReplacedByAnotherThatMayMove) {
  json walker = {{"type", "cylinder"}, {"x", -3}, {"y", 2}, {"radius", 0.3}};
  walker["path"] = {{"period", 4}, {"keys", {{0, -3, 2}, {2, -3, 4}}}};
  const std::string path = "/session/obstacles/1";
  ASSERT_EQ(ask("PUT", path, walker.dump()).status, 200);
  const json items = get("/session/obstacles")["items"];
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0]["path"]["period"], 4);
  expect_problem(ask("PUT", path, R"({"x":-5,"y":0})"), 409, "moves by itself");
  expect_problem(ask("PUT", "/session/obstacles/7", walker.dump()), 409, "no obstacle 7");
  walker["path"]["keys"] = json::array();
  expect_problem(ask("PUT", path, walker.dump()), 422, "obstacle/path/keys");
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_EQ(get("/session/obstacles")["items"][0]["path"]["period"], 4);
}

TEST_F(WorldTest, TheStartIsMovedAndTakenAtTheNextReset) {
  EXPECT_EQ(ask("PUT", "/session/start", R"({"x":-2,"y":1,"heading":0.5})").status, 200);
  EXPECT_TRUE(get("/session")["edited"]);
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "step"}}), 200);
  ASSERT_TRUE(eventually([&] { return get("/session").contains("pose"); }));
  EXPECT_NEAR(get("/session")["pose"]["x"], -2, 0.05);
  const json obstacle = get("/session/obstacles")["items"][0];
  const json on_it = {{"x", obstacle["x"]}, {"y", obstacle["y"]}};
  expect_problem(ask("PUT", "/session/start", on_it.dump()), 409, "overlap");
  expect_problem(ask("PUT", "/session/start", R"({"x":1})"), 422, "y");
}

TEST_F(WorldTest, TheDemoDrivesToAndFroUntilSomebodySetsAGoal) {
  ASSERT_EQ(load({{"scenario", "demo"}}), 200);
  const json session = get("/session");
  EXPECT_TRUE(session["loop"]);
  EXPECT_FALSE(session["edited"]);
  EXPECT_EQ(session["goal"]["x"], 7.5);
  ASSERT_EQ(session["goals_ahead"].size(), 1U);
  EXPECT_EQ(session["goals_ahead"][0]["x"], 0.0);
  ASSERT_EQ(ask("PUT", "/session/goal", R"({"x":1,"y":1})").status, 200);
  EXPECT_FALSE(get("/session")["loop"]);
}

TEST_F(WorldTest, AListOfGoalsIsCheckedAsAWhole) {
  expect_problem(
      ask("PUT", "/session/goals", R"({"goals":[{"x":1,"y":2}],"next":1})"), 422, "next");
  expect_problem(
      ask("PUT", "/session/goals", R"({"goals":[{"x":1,"y":2},{"x":1}]})"), 422, "goals/1/y");
  EXPECT_EQ(ask("PUT", "/session/goals", R"({"goals":[]})").status, 200);
  EXPECT_TRUE(get("/session")["goal"].is_null());
}

}  // namespace
}  // namespace server
