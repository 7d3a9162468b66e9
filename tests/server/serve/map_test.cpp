// tests/server/serve/map_test.cpp: the pose on a known map over REST and Foxglove.
#include <string>

#include "tests/server/map_room.hpp"
#include "tests/server/serve/app_fixture.hpp"
#include "tests/server/serve/viewer.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server {
namespace {

using net::test::eventually;

class MapTest : public AppTest {
 protected:
  MapTest() : AppTest(map_room::spec_of(map_room::poor_wheels_in_a_room(), true, true)) {}
  bool located() { return get("/session")["fix"]["state"] == "located"; }
};

TEST_F(MapTest, TheMapAndTheFixCanBeRead) {
  EXPECT_EQ(get("/session")["map"], "room.yaml");
  const json map = get("/session/map");
  EXPECT_EQ(map["cell"], 0.05);
  std::size_t cells = 0;
  for (std::size_t k = 1; k < map["cells"].size(); k += 2)
    cells += map["cells"][k].get<std::size_t>();
  EXPECT_EQ(cells, map["columns"].get<std::size_t>() * map["rows"].get<std::size_t>());
  EXPECT_TRUE(eventually([&] { return located(); }));
  EXPECT_GT(get("/session")["fix"]["fit"], 0.7);
}

TEST_F(MapTest, APoseIsGivenAndGoalsAreRefusedUntilItIsFound) {
  ASSERT_TRUE(eventually([&] { return located(); }));
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const json pose = {{"x", 2}, {"y", 2}, {"heading", 0.2}};
  EXPECT_EQ(ask("PUT", "/session/pose", pose.dump()).status, 200);
  EXPECT_EQ(ask("DELETE", "/session/pose").status, 200);
  EXPECT_EQ(ask("PUT", "/session/pose", R"({"x":1,"y":2})").status, 422);
  ASSERT_EQ(post("/session/control", {{"action", "step"}}), 200);
  ASSERT_TRUE(eventually([&] { return get("/session")["fix"]["state"] == "searching"; }));
  const auto refused = ask("PUT", "/session/goal", R"({"x":3,"y":2})");
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.body, testing::HasSubstr("give an initial pose"));
  ASSERT_EQ(post("/session/control", {{"action", "play"}}), 200);
  ASSERT_TRUE(eventually([&] { return located(); }));
  EXPECT_EQ(ask("PUT", "/session/goal", R"({"x":3,"y":2})").status, 200);
}

TEST_F(MapTest, FoxglovesInitialPoseIsTaken) {
  ASSERT_TRUE(eventually([&] { return located(); }));
  EXPECT_EQ(get("/session")["fix"]["epoch"], 1);
  Viewer viewer(port_);
  const json channel = {{"id", 9},
                        {"topic", "/initialpose"},
                        {"encoding", "json"},
                        {"schemaName", "geometry_msgs/PoseWithCovarianceStamped"}};
  viewer.client.send_text(json({{"op", "advertise"}, {"channels", {channel}}}).dump());
  const json position = {{"x", 2}, {"y", 2}, {"z", 0}};
  const json orientation = {{"x", 0}, {"y", 0}, {"z", 0.1}, {"w", 0.995}};
  const json pose = {{"position", position}, {"orientation", orientation}};
  const json message = {{"pose", {{"pose", pose}, {"covariance", json::array()}}}};
  json in_odometry = message;
  in_odometry["header"] = {{"frame_id", "odom"}};
  viewer.client.send_binary(foxglove::client_message(9, in_odometry.dump()));
  EXPECT_THAT(viewer.complaint(), testing::HasSubstr("must be 'map', not 'odom'"));
  viewer.client.send_binary(foxglove::client_message(9, message.dump()));
  EXPECT_TRUE(eventually([&] { return located() && get("/session")["fix"]["epoch"] == 2; }));
}

TEST_F(MapTest, AResetKeepsTheMapAndAnotherWorldHasNone) {
  ASSERT_EQ(post("/session/control", {{"action", "reset"}}), 200);
  EXPECT_EQ(get("/session")["map"], "room.yaml");
  ASSERT_EQ(post("/session/control", {{"action", "load"}, {"scenario", "case1"}}), 200);
  EXPECT_TRUE(get("/session")["map"].is_null());
  EXPECT_EQ(ask("GET", "/session/map").status, 404);
  const auto refused = ask("PUT", "/session/pose", R"({"x":1,"y":2,"heading":0})");
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.body, testing::HasSubstr("knows no map"));
}

/// The file of the served map is there as long as the server.
struct FolderOfMap {
  tests::TemporaryFolder folder{};
};
class ServedMapTest : FolderOfMap, public AppTest {
 protected:
  ServedMapTest() : AppTest(spec(folder.path())) {}

 private:
  static RunSpec spec(const std::filesystem::path& folder) {
    const sim::Scenario room = map_room::poor_wheels_in_a_room();
    RunOverrides overrides;
    overrides.map = map_room::map_of(room, folder);
    return make_spec(room, overrides);
  }
};

TEST_F(ServedMapTest, ADocumentFindsTheServedMapWhereverItIsSent) {
  const std::string run = std::to_string(get("/session")["run"]["id"].get<std::int64_t>());
  ASSERT_TRUE(eventually([&] { return ask("GET", "/runs/" + run).status == 200; }));
  const json world = get("/runs/" + run)["document"]["scenario"];
  ASSERT_EQ(world["map"], "room.yaml");

  const auto again = ask("POST", "/runs", json({{"scenario", world}, {"repeats", 1}}).dump());
  ASSERT_EQ(again.status, 202) << again.body;
  EXPECT_TRUE(comes_to(json::parse(again.body)["runs"][0], "finished"));

  ASSERT_EQ(post("/session/control", {{"action", "load"}, {"scenario", "case1"}}), 200);
  ASSERT_EQ(post("/session/control", {{"action", "load"}, {"scenario", world}}), 200);
  EXPECT_EQ(get("/session")["map"], "room.yaml");

  EXPECT_EQ(ask("PUT", "/scenarios/room", world.dump()).status, 200);
  ASSERT_EQ(post("/session/control", {{"action", "load"}, {"scenario", "room"}}), 200);
  EXPECT_EQ(get("/session")["map"], "room.yaml");
}

TEST_F(MapTest, APoseOffTheMapGetsAWarning) {
  const auto warning = [&](const char* pose) {
    const auto answer = ask("PUT", "/session/pose", pose);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body).value("warning", "");
  };
  EXPECT_EQ(warning(R"({"x":500,"y":2,"heading":0})"),
            "The map shows nothing within 2 m of this pose: give one on the map.");
  EXPECT_EQ(warning(R"({"x":2,"y":-3,"heading":0})"),
            "The map shows nothing within 2 m of this pose: give one on the map.");
  EXPECT_EQ(warning(R"({"x":2,"y":-1,"heading":0})"), "");
  EXPECT_EQ(warning(R"({"x":2,"y":2,"heading":0})"), "");
}

}  // namespace
}  // namespace server
