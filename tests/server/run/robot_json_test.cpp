// tests/server/run/robot_json_test.cpp: robot models as files: the built-in ones, a user's own, and
// the sentences about invalid ones.
#include "server/run/robot_json.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/world.hpp"

namespace server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// 1.2 x 0.7 m, two scanners, 200 kg.
json carrier() {
  return json::parse(R"({
    "name": "carrier",
    "hull": {"length": 1.2, "width": 0.7, "low": 0.05, "high": 0.5},
    "mass": 200,
    "track": 0.6,
    "wheel_radius": 0.1,
    "limits": {"speed": 0.8, "turn": 1.2, "acceleration": 0.6, "turn_acceleration": 2,
               "jerk": 3, "turn_jerk": 12},
    "lasers": [{"resolution_deg": 0.5, "mount": {"x": 0.55, "y": 0, "heading": 0}},
               {"resolution_deg": 1, "mount": {"x": -0.55, "y": 0, "heading": 3.141592653589793}}]
  })");
}

sim::RobotModel read_robot(const json& document) {
  return robot_from_json({document, ""});
}

std::string complaint(const json& document) {
  try {
    read_robot(document);
  } catch (const DocumentError& e) {
    return e.what();
  }
  return "read";
}

/// A temporary folder.
class RobotFolder : public testing::Test {
 protected:
  RobotFolder() { std::filesystem::create_directories(folder); }
  ~RobotFolder() override { std::filesystem::remove_all(folder); }
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder / file) << text;
  }
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      ("robots-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

/// Park et al. 2005: eight sonars in a front semicircle, all within 100 ms; the mass at 0.25 or 0.9
/// m.
TEST(RobotJson, TheRobhazCarriesItsRingAtEitherHeight) {
  for (const auto& [name, height] : {std::pair{"robhaz", 0.25}, std::pair{"robhaz_tall", 0.90}}) {
    const sim::RobotModel robot = builtin_robot(name);
    EXPECT_EQ(robot.mass_height, height);
    ASSERT_TRUE(robot.sensors.sonar);
    EXPECT_EQ(robot.sensors.sonar->count, 8U);
    EXPECT_FALSE(robot.sensors.sonar->crosstalk);
    const algo::RobotSpec spec = spec_of(robot, 0.02);
    EXPECT_TRUE(spec.has_ring);
    EXPECT_TRUE(robot_spec_from_json(to_json(spec)).has_ring);
  }
  json noisy = robot_document(builtin_robot("robhaz"));
  noisy["sonar"]["crosstalk"] = true;
  EXPECT_TRUE(read_robot(noisy).sensors.sonar->crosstalk);
  EXPECT_EQ(robot_document(read_robot(noisy))["sonar"]["crosstalk"], true);
}

TEST(RobotJson, BuiltInRobotsComeBackFromTheirText) {
  const std::vector<RobotEntry> entries = RobotLibrary().list();
  EXPECT_EQ(entries.size(), 6U);
  for (const RobotEntry& entry : entries) {
    SCOPED_TRACE(entry.name);
    EXPECT_TRUE(entry.builtin && entry.usable);
    const sim::RobotModel robot = builtin_robot(entry.name);
    EXPECT_TRUE(robot.climbs) << "what it climbs is measured";
    const sim::RobotModel again = read_robot(robot_document(robot));
    EXPECT_TRUE(static_cast<const sim::Machine&>(robot) == again);
    EXPECT_EQ(robot_document(robot), robot_document(again));
    // A name implies the default sensors; a robot with others is written out.
    const json reference = robot_reference(robot);
    const bool own = robot.sensors.sonar || robot.sensors.floor || robot.sensors.lasers.size() != 1;
    EXPECT_EQ(reference.is_string(), !own);
    EXPECT_EQ(reference.is_string() ? reference : reference["name"], entry.name);
  }
}

TEST(RobotJson, AnArmIsReadWithItsDefaultsAndItsSpecIsExact) {
  const sim::RobotModel robot = builtin_robot("silvermate_arm");
  ASSERT_TRUE(robot.arm);
  EXPECT_EQ(robot.arm->masses, sim::ArmModel{}.masses);
  const algo::RobotSpec spec = spec_of(robot, 0.026);
  ASSERT_TRUE(spec.arm);
  EXPECT_EQ(spec.arm->base_height, robot.hull_high);
  EXPECT_EQ(*robot_spec_from_json(to_json(spec)).arm, *spec.arm);
  EXPECT_FALSE(to_json(spec_of(builtin_robot("silvermate"), 0.026)).contains("arm"));
}

TEST(RobotJson, BadArmsGetASentenceThatNamesTheField) {
  const std::vector<std::pair<const char*, const char*>> changes{
      {R"({"mount": null})", "arm/mount: is missing"},
      {R"({"mount": {"z": 0.3}})", "arm/mount/z: must be above the hull"},
      {R"({"mount": {"roll": 1}})", "arm/mount: unknown field 'roll'"},
      {R"({"shoulder_offset": 0.1})", "arm/shoulder_offset: must be 0: the inverse knows no other"},
      {R"({"upper_arm": null})", "arm/upper_arm: is missing"},
      {R"({"forearm": 0})", "arm/forearm: is 0, must lie in"},
      {R"({"limits_deg": [170, 120]})", "arm/limits_deg: must be 7 numbers, one for each joint"},
      {R"({"limits_deg": [170, 120, 170, 140, 170, 110, 270]})", "arm/limits_deg/6: is 270"},
      {R"({"rates_deg": [0, 9, 9, 9, 9, 9, 9]})", "arm/rates_deg/0: is 0, must lie in"},
      {R"({"rest_deg": [0, 0, 0, 0, 0, 0, 0]})", "arm/rest_deg: the folded arm would be -"},
      {R"({"rest_deg": [0, 130, 0, 0, 0, 0, 0]})", "arm/rest_deg: joint 2 is beyond its limit"},
      {R"({"torques": "strong"})", "arm/torques: must be"},
      {R"({"payload": -1})", "arm/payload: is -1, must lie in"},
      {R"({"gripper": 1})", "arm: unknown field 'gripper'"},
  };
  for (const auto& [patch, said] : changes) {
    json document = robot_document(builtin_robot("silvermate_arm"));
    document["arm"].merge_patch(json::parse(patch));
    EXPECT_THAT(complaint(document), StartsWith(said)) << patch;
  }
}

TEST(RobotJson, TheRobotOfAScenarioThatNamesNoneIsTheSilvermate) {
  EXPECT_TRUE(sim::Machine() == builtin_robot("silvermate"));
  EXPECT_EQ(robot_document(sim::RobotModel()), robot_document(builtin_robot("silvermate")));
}

TEST(RobotJson, AFileNeedsOnlyRequiredFields) {
  const sim::RobotModel robot = read_robot(carrier());
  EXPECT_FALSE(robot.round);
  EXPECT_DOUBLE_EQ(robot.radius, std::hypot(0.6, 0.35));
  EXPECT_DOUBLE_EQ(robot.half_track, 0.3);
  EXPECT_DOUBLE_EQ(robot.mass_height, 0.275);
  EXPECT_EQ(robot.wheels, std::vector<double>{0});
  ASSERT_EQ(robot.casters.size(), 2U);
  EXPECT_GT(robot.casters[0].x, 0.3);
  EXPECT_FALSE(robot.climbs) << "nobody has measured them";
  ASSERT_EQ(robot.sensors.lasers.size(), 2U);
  EXPECT_EQ(robot_document(robot), robot_document(read_robot(robot_document(robot))));
}

TEST(RobotJson, BadFilesGetASentenceThatNamesTheField) {
  using Change = std::pair<const char*, const char*>;  // merge patch, part of the sentence
  const std::vector<Change> changes{
      {R"({"name": null})", "name: is missing"},
      {R"({"name": 7})", "name: must be"},
      {R"({"name": "My Robot"})", "name: must be 1 to 64 of the characters"},
      {R"({"hull": null})", "hull: is missing"},
      {R"({"hull": 3})", "hull: must be an object, not number"},
      {R"({"hull": {"length": null}})", "hull/length: is missing, or radius for a round hull"},
      {R"({"hull": {"width": null}})", "hull/width: is missing"},
      {R"({"hull": {"radius": 0.4}})", "hull/length: cannot stand beside radius"},
      {R"({"hull": {"length": -1}})", "hull/length: is -1, must lie in 0.01 to 20"},
      {R"({"hull": {"width": "wide"}})", "hull/width: must be a number, not string"},
      {R"({"hull": {"low": 0.6}})", "hull/high: must be above hull/low"},
      {R"({"hull": {"depth": 1}})", "hull: unknown field 'depth'"},
      {R"({"mass": null})", "mass: is missing"},
      {R"({"mass": 0})", "mass: is 0, must lie in"},
      {R"({"mass_height": 2})", "mass_height: must not be above the hull"},
      {R"({"track": null})", "track: is missing"},
      {R"({"track": 50})", "track: is 50, must lie in"},
      {R"({"wheel_radius": null})", "wheel_radius: is missing"},
      {R"({"wheel_radius": [0.1]})", "wheel_radius: must be a number, not array"},
      {R"({"wheels": []})", "wheels: there must be one on each side"},
      {R"({"wheels": 2})", "wheels: must be"},
      {R"({"wheels": ["front"]})", "wheels/0: must be a number, not string"},
      {R"({"wheels": [0.2, 3]})", "wheels: must be under the hull"},
      {R"({"casters": []})", "casters: the robot would tip over"},
      {R"({"casters": [{"x": 0.4, "radius": 0.04}]})", "casters: the robot would tip over"},
      {R"({"casters": [{"x": 0.4}]})", "casters/0/radius: is missing"},
      {R"({"casters": [{"x": 0.3, "radius": 0.04, "raised": 0},
                       {"x": -0.3, "radius": 0.04, "raised": 0}]})",
       "casters: they would carry the robot and leave its drive wheels without load"},
      {R"({"casters": [{"x": 5, "radius": 0.04}]})", "casters: must be under the hull"},
      {R"({"casters": [{"x": 0.58, "radius": 0.04}]})", "casters: must be under the hull"},
      {R"({"title": 7})", "title: must be"},
      {R"({"track": 3})", "track: the wheels would stand outside of the hull"},
      {R"({"track": 0.81})", "track: the wheels would stand outside of the hull"},
      {R"({"wheel_radius": 5})", "wheel_radius: the wheels would be longer than the hull"},
      {R"({"wheels": [0.3], "hull": {"length": null, "width": null, "radius": 0.35}})",
       "track: the wheels would stand outside of the hull"},
      {R"({"casters": [{"x": 0.4, "radius": 0.04, "z": 1}]})", "casters/0: unknown field 'z'"},
      {R"({"limits": null})", "limits: is missing"},
      {R"({"limits": {"speed": null}})", "limits/speed: is missing"},
      {R"({"limits": {"turn": 0}})", "limits/turn: is 0, must lie in"},
      {R"({"limits": {"acceleration": 1e9}})", "limits/acceleration: is 1e+09, must lie in"},
      {R"({"limits": {"snap": 1}})", "limits: unknown field 'snap'"},
      {R"({"friction": -0.1})", "friction: is -0.1, must lie in"},
      {R"({"counts_per_turn": 0})", "counts_per_turn: is 0, must lie in"},
      {R"({"lasers": {}})", "lasers: must be"},
      {R"({"lasers": [{"resolution_deg": 0.3}]})", "lasers/0/resolution_deg: "},
      {R"({"lasers": [{"range": 30}]})", "lasers/0: unknown field 'range'"},
      {R"({"lasers": [{"mount": {"x": 500, "y": 3}}]})",
       "lasers/0/mount/x: is 500, must lie in -10 to 10"},
      {R"({"lasers": [{"mount": {"x": 0.5, "y": -11}}]})", "lasers/0/mount/y: is -11, must lie in"},
      {R"({"lasers": [{"mount": {"x": 0.5, "y": 0, "heading": 180}}]})",
       "lasers/0/mount/heading: is 180, more than a turn: angles are in radians"},
      {R"({"infrared": [{"mount": {"x": 0.5, "y": 0, "heading": -90}}]})",
       "infrared/0/mount/heading: is -90, more than a turn: angles are in radians"},
      {R"({"lasers": [{"field_of_view_deg": 270, "beams": 0}]})",
       "lasers/0/beams: is 0, must be at least 2"},
      {R"({"lasers": [{"field_of_view_deg": 270, "beams": 1}]})",
       "lasers/0/beams: is 1, must be at least 2"},
      {R"({"sonar": {"count": 0}})", "sonar: "},
      {R"({"infrared": [{"beams": 1000}]})", "infrared/0/beams: is 1000, must be at most 361"},
      {R"({"bumpers": 9})", "bumpers: is 9, must be at most 8"},
      {R"({"sensors": [{"sensor": "nose", "channel": "smell"}]})", "sensors/0: "},
      {R"({"colour": "red"})", "document: unknown field 'colour'"},
  };
  EXPECT_GE(changes.size(), 30U);
  for (const auto& [patch, said] : changes) {
    json document = carrier();
    document.merge_patch(json::parse(patch));
    EXPECT_THAT(complaint(document), StartsWith(said)) << patch;
  }
  EXPECT_THAT(complaint(json::array()), HasSubstr("must be an object, not array"));
}

