// tests/server/run/run_spec_test.cpp: invalid run specs.
#include "server/run/run_spec.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
