// server/run/hardware.cpp: specs and documents of real hardware.
#include "server/run/hardware.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/gate.hpp"
#include "drivers/lms200_scan.hpp"
#include "drivers/scanner.hpp"
#include "drivers/serial_robot.hpp"
#include "server/run/forwarding_robot.hpp"

namespace server {
namespace {

using nlohmann::json;

/// `wanted` clamped to the parameter's limits.
double allowed(const algo::ParameterInfo& parameter, double wanted) {
  return std::clamp(wanted, parameter.min, parameter.max);
}

/// [s] Greatest age of the newest scan, or of the newest reading of a robot with sonar only. The
/// robot already halts by its scanner's own period. This is a second safeguard, wide enough for the
/// fallback rate of a scanner.
double scan_timeout(const drivers::RobotFile& file) {
  constexpr double kSonar = 0.5;  // [s] a ring of eight takes 0.32 s
  if (!file.spec.has_laser) return kSonar;
  double longest = 0;
  for (const drivers::LaserEntry& laser : file.lasers) {
    const unsigned baud = std::min(laser.setup.baud, drivers::lms200::kFallbackRate);
    const double period = drivers::lms200::scan_period(laser.setup.variant, baud);
    // Counted from the scan's stamp: the transfer takes much of its period, and a tick may pass.
    const double under_way =
        drivers::lms200::transfer_time(drivers::lms200::scan_bytes(laser.setup.variant), baud);
    longest = std::max(longest, drivers::blind_time(period) + under_way + file.spec.period);
  }
  return longest;
}

json device_json(const algo::DeviceReport& device) {
  json facts = json::object();
  for (const auto& [name, value] : device.facts) facts[name] = value;
  return {{"name", device.name},
          {"port", device.port},
          {"well", device.well},
          {"sentence", device.sentence},
          {"remarks", device.remarks},
          {"facts", std::move(facts)}};
}

/// One run of a robot that outlives the run. Disarms it at the end.
class HardwareRun final : public ForwardingRobot {
 public:
  explicit HardwareRun(std::shared_ptr<algo::Robot> robot) : ForwardingRobot(std::move(robot)) {}
  ~HardwareRun() override { ForwardingRobot::arming()->disarm(""); }
  HardwareRun(const HardwareRun&) = delete;
  HardwareRun& operator=(const HardwareRun&) = delete;
};

}  // namespace

std::shared_ptr<const Hardware> describe(std::shared_ptr<drivers::SerialRobot> robot) {
  const drivers::RobotFile& file = robot->file();
  sim::Scenario scenario;
  scenario.name = file.spec.name;
  scenario.title = file.emulated ? "Emulated devices" : "Real hardware";
  // Without the folder: all viewers of the robot read this text.
  scenario.description = "Described in " + std::filesystem::path(file.path).filename().string();
  scenario.period = file.spec.period;
  scenario.controller = file.controller;
  scenario.filter = file.filter;
  if (!file.spec.has_laser) {
    scenario.robot.sensors.lasers.clear();
    scenario.robot.sensors.sonar.emplace();
  }
  // The robot enforces its limits in any case. Controllers should plan with them too.
  scenario.parameters = {{&algo::kMaxSpeed, allowed(algo::kMaxSpeed, file.limits.speed)},
                         {&algo::kMaxTurnRate, allowed(algo::kMaxTurnRate, file.limits.turn)},
                         {&algo::kScanTimeout, allowed(algo::kScanTimeout, scan_timeout(file))}};
  Hardware hardware{.scenario = std::move(scenario),
                    .emulated = file.emulated,
                    .external_controller = file.external_controller};
  hardware.robot = std::move(robot);
  return std::make_shared<const Hardware>(std::move(hardware));
}

RunSpec hardware_spec(std::shared_ptr<const Hardware> hardware, const RunOverrides& overrides) {
  if (!overrides.robot.is_null()) {
    throw DocumentError("robot", "cannot be chosen: this is real hardware");
  }
  if (overrides.physics) {
    throw DocumentError("physics", "cannot be chosen: this is real hardware");
  }
  RunSpec spec = make_spec(hardware->scenario, overrides);
  const std::string& controller = spec.scenario.controller;
  if (drives_from_outside(spec) && controller != hardware->external_controller) {
    throw DocumentError("controller",
                        fmt::format("'{0}' runs outside the program; to drive real hardware, the "
                                    "robot's file must have external_controller = \"{0}\"",
                                    controller));
  }
  spec.hardware = std::move(hardware);
  return spec;
}

std::unique_ptr<algo::Robot> make_run(const Hardware& hardware) {
  return std::make_unique<HardwareRun>(hardware.robot);
}

json to_json(const algo::LatenessHistogram& lateness) {
  json buckets = json::array();
  const auto& counts = lateness.counts();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool last = i == algo::LatenessHistogram::kLimits.size();
    json below = nullptr;
    if (!last) below = algo::LatenessHistogram::kLimits[i];
    buckets.push_back({{"below", std::move(below)}, {"ticks", counts[i]}});
  }
  return {
      {"ticks", lateness.ticks()}, {"worst", lateness.worst()}, {"buckets", std::move(buckets)}};
}

json to_json(const algo::HealthReport& report) {
  json devices = json::array();
  for (const algo::DeviceReport& device : report.devices) devices.push_back(device_json(device));
  return {{"armed", report.armed},
          {"halt", algo::name(report.halt)},
          {"trouble", report.trouble},
          {"devices", std::move(devices)},
          {"warnings", report.warnings},
          {"real_time", report.real_time},
          {"memory_locked", report.memory_locked},
          {"lateness", to_json(report.lateness)},
          {"missed_periods", report.missed_periods}};
}

}  // namespace server