TEST_F(RobotFolder, InvalidFilesAreListedWithTheReasonAndNotLoaded) {
  write("carrier.json", carrier().dump());
  write("other.json", carrier().dump());
  write("broken.json", "{\"name\": ");
  write("jackal.json", carrier().dump());  // the built-in one keeps its name
  write("Not A Name.json", carrier().dump());
  const RobotLibrary library(folder);
  std::vector<std::string> usable;
  std::vector<std::string> not_usable;
  for (const RobotEntry& entry : library.list()) {
    if (entry.builtin) continue;
    (entry.usable ? usable : not_usable).push_back(entry.name);
    if (entry.name == "other") {
      EXPECT_EQ(entry.description, "other.json: name: is 'carrier', must be 'other' as the file's");
    }
  }
  EXPECT_EQ(usable, std::vector<std::string>{"carrier"});
  EXPECT_EQ(not_usable, (std::vector<std::string>{"broken", "other"}));
  EXPECT_EQ(library.load("carrier").mass, 200);
  EXPECT_EQ(library.load("jackal").mass, 17);
  EXPECT_THROW(library.load("broken"), LibraryError);
  EXPECT_THROW(library.load("../carrier"), LibraryError);
  try {
    library.load("tank");
    ADD_FAILURE() << "there is no tank";
  } catch (const LibraryError& e) {
    EXPECT_STREQ(e.what(),
                 "'tank' is unknown; known are jackal, masuda, robhaz, robhaz_tall, silvermate, "
                 "silvermate_arm, broken, carrier, "
                 "other");
  }
  EXPECT_EQ(library.load_file_or_name((folder / "other.json").string()).name, "carrier");
}

