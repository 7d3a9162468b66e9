// tests/server/run/scenario_json_test.cpp: scenarios to JSON and back, and the sentences about
// invalid ones.
#include "server/run/scenario_json.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/json_reader.hpp"
#include "server/run/request_json.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

using nlohmann::json;

sim::Scenario read(const std::string& text) {
  return scenario_from_json(json::parse(text));
}

void expect_same(const sim::Scenario& a, const sim::Scenario& b) {
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.goal, b.goal);
  EXPECT_EQ(a.obstacles, b.obstacles);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.physics, b.physics);
  ASSERT_EQ(a.robot.sensors.lasers.size(), b.robot.sensors.lasers.size());
  for (std::size_t i = 0; i < a.robot.sensors.lasers.size(); ++i) {
    EXPECT_EQ(a.robot.sensors.lasers[i].angle_increment, b.robot.sensors.lasers[i].angle_increment);
    EXPECT_EQ(a.robot.sensors.lasers[i].field_of_view, b.robot.sensors.lasers[i].field_of_view);
    EXPECT_EQ(a.robot.sensors.lasers[i].turns, b.robot.sensors.lasers[i].turns);
    EXPECT_EQ(a.robot.sensors.lasers[i].mirror_period, b.robot.sensors.lasers[i].mirror_period);
    EXPECT_EQ(a.robot.sensors.lasers[i].unit, b.robot.sensors.lasers[i].unit);
  }
  EXPECT_EQ(to_json(a), to_json(b));
}

TEST(ScenarioJson, EveryBuiltInScenarioComesBackFromItsText) {
  const ScenarioLibrary library({}, {});
  const auto entries = library.list();
  EXPECT_GE(entries.size(), 10u);
  for (const ScenarioEntry& entry : entries) {
    SCOPED_TRACE(entry.name);
    const sim::Scenario scenario = library.load(entry.name);
    expect_same(scenario, read(to_json(scenario).dump()));
  }
}

TEST(ScenarioJson, HandWrittenOnesComeBackFromTheirText) {
  for (
      const char* text :
      {R"({"name":"a"})",
       R"({"name":"b","goal":{"x":1,"y":-2,"heading":7}})",
       R"({"name":"c","start":{"x":0.1,"y":0.2},"goal":{"x":0.3,"y":0.7}})",
       R"({"name":"d","lasers":[{"resolution_deg":0.25,"unit":"cm","noise_shape":"uniform"},)"
       R"({"resolution_deg":1,"ideal":true,"mount":{"x":0.1,"y":0}}]})",
       R"({"name":"e","vehicle":"kinematic","controller":"original","filter":"lulu",)"
       R"("parameters":{"k_r":0.3,"v_max":0.1},"time_limit":12.5,"period":0.05})",
       R"({"name":"c","goal":{"x":3,"y":0},"waypoints":[{"x":0,"y":2,"heading":0.5},{"x":1,"y":1}]})",
       R"({"name":"f","lasers":[]})",
       R"({"name":"f","lasers":[],"controller":"vff","sonar":{}})",
       R"({"name":"f","sensors":[{"sensor":"compass","channel":"heading","north":0.5},)"
       R"({"sensor":"scripted","channel":"b","unit":"V","times":[0],"values":[1]}]})",
       R"({"name":"f","sonar":{"count":8,"field_deg":180,"cone_deg":25,"ping":0.02,)"
       R"("range_min":0.2,"range_max":1,"noise":0,"incidence_deg":50,"height":0.2}})",
       R"({"name":"f","infrared":[{},{"mount":{"x":-0.3,"y":0,"heading":3},"height":0.2,"beams":31,)"
       R"("field_deg":180,"period":0.1,"range_min":0,"range_max":2,"noise":0}],)"
       R"("gyro":{"bias":0.01,"bias_walk":0.001,"noise":0.002},"bumpers":3,"encoders":false,)"
       R"("localization":"gyro","drive":{"odometry_slip":0.05}})",
       R"({"name":"f","gyro":false,"bumpers":0})",
       R"({"name":"g","obstacles":[{"type":"box","x":1,"y":1,"heading":0.3,"length":0.6,)"
       R"("width":0.4,"height":0.2,"reflectivity":0.5,"specular":true},)"
       R"({"type":"polygon","points":[[0.1,0],[1.3,0.1],[1,1.7]]},)"
       R"({"type":"wall","from":[0.1,2],"to":[3.3,4],"thickness":0.2}]})",
       R"({"name":"h","physics":"bullet","obstacles":[)"
       R"({"type":"ramp","x":1,"y":2,"heading":0.3,"length":2,"width":1.5,"low":0.1,"height":0.3},)"
       R"({"type":"ramp","x":4,"y":2,"length":2,"width":1.5,"height":0.3},)"
       R"({"type":"step","x":6,"y":2,"length":2,"width":1.5,"height":0.013},)"
       R"({"type":"trench","x":8,"y":2,"heading":1,"length":0.02,"width":3,"depth":0.1}]})"}) {
    SCOPED_TRACE(text);
    const sim::Scenario scenario = read(text);
    expect_same(scenario, read(to_json(scenario).dump()));
  }
}

