// drivers/lms200_device.cpp: a scanner's machine, its thread, and its report as text.
#include "drivers/lms200_device.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "algo/units.hpp"

namespace drivers::lms200 {
namespace {

constexpr const char* kSight =
    "keep the sun and other scanners out of its sight, and look at its window.";

}  // namespace

Lms200Device::Lms200Device(std::string name, const std::string& port, const LaserSetup& setup)
    : name_(std::move(name)), machine_(setup), line_(port, machine_) {}

bool Lms200Device::take(algo::LaserScan& scan) {
  bool taken = false;
  line_.look([&] { taken = machine_.take(scan); });
  return taken;
}

ScannerState Lms200Device::state() {
  ScannerState out;
  line_.look([&] {
    out.running = machine_.stage() == Stage::Running;
    out.last_scan = machine_.last_scan();
    out.period = machine_.scan_period();
    out.bad_line = machine_.storm();
    out.faulty = out.running && !machine_.health().usable();
    out.blinded = out.running && machine_.blinded();
  });
  return out;
}

LaserReport Lms200Device::details() {
  LaserReport out;
  line_.look([&] { out = machine_.report(); });
  return out;
}

bool Lms200Device::comes_to_run(double patience, const std::function<bool()>& interrupted) {
  constexpr double kLongestSetUp = 60;  // [s] six mode switches and one write of the memory
  const double begun = steady_now();
  for (;;) {
    Stage stage = Stage::NoLine;
    line_.look([&] { stage = machine_.stage(); });
    const double limit = patience + (stage == Stage::SettingUp ? kLongestSetUp : 0);
    if (stage == Stage::Running) return true;
    if (steady_now() > begun + limit || (interrupted && interrupted())) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

algo::DeviceReport Lms200Device::report() {
  algo::DeviceReport out = describe(details(), steady_now());
  out.name = name_;
  out.port = line_.path();
  return out;
}

algo::DeviceReport describe(const LaserReport& report, double now) {
  algo::DeviceReport out;
  const std::string health = health_text(report.health);
  const bool running = report.stage == Stage::Running;
  const bool storm = report.storm;
  out.well = running && report.health.usable() && !storm && !report.blinded && !report.dazzled;
  out.sentence = report.trouble;
  if (running) out.sentence = fmt::format("Well, {:.1f} scans a second.", 1.0 / report.scan_period);
  if (running && !health.empty()) out.sentence = health;
  if (running && report.dazzled) {
    out.sentence = fmt::format("It is dazzled from {:.0f} to {:.0f} degrees: ",
                               report.dazzled->from / algo::units::kRadiansPerDegree,
                               report.dazzled->to / algo::units::kRadiansPerDegree) +
                   kSight;
  }
  if (running && report.blinded) {
    out.sentence = std::string("It is blinded, most of its beams measure nothing: ") + kSight;
  }
  if (running && storm) {
    out.sentence = fmt::format(
        "{:.0f} % of its telegrams are damaged: look at the cable, its "
        "shield, and what else the port's computer does.",
        100 * report.damaged);
  }
  out.remarks = report.remarks;
  out.facts = {{"kind", "SICK LMS2xx"}};
  if (!report.type.empty()) out.facts.emplace_back("type", report.type);
  if (report.baud > 0) out.facts.emplace_back("rate", fmt::format("{} bit/s", report.baud));
  if (report.address > 0) out.facts.emplace_back("address", std::to_string(report.address));
  if (running) {
    out.facts.emplace_back("field",
                           fmt::format("{} degrees, {:.2f} degree steps",
                                       report.variant.angle_degrees,
                                       report.variant.step_centidegrees / 100.0));
    out.facts.emplace_back("unit", report.in_millimetres ? "millimetres" : "centimetres");
    out.facts.emplace_back("scan rate", fmt::format("{:.2f} Hz", 1.0 / report.scan_period));
    if (report.last_scan > 0) {
      out.facts.emplace_back("newest scan", fmt::format("{:.2f} s ago", now - report.last_scan));
    }
  }
  out.facts.emplace_back("scans", std::to_string(report.scans));
  out.facts.emplace_back("scans never read", std::to_string(report.replaced));
  out.facts.emplace_back("damaged telegrams",
                         std::to_string(report.line.bad_checks + report.line.given_up));
  return out;
}

}  // namespace drivers::lms200