TEST_F(RobotFolder, AScenarioKeepsTheWholeModelOfAUsersRobot) {
  write("carrier.json", carrier().dump());
  const RobotLibrary library(folder);
  const sim::Scenario scenario = scenario_from_json(
      json::parse(R"({"name":"hall","robot":"carrier","goal":{"x":4,"y":1}})"), library);
  EXPECT_EQ(scenario.robot.sensors.lasers.size(), 2U);
  const json written = to_json(scenario);
  const sim::Scenario again = scenario_from_json(written);  // without the folder
  EXPECT_EQ(written, to_json(again));
  EXPECT_EQ(again.robot.mass, 200);
  EXPECT_EQ(again.robot.sensors.lasers.size(), 2U);
}

TEST_F(RobotFolder, TheSensorsOfAScenarioReplaceThoseOfItsRobot) {
  write("carrier.json", carrier().dump());
  const sim::Scenario scenario = scenario_from_json(
      json::parse(R"({"name":"a","robot":"carrier","lasers":[{}]})"), RobotLibrary(folder));
  EXPECT_EQ(scenario.robot.sensors.lasers.size(), 1U);
}

TEST_F(RobotFolder, ARobotIsChosenByNameOrWhole) {
  write("carrier.json", carrier().dump());
  const RobotLibrary library(folder);
  const sim::Scenario sensors = ScenarioLibrary({}, {}).load("sensors");
  RunOverrides overrides;
  overrides.robot = "carrier";
  const RunSpec by_name = make_spec(sensors, overrides, library);
  EXPECT_EQ(by_name.scenario.robot.name, "carrier");
  EXPECT_FALSE(by_name.scenario.robot.sensors.sonar);  // the scenario's ring is the Silvermate's
  overrides.robot = carrier();
  EXPECT_EQ(make_spec(sensors, overrides).scenario.robot.mass, 200);
  overrides.robot = "silvermate";  // its own
  EXPECT_EQ(to_json(make_spec(sensors, overrides).scenario)["sonar"], to_json(sensors)["sonar"]);
  overrides.robot = "tank";
  EXPECT_THROW(make_spec(sensors, overrides), DocumentError);
}

