// server/run/hardware.hpp: a robot of real devices as a source of runs.
#pragma once

#include <memory>

#include <nlohmann/json.hpp>

#include "algo/robot.hpp"
#include "server/run/run_spec.hpp"
#include "sim/scenario.hpp"

namespace drivers {
class SerialRobot;
}

namespace server {

/// Devices that stay open from run to run, and a scenario that describes them: an empty world
/// without a goal.
struct Hardware {
  std::shared_ptr<algo::Robot> robot{};  // has algo::Arming
  sim::Scenario scenario{};
  bool emulated = false;              // its devices are those of `tautline emulate`
  std::string external_controller{};  // outside the program, and yet allowed; empty: none
};

/// Takes the scenario's controller and limits from the robot's file. Throws DocumentError.
std::shared_ptr<const Hardware> describe(std::shared_ptr<drivers::SerialRobot> robot);

/// The spec of runs on `hardware`. Throws DocumentError.
RunSpec hardware_spec(std::shared_ptr<const Hardware> hardware, const RunOverrides& overrides);

/// One run of the hardware. It ends disarmed.
std::unique_ptr<algo::Robot> make_run(const Hardware& hardware);

/// As in docs/interfaces.md.
nlohmann::json to_json(const algo::HealthReport& report);
nlohmann::json to_json(const algo::LatenessHistogram& lateness);

}  // namespace server