TEST(ScenarioJson, AWallBetweenTwoPointsIsTheWallOfThatLength) {
  const algo::Obstacle ends =
      obstacle_from_json(json::parse(R"({"type":"wall","from":[1,2],"to":[1,6]})"), "");
  const algo::Obstacle middle = obstacle_from_json(
      json::parse(R"({"type":"wall","x":1,"y":4,"heading":1.5707963267948966,"length":4})"), "");
  EXPECT_EQ(ends, middle);
  EXPECT_EQ(std::get<algo::Wall>(ends.shape).thickness, 0.1);
}

TEST(ScenarioJson, AStepIsARampOfOneHeight) {
  const auto step = obstacle_from_json(
      json::parse(R"({"type":"step","x":1,"y":0,"length":2,"width":1,"height":0.1})"), "");
  const auto ramp = obstacle_from_json(
      json::parse(R"({"type":"ramp","x":1,"y":0,"length":2,"width":1,"low":0.1,"height":0.1})"),
      "");
  EXPECT_EQ(step, ramp);
  EXPECT_EQ(to_json(ramp)["type"], "step");
}

TEST(ScenarioJson, MalformedGroundIsRefusedWithTheField) {
  const auto complaint = [](const char* text) -> std::string {
    try {
      obstacle_from_json(json::parse(text), "obstacles/0");
    } catch (const DocumentError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(complaint(R"({"type":"ramp","x":0,"y":0,"length":2,"width":1})"),
              testing::HasSubstr("obstacles/0/height"));
  EXPECT_THAT(complaint(R"({"type":"ramp","x":0,"y":0,"width":1,"height":0.1})"),
              testing::HasSubstr("obstacles/0/length"));
  EXPECT_THAT(
      complaint(R"({"type":"ramp","x":0,"y":0,"length":2,"width":1,"height":0.1,"low":-1})"),
      testing::HasSubstr("low"));
  EXPECT_THAT(complaint(R"({"type":"step","x":0,"y":0,"length":2,"width":1,"height":1,"low":0})"),
              testing::HasSubstr("unknown field 'low'"));
  EXPECT_THAT(complaint(R"({"type":"trench","x":0,"y":0,"length":2,"width":1})"),
              testing::HasSubstr("obstacles/0/depth"));
  EXPECT_THAT(complaint(R"({"type":"trench","x":0,"y":0,"length":2,"width":1,"depth":0})"),
              testing::HasSubstr("depth"));
  EXPECT_THAT(complaint(R"({"type":"trench","x":0,"y":0,"length":2,"width":1,"depth":1,)"
                        R"("path":{"period":1,"keys":[[0,0,0]]}})"),
              testing::HasSubstr("path"));
  EXPECT_THAT(complaint(R"({"type":"slope","x":0,"y":0})"),
              testing::HasSubstr("ramp, step, trench"));
}

TEST(ScenarioJson, APathMayComeAndGo) {
  const auto read = [](const std::string& flag) {
    return obstacle_from_json(json::parse(R"({"type":"cylinder","x":0,"y":0,"radius":0.25,)"
                                          R"("path":{"period":9,)" +
                                          flag + R"("keys":[[1,0,0],[3,2,0]]}})"),
                              "obstacles/0");
  };
  const algo::Obstacle person = read(R"("comes_and_goes":true,)");
  EXPECT_TRUE(person.path->comes_and_goes);
  EXPECT_EQ(obstacle_from_json(to_json(person), ""), person);
  EXPECT_FALSE(read("").path->comes_and_goes);
  EXPECT_FALSE(to_json(read(""))["path"].contains("comes_and_goes"))
      << "documents stay as they were";
  try {
    read(R"("comes_and_goes":1,)");
    ADD_FAILURE();
  } catch (const DocumentError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("obstacles/0/path/comes_and_goes"));
  }
}

TEST(ScenarioJson, PolygonPointsAreInWorldFrameOrInThatOfAGivenPose) {
  const auto world = obstacle_from_json(
      json::parse(R"({"type":"polygon","points":[[3,3],[4,3],[4,4],[3,4]]})"), "");
  EXPECT_EQ(world.pose_W, (algo::Pose2{3.5, 3.5, 0}));
  EXPECT_EQ(std::get<algo::Polygon>(world.shape).points[0], (algo::Vec2{-0.5, -0.5}));
  const auto own =
      obstacle_from_json(json::parse(R"({"type":"polygon","x":3.5,"y":3.5,)"
                                     R"("points":[[-0.5,-0.5],[0.5,-0.5],[0.5,0.5],[-0.5,0.5]]})"),
                         "");
  EXPECT_EQ(world, own);
}

TEST(ScenarioJson, AClockwisePolygonIsTurnedRound) {
  const auto clockwise = obstacle_from_json(
      json::parse(R"({"type":"polygon","points":[[3,4],[4,4],[4,3],[3,3]]})"), "");
  const auto counter = obstacle_from_json(
      json::parse(R"({"type":"polygon","points":[[3,3],[4,3],[4,4],[3,4]]})"), "");
  EXPECT_EQ(clockwise, counter);
}

TEST(ScenarioJson, GivenIdsStayAndMissingOnesAreFilledIn) {
  const sim::Scenario s =
      read(R"({"name":"a","obstacles":[{"type":"cylinder","x":3,"y":0,"radius":1},)"
           R"({"id":1,"type":"cylinder","x":6,"y":0,"radius":1},)"
           R"({"type":"cylinder","x":9,"y":0,"radius":1}]})");
  ASSERT_EQ(s.obstacles.size(), 3u);
  EXPECT_EQ(s.obstacles[0].id, 2u);
  EXPECT_EQ(s.obstacles[1].id, 1u);
  EXPECT_EQ(s.obstacles[2].id, 3u);
}

TEST(ScenarioJson, WithoutAStartHeadingTheRobotFacesItsGoal) {
  EXPECT_NEAR(read(R"({"name":"a","goal":{"x":1,"y":1}})").start.heading, M_PI / 4, 1e-12);
  EXPECT_EQ(read(R"({"name":"a","start":{"x":0,"y":0,"heading":0.5},"goal":{"x":1,"y":1}})")
                .start.heading,
            0.5);
}

TEST(ScenarioJson, WithWaypointsTheRobotFacesTheFirst) {
  const sim::Scenario s =
      read(R"({"name":"w","goal":{"x":3,"y":0},"waypoints":[{"x":0,"y":2},{"x":1,"y":2}]})");
  EXPECT_NEAR(s.start.heading, std::numbers::pi / 2, 1e-12);
  ASSERT_EQ(s.waypoints.size(), 2U);
  EXPECT_EQ(s.waypoints[1].position_W, algo::Vec2(1, 2));
}

TEST(ScenarioJson, SaysWhereAndWhat) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"([])", "document: must be an object, not array"},
      {R"({})", "name: is missing"},
      {R"({"name":"A b"})", "name: must be 1 to 64 of the characters a-z, 0-9, _ and -"},
      {R"({"name":"a","speed":1})", "document: unknown field 'speed'; known are name, title"},
      {R"({"name":"a","period":0})", "period: is 0, must lie in 0.002 to 1"},
      {R"({"name":"a","period":"x"})", "period: must be a number, not string"},
      {R"({"name":"a","goal":[1,2]})", "goal: must be an object, not array"},
      {R"({"name":"a","goal":{"x":1}})", "goal/y: is missing"},
      {R"({"name":"a","goal":{"x":1e6,"y":0}})", "goal/x: is 1e+06, must lie in -100000 to 100000"},
      {R"({"name":"a","start":{"x":0,"y":0,"z":0}})", "start: unknown field 'z'"},
      {R"({"name":"a","goal":{"x":0,"y":0,"z":0}})", "goal: unknown field 'z'"},
      {R"({"name":"a","vehicle":"car"})", "vehicle: is 'car', must be bullet or kinematic"},
      {R"({"name":"a","physics":"car"})", "physics: is 'car', must be bullet or kinematic"},
      {R"({"name":"a","physics":"bullet","vehicle":"bullet"})",
       "vehicle: cannot stand beside physics, its new name"},
      {R"({"name":"a","controller":"not one"})", "controller: 'not one' is unknown"},
      {R"({"name":"a","filter":"x"})", "filter: 'x' is unknown"},
      {R"({"name":"a","parameters":{"x":1}})", "parameters/x: there is no such parameter"},
      {R"({"name":"a","parameters":{"strip_step":0.6,"k_r":0.3}})", "parameters: strip_step"},
      {R"({"name":"a","lasers":[{},{},{},{},{}]})", "lasers: has more than 4 entries"},
      {R"({"name":"a","lasers":[{"resolution_deg":0.3}]})", "lasers/0/resolution_deg: "},
      {R"({"name":"a","lasers":[{"rolling":1}]})", "lasers/0/rolling: must be true or false"},
      {R"({"name":"a","sensors":{}})", "sensors: must be a list, not object"},
      {R"({"name":"a","sensors":[{"channel":"b"}]})", "sensors/0/sensor: is missing"},
      {R"({"name":"a","sensors":[{"sensor":"nose","channel":"b"}]})",
       "sensors/0: sensor 'nose' is unknown; known are compass, scripted"},
      {R"({"name":"a","sensors":[{"sensor":"compass","channel":"b","north":"up"}]})",
       "sensors/0/north: must be a number, not string"},
      {R"({"name":"a","sensors":[{"sensor":"compass","channel":"b"},)"
       R"({"sensor":"compass","channel":"b"}]})",
       "sensors/1/channel: 'b' is used twice"},
      {R"({"name":"a","sonar":[]})", "sonar: must be an object, not array"},
      {R"({"name":"a","sonar":{"sensors":8}})", "sonar: unknown field 'sensors'"},
      {R"({"name":"a","sonar":{"count":0}})", "sonar: count must be 1 to 64"},
      {R"({"name":"a","sonar":{"ping":0}})", "sonar: ping must be 0.001 to 1 s"},
      {R"({"name":"a","sonar":{"range_min":9}})", "sonar: range_min must be 0 to range_max"},
      {R"({"name":"a","obstacles":{}})", "obstacles: must be a list, not object"},
      {R"({"name":"a","obstacles":[{"type":"torus"}]})",
       "obstacles/0/type: 'torus' is unknown; known are cylinder, box, polygon, wall"},
      {R"({"name":"a","obstacles":[{"type":"cylinder","x":0,"y":0,"radius":0}]})",
       "obstacles/0: radius"},
      {R"({"name":"a","obstacles":[{"type":"wall","from":[0,0]}]})", "obstacles/0/to: is missing"},
      {R"({"name":"a","obstacles":[{"type":"wall","from":[0,0],"to":[1]}]})",
       "obstacles/0/to: must be a point [x, y] in metres"},
      {R"({"name":"a","obstacles":[{"type":"polygon","points":[[0,0],[1,0]]}]})",
       "obstacles/0: a polygon needs at least 3 points, this one has 2"},
      {R"({"name":"a","obstacles":[{"type":"polygon","points":[[0,0],[2,2],[2,0],[0,2]]}]})",
       "obstacles/0: the polygon crosses itself"},
      {R"({"name":"a","obstacles":[{"id":-1,"type":"cylinder","x":0,"y":0,"radius":1}]})",
       "obstacles/0/id: must be a whole number of at least 0"},
      {R"({"name":"a","time_limit":-1})", "time_limit: is -1, must lie in 0 to 1e+06"},
  };
  for (const auto& [text, sentence] : cases) {
    SCOPED_TRACE(text);
    try {
      read(text);
      ADD_FAILURE() << "was accepted";
    } catch (const DocumentError& e) {
      EXPECT_EQ(std::string(e.what()).substr(0, sentence.size()), sentence) << e.what();
    }
  }
}