TEST(RobotJson, AScenarioCanAddAGyro) {
  json robot = carrier();
  robot["gyro"] = false;
  json document = {{"name", "a"}, {"robot", robot}};
  EXPECT_FALSE(scenario_from_json(document).robot.sensors.has_gyro);
  document["gyro"] = {{"noise", 0.01}};
  const sim::Scenario scenario = scenario_from_json(document);
  EXPECT_TRUE(scenario.robot.sensors.has_gyro);
  EXPECT_EQ(to_json(scenario), to_json(scenario_from_json(to_json(scenario))));
}

TEST(RobotJson, AScenarioCanRemoveTheSonar) {
  json robot = carrier();
  robot["sonar"] = json::object();
  const json document = {{"name", "a"}, {"robot", robot}, {"sonar", false}};
  EXPECT_FALSE(scenario_from_json(document).robot.sensors.sonar);
}

TEST(RobotJson, ASensorOnAMastBesideTheHullIsLegal) {
  json document = carrier();
  document["lasers"] = json::parse(R"([{"mount": {"x": 2.5, "y": -1, "heading": 6.2831853}}])");
  EXPECT_NEAR(read_robot(document).sensors.lasers[0].mount_R.heading, 0, 1e-6);
}

/// Without them the robot would wait for its first scan until the time is up.
TEST(RobotJson, ARobotThatSeesNothingAheadCannotRun) {
  const auto refusal = [](const char* sensors) -> std::string {
    json robot = carrier();
    robot.merge_patch(json::parse(sensors));
    try {
      make_spec(scenario_from_json({{"name", "a"}, {"robot", robot}}), {});
    } catch (const DocumentError& e) {
      return e.what();
    }
    return "runs";
  };
  for (const char* sensors : {R"({"lasers": []})",
                              R"({"lasers": [{"mount": {"x": -0.5, "y": 0, "heading": 3.14}}]})",
                              R"({"lasers": [], "infrared": [{}]})"}) {
    EXPECT_THAT(refusal(sensors), StartsWith("lasers: none looks ahead, and there is no sonar"))
        << sensors;
  }
  EXPECT_THAT(refusal(R"({"lasers": [], "sonar": {}})"), HasSubstr("'modified' needs a laser"));
  EXPECT_EQ(refusal(R"({"lasers": [{"mount": {"x": 0.5, "y": 0, "heading": 1.5}}]})"), "runs");
}

