// tests/server/run/run_spec_test.cpp: invalid run specs.
#include "server/run/run_spec.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/run/arm_json.hpp"
#include "server/run/hardware.hpp"
#include "server/run/json_reader.hpp"

namespace server {
namespace {

TEST(RunSpec, RefusesFullContractionOfAViaThatIsKept) {
  RunOverrides overrides;
  overrides.controller = "via_kept";
  overrides.parameters = {{"k_c", 1.0}};
  try {
    make_spec({}, overrides);
    FAIL() << "made";
  } catch (const DocumentError& e) {
    EXPECT_STREQ(e.what(),
                 "parameters: k_c must be below 1 with the controller via_kept: at 1 its via point "
                 "swings from side to side and never settles");
  }
  overrides.parameters = {{"k_c", 0.95}};
  EXPECT_EQ(make_spec({}, overrides).scenario.controller, "via_kept");
  overrides.controller = "modified";
  overrides.parameters = {{"k_c", 1.0}};
  EXPECT_EQ(make_spec({}, overrides).scenario.controller, "modified");
}

/// The name of the wrong field, and why.
std::string complaint(const sim::Scenario& scenario, const RunOverrides& overrides) {
  try {
    make_spec(scenario, overrides);
  } catch (const DocumentError& e) {
    return e.what();
  }
  return "";
}

TEST(RunSpec, AHandGoalTakesThePlaceOfAllGoalsAndNeedsAnArm) {
  RunOverrides overrides;
  overrides.hand_goal = hand_goal_from_text("2.5,0,0.95,0,0.6,0,0.8", "--hand-goal");
  overrides.joints = joints_from_text("0,1.57,0,0,0,0,0.5", "--joints");
  EXPECT_EQ(complaint({}, overrides), "hand_goal: needs a robot with an arm");
  sim::Scenario scenario;
  scenario.robot = builtin_robot("silvermate_arm");
  scenario.goal = algo::SetGoal{{4, 0}, {}};
  scenario.carry = true;
  const RunSpec spec = make_spec(scenario, overrides);
  EXPECT_FALSE(spec.scenario.goal);
  EXPECT_EQ(first_requests(spec), std::vector<algo::Request>{*overrides.hand_goal});
  EXPECT_EQ(overrides.hand_goal->position_W, algo::Vec3(2.5, 0, 0.95));
  EXPECT_EQ(overrides.hand_goal->attitude_W, (algo::Quaternion{0.8, 0, 0.6, 0}));
  EXPECT_EQ(spec.scenario.joints->at(6), 0.5);
}

TEST(RunSpec, RefusesAHandGoalThatIsNoneInWords) {
  struct Case {
    const char* text;
    const char* complaint;
  };
  for (const Case& each :
       {Case{"1,2", "--hand-goal: must be x,y,z or x,y,z,qx,qy,qz,qw"},
        Case{"1,2,up", "--hand-goal: '1,2,up' is no list of numbers such as 1,0.5,2"},
        Case{"1,2,3,0,0,0,0.5", "--hand-goal/qw: and qx, qy, qz must have length 1, not 0.500"}}) {
    try {
      hand_goal_from_text(each.text, "--hand-goal");
      ADD_FAILURE() << each.text;
    } catch (const DocumentError& e) {
      EXPECT_STREQ(e.what(), each.complaint);
    }
  }
  EXPECT_THROW(joints_from_text("0,1", "--joints"), DocumentError);
}

/// The built-in controllers, and "mine" outside the program.
std::shared_ptr<const algo::ControllerCatalogue> with_mine() {
  std::vector<algo::ControllerInfo> entries = algo::builtin_controllers().entries();
  algo::ControllerInfo mine = entries.front();
  mine.name = "mine";
  mine.outside = true;
  entries.push_back(mine);
  return std::make_shared<const algo::ControllerCatalogue>(std::move(entries));
}

TEST(RunSpec, KnowsTheControllersOfItsCatalogueOnly) {
  sim::Scenario scenario;
  scenario.controller = "mine";
  EXPECT_TRUE(complaint(scenario, {}).starts_with("controller: 'mine' is unknown; known are "));
  const RunOverrides with{.controllers = with_mine()};
  const RunSpec spec = make_spec(scenario, with);
  EXPECT_TRUE(drives_from_outside(spec));
  EXPECT_EQ(run_document(spec, {}).at("answers"), "recorded");
  scenario.robots.push_back({.controller = "yours"});
  EXPECT_TRUE(complaint(scenario, with).starts_with("robots/0/controller: 'yours' is unknown"));
  scenario.robots.clear();
  scenario.controller = "modified";
  EXPECT_FALSE(run_document(make_spec(scenario, with), {}).contains("answers"));
}

TEST(RunSpec, LetsAControllerFromOutsideDriveHardwareOnlyIfTheRobotsFileNamesIt) {
  const RunOverrides with{.controller = "mine", .controllers = with_mine()};
  const auto hardware = [](const char* allowed) {
    return std::make_shared<const Hardware>(Hardware{.external_controller = allowed});
  };
  EXPECT_EQ(hardware_spec(hardware("mine"), with).scenario.controller, "mine");
  EXPECT_EQ(hardware_spec(hardware(""), {}).scenario.controller, "modified");
  for (const char* allowed : {"", "yours"}) {
    try {
      hardware_spec(hardware(allowed), with);
      FAIL() << "made";
    } catch (const DocumentError& e) {
      EXPECT_STREQ(e.what(),
                   "controller: 'mine' runs outside the program; to drive real hardware, the "
                   "robot's file must have external_controller = \"mine\"");
    }
  }
}

}  // namespace
}  // namespace server
