// server/run/hardware.hpp: a robot of real devices as the source of runs.
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

/// Devices that stay open from run to run, and the empty world without a goal that describes them.
struct Hardware {
  std::shared_ptr<algo::Robot> robot{};  // one with Arming
  sim::Scenario scenario{};
};

/// The scenario has the controller and the limits of the robot's file. Throws DocumentError.
std::shared_ptr<const Hardware> describe(std::shared_ptr<drivers::SerialRobot> robot);

/// The spec of runs on `hardware`. Throws DocumentError.
RunSpec hardware_spec(std::shared_ptr<const Hardware> hardware, const RunOverrides& overrides);

/// One run of it, which ends disarmed.
std::unique_ptr<algo::Robot> make_run(const Hardware& hardware);

/// As in docs/interfaces.md.
nlohmann::json to_json(const algo::HealthReport& report);
nlohmann::json to_json(const algo::LatenessHistogram& lateness);

}  // namespace server