TEST(RobotJson, AFurtherRobotIsCheckedByItsOwnScanners) {
  json blind = carrier();
  blind["lasers"] = json::array();
  blind["sonar"] = json::object();
  json document = {{"name", "a"},
                   {"controller", "modified"},
                   {"robots", {{{"start", {{"x", 5}, {"y", 5}}}, {"robot", blind}}}}};
  try {
    make_spec(scenario_from_json(document), {});
    ADD_FAILURE() << "it cannot see";
  } catch (const DocumentError& e) {
    EXPECT_THAT(e.what(), StartsWith("robots/0/controller: 'modified' needs a laser"));
  }
  document["robots"][0]["controller"] = "vfh";
  EXPECT_NO_THROW(make_spec(scenario_from_json(document), {}));
}

TEST(RobotJson, AChosenRobotDrivesWithinItsOwnLimits) {
  sim::Scenario people = ScenarioLibrary({}, {}).load("people");
  ASSERT_TRUE(people.drive.max_v);
  people.robots.push_back({.start = {50, 0, 0}, .robot = builtin_robot("jackal")});
  people.robots.back().robot->sensors = people.robot.sensors;
  RunOverrides overrides;
  overrides.robot = carrier();
  const sim::Scenario chosen = make_spec(people, overrides).scenario;
  EXPECT_FALSE(chosen.drive.max_v || chosen.drive.max_omega || chosen.drive.max_acceleration);
  EXPECT_EQ(chosen.robots.back().robot->sensors.lasers.size(), 2U);
  overrides.robot = people.robot.name;
  EXPECT_EQ(make_spec(people, overrides).scenario.drive, people.drive);
}

