// server/emulate/robot_toml.cpp: one table after the other.
#include "server/emulate/robot_toml.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "algo/units.hpp"
#include "server/emulate/floor_rays.hpp"
#include "server/run/text_file.hpp"

namespace server::emulate {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine =
    "# Written by `tautline emulate robot`, which replaces it at its next start: edit a copy.\n";

/// A path as a TOML string; those of JSON are alike.
std::string quoted(const fs::path& path) {
  return nlohmann::json(fs::absolute(path).string()).dump();
}

/// Wheels that stand out at the sides belong to the hull of a real robot's file.
std::string hull(const sim::RobotModel& robot) {
  if (robot.round) {
    return fmt::format("\n[hull]\nradius = {}\n", std::max(robot.radius, robot.half_track));
  }
  return fmt::format("\n[hull]\nlength = {}\nwidth = {}\n",
                     robot.hull_length,
                     std::max(robot.hull_width, 2 * robot.half_track));
}

std::string laser(const EmulationOptions& options, std::size_t i) {
  const algo::Pose2& mount = options.scenario.robot.sensors.lasers[i].mount_R;
  std::string out = fmt::format(
      "\n[[laser]]\nname = \"laser {}\"\nport = {}\n", i + 1, quoted(options.scanner_links[i]));
  out += fmt::format("x = {}\ny = {}\nheading_deg = {}\n",
                     mount.x,
                     mount.y,
                     mount.heading / algo::units::kRadiansPerDegree);
  out += fmt::format("rate = {}\nstep_deg = 0.5\n", options.scanner.rs422 ? 500000 : 38400);
  if (!options.scanner.password.empty()) {
    out += fmt::format("password = {}\n", nlohmann::json(options.scanner.password).dump());
  }
  return out;
}

/// The lines of a card are wired as in drivers/emulators/analog_emulator.hpp.
std::string analog(const EmulationOptions& options, const fs::path& library) {
  const drivers::emulators::AnalogOptions made;
  std::string out = fmt::format(
      "type = \"analog\"\nlibrary = {}\nwheel_radius = {}\ncounts_per_turn = {}\n"
      "speed_per_volt = {}\nrelay_line = 0\n",
      quoted(library),
      options.scenario.robot.wheel_radius,
      made.counts_per_turn,
      made.speed_per_volt);
  const std::uint32_t lines = options.card.lines;
  if (lines > 1) out += "relay_closed_line = 1\n";
  if (lines > 2) out += "stop_line = 2\n";
  if (lines > 3) out += "fault_line = 3\n";
  if (lines > 4) out += "bumper_lines = [4]\n";
  if (lines > 5) out += "enable_line = 5\n";
  return out;
}

std::string roboteq(const sim::RobotModel& robot) {
  const drivers::roboteq::EmulatorOptions made;
  return fmt::format(
      "type = \"roboteq\"\nwheel_radius = {}\ngear = {}\nencoder_lines = {}\n"
      "full_speed_rpm = {}\nbumper_inputs = [1]\nrear_bumper_inputs = [2]\n",
      robot.wheel_radius,
      made.gear,
      made.encoder_lines,
      made.full_speed_rpm);
}

std::string base(const EmulationOptions& options, const fs::path& library) {
  const sim::RobotModel& robot = options.scenario.robot;
  std::string out = fmt::format(
      "\n[base]\nport = {}\ntrack = {}\n", quoted(options.base_link), 2 * robot.half_track);
  if (sim::axle_of(robot) != 0) out += fmt::format("axle = {}\n", sim::axle_of(robot));
  if (options.watchdog > 0) out += fmt::format("watchdog = {}\n", options.watchdog);
  if (options.base == BaseKind::P2os) return out + "type = \"pioneer\"\n";
  return out + (options.base == BaseKind::Analog ? analog(options, library) : roboteq(robot));
}

std::string floor(const EmulationOptions& options) {
  const sim::RobotModel& robot = options.scenario.robot;
  const algo::FloorSensors sensors =
      sim::spec_of(robot, options.scenario.period)
          .floor.value_or(usual_floor_sensors(robot.hull_length / 2));
  return fmt::format(
      "\n[psd]\nport = {}\nx = {}\nheight = {}\nhalf_spacing = {}\nangle_deg = {}\n"
      "separation = {}\n",
      quoted(options.psd_link),
      sensors.x,
      sensors.height,
      sensors.half_spacing,
      sensors.angle / algo::units::kRadiansPerDegree,
      sensors.separation);
}

}  // namespace

std::string robot_toml(const EmulationOptions& options, const fs::path& library) {
  std::string out(kFirstLine);
  out += "name = \"emulated\"\nemulated = true\nperiod = 0.026\n";
  out += hull(options.scenario.robot);
  out += "\n[limits]\nspeed = 0.1\n";
  for (std::size_t i = 0; i < options.scanner_links.size(); ++i) out += laser(options, i);
  out += base(options, library);
  if (!options.psd_link.empty()) out += floor(options);
  return out;
}

bool write_robot_toml(const EmulationOptions& options,
                      const fs::path& library,
                      const fs::path& file) {
  std::error_code error;
  if (fs::exists(file, error) && !read_text(file).starts_with(kFirstLine)) return false;
  write_text(file, robot_toml(options, library));
  return true;
}

}  // namespace server::emulate
