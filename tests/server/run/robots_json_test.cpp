// tests/server/run/robots_json_test.cpp: the other robots of a scenario to JSON and back, and the
// sentences about invalid ones.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "algo/driving.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/request_json.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

using nlohmann::json;

sim::Scenario read_fleet(const std::string& robots) {
  return scenario_from_json(
      json::parse(R"({"name":"a","goal":{"x":5,"y":0},"robots":)" + robots + "}"));
}

TEST(RobotsJson, ComeBackFromTheirText) {
  for (const char* text :
       {"[]",
        R"([{"start":{"x":1,"y":2}}])",
        R"([{"start":{"x":1,"y":2},"goal":null},{"start":{"x":3,"y":2,"heading":1}}])",
        R"([{"start":{"x":1,"y":2},"robot":"jackal","goal":{"x":3,"y":4,"heading":0.5},)"
        R"("waypoints":[{"x":0,"y":1},{"x":1,"y":1}],"controller":"original","filter":"lulu",)"
        R"("parameters":{"v_max":0.2,"k_r":0.3}}])"}) {
    SCOPED_TRACE(text);
    const json document = to_json(read_fleet(text));
    EXPECT_EQ(document, to_json(scenario_from_json(json::parse(document.dump()))));
    EXPECT_EQ(document.contains("robots"), std::string(text) != "[]");
  }
}

TEST(RobotsJson, AbsentFieldsAreTheFirstRobots) {
  const sim::Scenario s =
      read_fleet(R"([{"start":{"x":5,"y":-2}},{"start":{"x":1,"y":2},"goal":null},)"
                 R"({"start":{"x":1,"y":4},"goal":{"x":1,"y":9},)"
                 R"("waypoints":[{"x":-3,"y":4}]}])");
  ASSERT_EQ(s.robots.size(), 3U);
  EXPECT_EQ(s.robots[0].goals, std::nullopt);
  EXPECT_NEAR(s.robots[0].start.heading, M_PI / 2, 1e-12);  // it faces the first robot's goal
  EXPECT_EQ(s.robots[1].goals, std::vector<algo::SetGoal>{});
  EXPECT_EQ(s.robots[1].start.heading, 0);
  ASSERT_EQ(s.robots[2].goals->size(), 2U);
  EXPECT_NEAR(s.robots[2].start.heading, M_PI, 1e-12);  // its waypoint
  EXPECT_EQ(s.robots[0].controller, std::nullopt);
  EXPECT_EQ(s.robots[0].robot, std::nullopt);
}

TEST(RobotsJson, SaysWhereAndWhat) {
  std::string many = "[";
  for (int k = 0; k < 200; ++k) many += R"({"start":{"x":0,"y":0}},)";
  many.back() = ']';
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{}", "robots: must be a list, not object"},
      {"[3]", "robots/0: must be an object, not number"},
      {"[{}]", "robots/0/start: is missing"},
      {R"([{"start":{"x":1}}])", "robots/0/start/y: is missing"},
      {R"([{"start":{"x":1,"y":1}},{"start":{"x":1,"y":"b"}}])",
       "robots/1/start/y: must be a number, not string"},
      {R"([{"start":{"x":1,"y":1,"z":1}}])", "robots/0/start: unknown field 'z'"},
      {R"([{"start":{"x":1,"y":1},"speed":1}])",
       "robots/0: unknown field 'speed'; known are start"},
      {R"([{"start":{"x":1,"y":1},"robot":"tank"}])", "robots/0/robot: 'tank' is unknown"},
      {R"([{"start":{"x":1,"y":1},"goal":{"x":1}}])", "robots/0/goal/y: is missing"},
      {R"([{"start":{"x":1,"y":1},"goal":{"x":1,"y":1,"z":1}}])",
       "robots/0/goal: unknown field 'z'"},
      {R"([{"start":{"x":1,"y":1},"waypoints":[{"x":1,"y":1}]}])",
       "robots/0/waypoints: lead nowhere: there is no goal"},
      {R"([{"start":{"x":1,"y":1},"goal":{"x":1,"y":3},"waypoints":[{"x":1}]}])",
       "robots/0/waypoints/0/y: is missing"},
      {R"([{"start":{"x":1,"y":1},"controller":"not one"}])",
       "robots/0/controller: 'not one' is unknown"},
      {R"([{"start":{"x":1,"y":1},"filter":"x"}])", "robots/0/filter: 'x' is unknown"},
      {R"([{"start":{"x":1,"y":1},"parameters":{"x":1}}])",
       "robots/0/parameters/x: there is no such parameter"},
      {R"([{"start":{"x":1,"y":1},"parameters":{"strip_step":0.6,"k_r":0.3}}])",
       "robots/0/parameters: strip_step"},
      {many, "robots: has more than 199 entries"},
  };
  for (const auto& [robots, complaint] : cases) {
    SCOPED_TRACE(robots.substr(0, 200));
    try {
      read_fleet(robots);
      FAIL() << "accepted";
    } catch (const DocumentError& e) {
      EXPECT_EQ(std::string(e.what()).substr(0, complaint.size()), complaint);
    }
  }
}