TEST(ScenarioJson, RequestsSayWhereAndWhat) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"type":"fly"})", "type: 'fly' is unknown; known are set_goal, add_goal, set_goals"},
      {R"({"type":"set_goal","x":1})", "y: is missing"},
      {R"({"type":"joystick","forward":2,"turn":0})", "forward: is 2, must lie in -1 to 1"},
      {R"({"type":"remove_obstacle","id":1.5})", "id: must be a whole number of at least 0"},
      {R"({"type":"set_parameter","name":"x","value":1})", "name: there is no parameter 'x'"},
      {R"({"type":"stop","engaged":"yes"})", "engaged: must be true or false"},
      {R"({"type":"clear_goal","x":1})", "document: unknown field 'x'"},
  };
  for (const auto& [text, sentence] : cases) {
    SCOPED_TRACE(text);
    try {
      request_from_json(json::parse(text));
      ADD_FAILURE() << "was accepted";
    } catch (const DocumentError& e) {
      EXPECT_EQ(std::string(e.what()).substr(0, sentence.size()), sentence) << e.what();
    }
  }
}

TEST(ScenarioJson, AMapIsNamedBesideTheScenario) {
  const json base = {{"name", "mapped"}};
  const auto with = [&](const char* key, const json& value, bool map = true) {
    json document = base;
    if (map) document["map"] = "office.yaml";
    document[key] = value;
    return document;
  };
  const sim::Scenario scenario = scenario_from_json(with("lost", true));
  EXPECT_EQ(scenario.map, "office.yaml");
  EXPECT_TRUE(scenario.lost);
  sim::Scenario placed = scenario;
  placed.map = "/somewhere/office.yaml";
  EXPECT_EQ(to_json(placed)["map"], "office.yaml");
  EXPECT_EQ(to_json(placed)["lost"], true);
  EXPECT_FALSE(to_json(scenario_from_json(base)).contains("map"));
  for (const char* bad : {"../office.yaml", "/etc/office.yaml", "a\\b.yaml", "office.pgm"}) {
    EXPECT_THROW(scenario_from_json(with("map", bad)), DocumentError) << bad;
  }
  EXPECT_THROW(scenario_from_json(with("lost", true, false)), DocumentError);
  EXPECT_THROW(make_spec(scenario, {}), DocumentError);  // nobody said where it lies
}

}  // namespace
}  // namespace server
