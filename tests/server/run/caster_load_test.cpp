// tests/server/run/caster_load_test.cpp: robots with casters of their own drive in Bullet.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/robot_json.hpp"
#include "sim/world.hpp"

namespace server {
namespace {

using nlohmann::json;

json machine(const char* wheels_and_casters) {
  json out = json::parse(R"({
    "name": "carrier",
    "hull": {"length": 1.2, "width": 0.7, "low": 0.05, "high": 0.5},
    "mass": 200, "track": 0.6, "wheel_radius": 0.1,
    "limits": {"speed": 0.8, "turn": 1.2, "acceleration": 0.6, "turn_acceleration": 2}
  })");
  out.merge_patch(json::parse(wheels_and_casters));
  return out;
}

/// [m] what the robot makes good of 2 s at 0.4 m/s on an empty floor in Bullet.
double driven(const json& document) {
  sim::Scenario scenario;
  scenario.physics = sim::PhysicsKind::Bullet;
  scenario.robot = robot_from_json({document, ""});
  sim::World world(scenario, 1);
  algo::Observation seen;
  world.reset(seen);
  const int ticks = static_cast<int>(2 / scenario.period);
  for (int i = 0; i < ticks; ++i) world.step({{0.4, 0}}, seen);
  EXPECT_FALSE(world.ground_truth()->collided);
  return world.ground_truth()->pose.position().norm();
}

TEST(CasterLoad, EveryAcceptedRobotDrives) {
  for (
      const char* casters :
      {R"({"casters": [{"x": 0.3, "radius": 0.04}, {"x": -0.3, "radius": 0.04}]})",
       R"({"casters": [{"x": 0.3, "radius": 0.2}, {"x": -0.3, "radius": 0.2}]})",
       R"({"casters": [{"x": 0.5, "y": 0.25, "radius": 0.05}, {"x": 0.5, "y": -0.25, "radius": 0.05},
                        {"x": -0.5, "y": 0.25, "radius": 0.05}, {"x": -0.5, "y": -0.25, "radius": 0.05}]})",
       R"({"casters": [{"x": 0.3, "radius": 0.04, "raised": 0.00001},
                        {"x": -0.3, "radius": 0.04, "raised": 0.00001}]})",
       R"({"wheels": [0.5], "casters": [{"x": 0.3, "radius": 0.04}, {"x": -0.3, "radius": 0.04}]})",
       R"({"wheels": [0.3], "casters": [{"x": -0.4, "radius": 0.04}]})",
       R"({"wheels": [0.3], "casters": [{"x": -0.4, "radius": 0.04, "raised": 0}]})",
       R"({"wheels": [0.3], "casters": [{"x": -0.4, "y": 0.2, "radius": 0.04, "raised": 0},
                                         {"x": -0.4, "y": -0.2, "radius": 0.04, "raised": 0}]})",
       R"({"wheels": [-0.5], "casters": [{"x": 0.1, "y": 0.2, "radius": 0.04, "raised": 0},
                                          {"x": 0.1, "y": -0.2, "radius": 0.04, "raised": 0}]})",
       R"({"wheels": [0.3, -0.3], "casters": [{"x": 0.5, "radius": 0.04, "raised": 0.004}]})"}) {
    EXPECT_GT(driven(machine(casters)), 0.45) << casters;
  }
}

/// Casters ahead and behind, no higher than the wheels between them, leave these without load.
TEST(CasterLoad, ARobotThatItsCastersAloneCarryIsRefused) {
  for (const char* casters :
       {R"({"casters": [{"x": 0.3, "radius": 0.04, "raised": 0},
                        {"x": -0.3, "radius": 0.04, "raised": 0}]})",
        R"({"casters": [{"x": 0.3, "radius": 0.04, "raised": 0.0000001},
                        {"x": -0.3, "radius": 0.04, "raised": 0.0000001}]})",
        R"({"wheels": [-0.58], "casters": [{"x": 0.02, "y": 0.2, "radius": 0.04, "raised": 0},
                                          {"x": 0.02, "y": -0.2, "radius": 0.04, "raised": 0}]})"}) {
    try {
      robot_from_json({machine(casters), ""});
      ADD_FAILURE() << "accepted: " << casters;
    } catch (const DocumentError& e) {
      EXPECT_THAT(e.what(), testing::StartsWith("casters: they would carry the robot")) << casters;
    }
  }
}

}  // namespace
}  // namespace server