TEST(RobotsJson, ManyRobotsAmongManyObstaclesAreRefused) {
  json document = {{"name", "a"}};
  for (int k = 0; k < 2000; ++k) {
    document["obstacles"].push_back(
        {{"type", "cylinder"}, {"x", 10 + k}, {"y", 9}, {"radius", 0.1}});
  }
  for (int k = 0; k < 19; ++k) {
    document["robots"].push_back({{"start", {{"x", k + 10}, {"y", 0}}}});
  }
  EXPECT_EQ(scenario_from_json(document).robots.size(), 19U);
  document["robots"].push_back({{"start", {{"x", -5}, {"y", 0}}}});
  EXPECT_THROW(scenario_from_json(document), DocumentError);
}

TEST(RobotsJson, EachRobotIsCheckedAgainstItsController) {
  const auto complaint = [](const std::string& robots, const RunOverrides& overrides) {
    try {
      make_spec(read_fleet(robots), overrides);
    } catch (const DocumentError& e) {
      return std::string(e.what());
    }
    return std::string("made");
  };
  RunOverrides overrides;
  const std::string kept = R"([{"start":{"x":1,"y":1}},{"start":{"x":1,"y":3},)"
                           R"("controller":"via_kept"}])";
  EXPECT_EQ(complaint(kept, overrides), "made");
  overrides.parameters = {{"k_c", 1.0}};
  EXPECT_EQ(complaint(kept, overrides).substr(0, 30), "robots/1/parameters: k_c must ");
}

TEST(RobotsJson, EditsAcceptRobotIdsAndNoHigherOnes) {
  EXPECT_NO_THROW(request_from_json({{"type", "remove_obstacle"}, {"id", 1'000'000'002}}));
  EXPECT_THROW(request_from_json({{"type", "remove_obstacle"}, {"id", 1'000'001'002}}),
               DocumentError);
  EXPECT_THROW(
      request_from_json(
          {{"type", "add_obstacle"},
           {"obstacle",
            {{"id", 1'000'000'002}, {"type", "cylinder"}, {"x", 1}, {"y", 1}, {"radius", 1}}}}),
      DocumentError);
}

TEST(RobotsJson, TheRunsDocumentHasThemAsObstaclesAtTheirStarts) {
  RunSpec spec = make_spec(read_fleet(R"([{"start":{"x":1,"y":2,"heading":1}}])"), {});
  const json document = run_document(spec, make_robot(spec)->spec());
  ASSERT_EQ(document.at("others").size(), 1U);
  EXPECT_EQ(document["others"][0]["id"], 1'000'000'002);
  EXPECT_EQ(document["others"][0]["radius"], 0.35);
  EXPECT_EQ(document["others"][0]["x"], 1.0);
  EXPECT_FALSE(run_document(make_spec(read_fleet("[]"), {}), {}).contains("others"));
}

}  // namespace
}  // namespace server