TEST_F(RobotFolder, TheNewestModelOfTheSameNameDrivesWithTheScenariosSensors) {
  write("carrier.json", carrier().dump());
  sim::Scenario scenario = scenario_from_json(
      json::parse(R"({"name":"a","robot":"carrier","lasers":[{}]})"), RobotLibrary(folder));
  json heavier = carrier();
  heavier["mass"] = 300;
  write("carrier.json", heavier.dump());
  RunOverrides overrides;
  overrides.robot = "carrier";
  const sim::RobotModel robot = make_spec(scenario, overrides, RobotLibrary(folder)).scenario.robot;
  EXPECT_EQ(robot.mass, 300);
  EXPECT_EQ(robot.sensors.lasers.size(), 1U);
  EXPECT_EQ(make_spec(scenario, overrides).scenario.robot.mass, 200);  // no newer one there
}

TEST(RobotJson, AcceptedModelsReadBack) {
  for (const char* patch : {R"({"hull": {"low": 0, "high": 0.0015}})",
                            R"({"hull": {"length": 0.05, "width": 0.05}, "track": 0.05,
                                "wheel_radius": 0.02})"}) {
    json document = carrier();
    document.merge_patch(json::parse(patch));
    const json written = robot_document(read_robot(document));
    EXPECT_EQ(written, robot_document(read_robot(written))) << patch;
  }
}

TEST(RobotJson, AUsersRobotDrivesWithItsTwoScanners) {
  for (const sim::PhysicsKind physics : {sim::PhysicsKind::Bullet, sim::PhysicsKind::Kinematic}) {
    SCOPED_TRACE(physics == sim::PhysicsKind::Bullet ? "bullet" : "kinematic");
    RunOverrides overrides;
    overrides.robot = carrier();
    overrides.physics = physics;
    const RunSpec spec = make_spec(ScenarioLibrary({}, {}).load("case3"), overrides);
    sim::World world(spec.scenario, 1);
    EXPECT_EQ(world.spec().name, "carrier");
    EXPECT_DOUBLE_EQ(world.spec().half_length, 0.6);
    EXPECT_DOUBLE_EQ(world.spec().max_v, 0.8);
    algo::Observation seen;
    world.reset(seen);
    std::set<double> mounts;  // [m] x of those that scanned
    for (int i = 0; i < 40; ++i) {
      world.step({{0.4, 0}}, seen);
      for (const algo::LaserScan& scan : seen.scans) mounts.insert(scan.mount_R.x);
    }
    EXPECT_EQ(mounts, (std::set<double>{-0.55, 0.55}));
    const algo::GroundTruth truth = *world.ground_truth();
    EXPECT_NEAR(truth.pose.position().norm(), 0.4 * 40 * spec.scenario.period, 0.15);
    EXPECT_FALSE(truth.collided);
  }
}

}  // namespace
}  // namespace server
