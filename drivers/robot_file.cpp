// drivers/robot_file.cpp: TOML to a RobotFile; every error names its line.
#include "drivers/robot_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/units.hpp"
#include "drivers/lms200_scan.hpp"
#include "drivers/psd_device.hpp"
#include "drivers/published_senses.hpp"
#include "drivers/robot_file_base.hpp"
#include "drivers/robot_file_ground.hpp"
#include "drivers/robot_section.hpp"
#include "drivers/scanner.hpp"

namespace drivers {
namespace {

using algo::units::kRadiansPerDegree;

constexpr double kLongestWay = 2.0;     // [m] to a standstill; a longer way is refused
constexpr double kNotedBraking = 0.5;   // [m] a longer way is a warning
constexpr double kNotedCoast = 0.2;     // [m] likewise, after the program has died
constexpr double kNotedWatchdog = 1.0;  // [s]

/// Warns of `way` [m] if `noted`; refuses the file if `way` is too long. `sentence` ends with the
/// remedy.
void judge_way(const Section& in,
               std::string_view key,
               double way,
               bool noted,
               const std::string& sentence,
               RobotFile& robot) {
  if (way > kLongestWay) {
    in.fail(key,
            "is refused: " + sentence + fmt::format(" At most {:g} m are allowed.", kLongestWay));
  }
  if (noted) {
    robot.warnings.push_back(robot.path + ":" + std::to_string(in.line_of(key)) + ": " + sentence);
  }
}

/// Whether `at` [m] lies on or within the hull.
bool on_hull(const algo::Pose2& at, const algo::RobotSpec& spec) {
  constexpr double kRounding = 1e-9;  // [m]
  if (spec.half_length == 0) return std::hypot(at.x, at.y) <= spec.radius + kRounding;
  return std::abs(at.x) <= spec.half_length + kRounding &&
         std::abs(at.y) <= spec.half_width + kRounding;
}

/// A pose; metres, and degrees only here.
algo::Pose2 read_mount(Section& in) {
  algo::Pose2 mount;
  mount.x = in.number_or("x", 0, {-5, 5});
  mount.y = in.number_or("y", 0, {-5, 5});
  mount.heading = algo::wrap_angle(in.number_or("heading_deg", 0, {-360, 360}) * kRadiansPerDegree);
  return mount;
}

/// Checks how far the robot drives before it notices that a slow scanner has gone silent.
void judge_period(const Section& in, const lms200::LaserSetup& setup, RobotFile& robot) {
  const double period = lms200::scan_period(setup.variant, setup.baud);
  const double time = blind_time(period);
  const double way = robot.limits.speed * time;
  judge_way(in,
            "rate",
            way,
            way > kNotedBraking,
            fmt::format(
                "the scanner brings a scan every {:.2f} s at this rate, so that the robot goes on "
                "blind for up to {:.2f} m ({:.2f} m/s for {:.2f} s): take a faster line or a lower "
                "speed.",
                period,
                way,
                robot.limits.speed,
                time),
            robot);
}

LaserEntry read_laser(Section& in, std::size_t number, RobotFile& robot) {
  LaserEntry laser;
  const std::string type = in.text_or("type", "lms200");
  if (type != "lms200") in.fail("type", "is '" + type + "'; it can be lms200");
  laser.port = in.port();
  laser.name = in.text_or("name", "laser " + std::to_string(number));
  laser.mount_R = read_mount(in);
  if (!on_hull(laser.mount_R, robot.spec)) {
    in.fail(
        in.has("x") ? "x" : "y",
        fmt::format("puts the scanner at ({:g}, {:g}) m, outside of the hull: obstacles in between "
                    "would be invisible",
                    laser.mount_R.x,
                    laser.mount_R.y));
  }
  lms200::LaserSetup& setup = laser.setup;
  setup.baud =
      static_cast<unsigned>(in.one_of<4>("rate", setup.baud, {9600, 19200, 38400, 500'000}));
  setup.variant.angle_degrees =
      static_cast<std::uint16_t>(in.one_of<2>("angle_deg", 180, {100, 180}));
  setup.variant.step_centidegrees =
      static_cast<std::uint16_t>(std::lround(100 * in.one_of<3>("step_deg", 0.5, {0.25, 0.5, 1})));
  setup.range = static_cast<unsigned>(in.one_of<4>("range", 8, {8, 16, 32, 80}));
  setup.upside_down = in.flag_or("upside_down", false);
  setup.password = in.text_or("password", setup.password);
  if (!lms200::good_password(setup.password)) {
    in.fail("password", "must have 8 characters of plain text");
  }
  if (const std::string why = lms200::refusal(setup); !why.empty())
    in.fail("step_deg", "is refused: " + why);
  in.done();
  judge_period(in, setup, robot);
  return laser;
}

/// Checks how far the robot drives after this program has died.
void judge_watchdog(const Section& in, RobotFile& robot) {
  const double watchdog = robot.base.watchdog;
  const double coast = robot.limits.speed * watchdog;
  judge_way(
      in,
      "watchdog",
      coast,
      coast > kNotedCoast || watchdog > kNotedWatchdog,
      fmt::format("should this program die, the robot goes on for up to {:.2f} m before its own "
                  "watchdog stops it ({:.2f} m/s for {:.2f} s): take a lower speed or a shorter "
                  "watchdog.",
                  coast,
                  robot.limits.speed,
                  watchdog),
      robot);
}

void read_limits(Section in, RobotFile& robot) {
  BaseLimits& limits = robot.limits;
  limits.speed = in.number_or("speed", limits.speed, {0.01, 2});
  limits.turn = in.number_or("turn", limits.turn, {0.01, 5});
  limits.acceleration = in.number_or("acceleration", limits.acceleration, {0.01, 5});
  robot.spec.raw_stick = in.flag_or("raw_stick", false);
  limits.turn_acceleration =
      in.number_or("turn_acceleration", limits.turn_acceleration, {0.01, 20});
  limits.jerk = in.number_or("jerk", limits.jerk, {0, 1e4});
  limits.turn_jerk = in.number_or("turn_jerk", limits.turn_jerk, {0, 1e4});
  in.done();
  const double braking = limits.speed * limits.speed / (2 * limits.acceleration);
  judge_way(in,
            "acceleration",
            braking,
            braking > kNotedBraking,
            fmt::format(
                "from {:.2f} m/s the robot needs {:.2f} m to brake (at {:.2f} m/s2): take a lower "
                "speed or a larger acceleration.",
                limits.speed,
                braking,
                limits.acceleration),
            robot);
}

void read_hull(Section in, algo::RobotSpec& spec) {
  if (in.has("radius")) {
    spec.radius = in.number("radius", {0.05, 3});
  } else {
    spec.half_length = in.number("length", {0.05, 5}) / 2;
    spec.half_width = in.number("width", {0.05, 5}) / 2;
    spec.radius = std::hypot(spec.half_length, spec.half_width);
  }
  in.done();
}

/// Whether `table` has a row named `name`.
template <class Table>
void check_known(const Section& in,
                 std::string_view key,
                 const std::string& name,
                 const Table& table) {
  std::string known;
  for (const auto& row : table) {
    if (row.name == name) return;
    known.append(known.empty() ? "" : ", ").append(row.name);
  }
  in.fail(key, "is '" + name + "'; it can be " + known);
}

/// Checks that need the whole file.
void check(const Section& top, const RobotFile& robot) {
  if (robot.spec.period > robot.base.watchdog / 3) {
    top.fail(
        "period",
        fmt::format(
            "is {:.3f} s; commands must come three times within the base's watchdog of {:.2f} s",
            robot.spec.period,
            robot.base.watchdog));
  }
  std::set<std::string> ports{robot.base.port};
  std::set<std::string> names{
      "base", psd::kDeviceName, PublishedSenses::kInclinometer, PublishedSenses::kCamera};
  if (robot.floor && !ports.insert(robot.floor->port).second) {
    top.fail("psd", "port " + robot.floor->port + " is used by two devices");
  }
  for (const LaserEntry& laser : robot.lasers) {
    if (!ports.insert(laser.port).second) {
      top.fail("laser", "port " + laser.port + " is used by two devices");
    }
    if (!names.insert(laser.name).second) {
      top.fail("laser", "name '" + laser.name + "' is used by two devices");
    }
  }
}

/// A file that says `emulated` must not be one of real devices by mistake: a copy with other ports.
/// The emulators are on pseudo-terminals, or behind their own library; a serial port is not.
void check_emulated(const RobotFile& robot) {
  const auto refuse = [&](const std::string& port, const char* missing) {
    throw RobotFileError(
        robot.path + ": 'emulated' is set, but " + port + " " + missing +
        ": start `tautline emulate` first, or leave the key out for real devices.");
  };
  const auto pseudo_terminal = [&](const std::string& port) {
    std::error_code error;
    const std::string device = std::filesystem::canonical(port, error).string();
    if (error || !device.starts_with("/dev/pts/")) refuse(port, "is no pseudo-terminal");
  };
  for (const LaserEntry& laser : robot.lasers) pseudo_terminal(laser.port);
  if (robot.floor) pseudo_terminal(robot.floor->port);
  if (const auto* analog = std::get_if<AnalogEntry>(&robot.base.setup)) {
    const std::filesystem::path library = analog->card.library;
    if (library.filename() != "libemulated_comedi.so") {
      refuse(robot.base.port, "is not behind the emulated library");
    }
  } else {
    pseudo_terminal(robot.base.port);
  }
}

RobotFile read(const toml::table& table, const std::string& name) {
  RobotFile robot;
  robot.path = name;
  Section top(table, "", name);
  algo::RobotSpec& spec = robot.spec;
  spec.name = top.text("name");
  const bool plain = std::all_of(spec.name.begin(), spec.name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!plain || spec.name.size() > 64) {
    top.fail("name", "must be of a-z, 0-9, _ and -, and no longer than 64");
  }
  spec.period = top.number_or("period", 0.05, {0.01, 0.2});
  robot.controller = top.text_or("controller", robot.controller);
  check_known(top, "controller", robot.controller, algo::builtin_controllers().entries());
  robot.external_controller = top.text_or("external_controller", "");
  robot.filter = top.text_or("filter", robot.filter);
  check_known(top, "filter", robot.filter, algo::filter_table());
  read_hull(top.table("hull"), spec);
  if (top.has("limits")) read_limits(top.table("limits"), robot);
  for (Section& laser : top.tables("laser")) {
    robot.lasers.push_back(read_laser(laser, robot.lasers.size() + 1, robot));
  }
  Section base = top.table("base");
  read_base(base, robot);
  judge_watchdog(base, robot);
  read_ground(top, robot);
  robot.emulated = top.flag_or("emulated", false);
  top.done();
  check(top, robot);

  const auto ahead = [](const LaserEntry& laser) {
    return std::abs(laser.mount_R.heading) <= std::numbers::pi / 2;
  };
  spec.has_laser = std::ranges::any_of(robot.lasers, ahead);
  if (!spec.has_laser && robot.base.sonar_mounts_R.empty()) {
    top.fail("laser", "is missing: one that looks ahead is needed, or a base with sonar");
  }
  spec.max_v = robot.limits.speed;
  spec.max_omega = robot.limits.turn;
  spec.max_acceleration = robot.limits.acceleration;
  spec.max_angular_acceleration = robot.limits.turn_acceleration;
  spec.max_jerk = robot.limits.jerk;
  spec.max_angular_jerk = robot.limits.turn_jerk;
  spec.drives = true;
  return robot;
}

}  // namespace

RobotFile parse_robot(std::string_view text, const std::string& name) {
  try {
    return read(toml::parse(text, name), name);
  } catch (const toml::parse_error& error) {
    throw RobotFileError(name + ":" + std::to_string(error.source().begin.line) + ": " +
                         std::string(error.description()));
  }
}

RobotFile read_robot_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw RobotFileError(path.string() + " is a folder, not a file.");
  }
  std::ifstream stream(path);
  if (!stream) throw RobotFileError(path.string() + " cannot be read.");
  std::ostringstream text;
  text << stream.rdbuf();
  RobotFile robot = parse_robot(text.str(), path.string());
  if (robot.emulated) check_emulated(robot);
  return robot;
}

}  // namespace drivers
