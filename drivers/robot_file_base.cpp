// drivers/robot_file_base.cpp: the [base] table of a robot's file, for each type of base.
#include "drivers/robot_file_base.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "algo/units.hpp"

namespace drivers {
namespace {

using algo::units::kRadiansPerDegree;

/// Refuses wheels that are slower than [limits] ask for.
void check_speed(const Section& in,
                 std::string_view key,
                 double fastest,
                 const BaseLimits& limits,
                 double half_track) {
  const double needed = limits.speed + limits.turn * half_track;
  if (fastest >= needed) return;
  in.fail(key,
          fmt::format("is {:.3f} m/s at the wheel, and [limits] ask for {:.3f}", fastest, needed));
}

/// Refuses encoders too coarse for odometry. `way` [m] of the wheel per count.
void check_count(const Section& in, std::string_view key, double way) {
  constexpr double kCoarsestCount = 0.01;  // [m]
  if (way <= kCoarsestCount) return;
  in.fail(
      key,
      fmt::format("makes one count {:.3f} m of the wheel's way; odometry needs {:.2f} m or less",
                  way,
                  kCoarsestCount));
}

p2os::PioneerSetup read_pioneer(Section& in, const BaseLimits& limits) {
  p2os::PioneerSetup setup;
  setup.baud =
      static_cast<unsigned>(in.one_of<5>("rate", setup.baud, {9600, 19200, 38400, 57600, 115'200}));
  setup.watchdog = in.number_or("watchdog", setup.watchdog, {0.2, 10});
  setup.units.metres_per_count = in.number_or("metres_per_count", 1e-3, {1e-5, 1e-2});
  setup.units.metres_per_second = in.number_or("speed_unit", 1e-3, {1e-5, 1e-2});
  setup.units.position_bits = static_cast<unsigned>(in.one_of<2>("position_bits", 15, {12, 15}));
  setup.sonar = in.flag_or("sonar", true);
  constexpr double kSlowest = kRadiansPerDegree;  // [rad/s] commands are whole degrees per second
  if (limits.turn < kSlowest) {
    in.fail(
        "type",
        fmt::format("is pioneer, which turns by whole degrees a second: [limits] turn must be at "
                    "least {:.4f}, not {:g}",
                    kSlowest,
                    limits.turn));
  }
  return setup;
}

roboteq::RoboteqSetup read_roboteq(Section& in) {
  roboteq::RoboteqSetup setup;
  setup.baud =
      static_cast<unsigned>(in.one_of<5>("rate", setup.baud, {9600, 19200, 38400, 57600, 115'200}));
  setup.watchdog = in.number_or("watchdog", setup.watchdog, {0.05, 5});
  setup.wheel.radius = in.number("wheel_radius", {0.01, 1});
  setup.wheel.gear = in.number("gear", {0.01, 1000});
  setup.wheel.encoder_lines = in.whole_or("encoder_lines", 0, {1, 5000});
  if (!in.has("encoder_lines")) in.fail("encoder_lines", "is missing");
  setup.wheel.full_speed_rpm = in.whole_or("full_speed_rpm", 1000, {10, 65'000});
  setup.max_current = in.number_or("max_current", 0, {0, 500});
  setup.reversed = {in.flag_or("reverse_left", false), in.flag_or("reverse_right", false)};
  setup.swapped = in.flag_or("swap_channels", false);
  setup.bumper_inputs = in.whole_list("bumper_inputs", {1, 6});
  setup.rear_bumper_inputs = in.whole_list("rear_bumper_inputs", {1, 6});
  return setup;
}

/// Refuses limits that the controller and its encoders cannot meet.
void check_roboteq(const Section& in, const roboteq::RoboteqSetup& setup) {
  constexpr double kCommands = 1000;       // steps up to the full speed
  constexpr double kLeastSteps = 5;        // up to the speed limit
  constexpr double kFastestRamp = 50'000;  // [rpm/s] the largest that a command holds
  const roboteq::Wheel& wheel = setup.wheel;
  const BaseLimits& limits = setup.limits;
  const double fastest = wheel.speed(wheel.full_speed_rpm);
  check_speed(in, "full_speed_rpm", fastest, limits, setup.half_track);
  if (limits.speed < kLeastSteps * fastest / kCommands) {
    in.fail(
        "full_speed_rpm",
        fmt::format("makes steps of {:.3f} m/s at the wheel, too coarse for a speed of {:.3f} m/s",
                    fastest / kCommands,
                    limits.speed));
  }
  check_count(in, "encoder_lines", wheel.metres(1));
  const double ramp = wheel.rpm(limits.acceleration + limits.turn_acceleration * setup.half_track);
  if (ramp > kFastestRamp) {
    in.fail(
        "gear",
        fmt::format("makes a ramp of {:.0f} rpm/s of [limits]; the controller takes {:.0f} at most",
                    ramp,
                    kFastestRamp));
  }
}

AnalogSetup read_analog(Section& in) {
  AnalogSetup setup;
  setup.watchdog = in.number_or("watchdog", setup.watchdog, {0.05, 5});
  setup.wheel_radius = in.number("wheel_radius", {0.01, 1});
  setup.counts_per_turn = in.number("counts_per_turn", {1, 1e7});
  setup.speed_per_volt = in.number("speed_per_volt", {1e-3, 10});
  setup.max_volts = in.number_or("max_volts", setup.max_volts, {0.1, 60});
  setup.gain = in.number_or("gain", setup.gain, {0, 1000});
  return setup;
}

void check_analog(const Section& in, const AnalogSetup& setup) {
  check_speed(
      in, "speed_per_volt", setup.speed_per_volt * setup.max_volts, setup.limits, setup.half_track);
  check_count(
      in, "counts_per_turn", 2 * std::numbers::pi * setup.wheel_radius / setup.counts_per_turn);
}

constexpr Limits kCardNumbers{0, 1023};  // of subdevices, channels and lines

std::optional<unsigned> read_number(Section& in, std::string_view key) {
  if (!in.has(key)) return std::nullopt;
  return static_cast<unsigned>(in.whole_or(key, 0, kCardNumbers));
}

std::vector<unsigned> read_numbers(Section& in, std::string_view key) {
  const std::vector<int> numbers = in.whole_list(key, kCardNumbers);
  return {numbers.begin(), numbers.end()};
}

/// A pair of numbers, left and right wheel.
std::optional<std::array<unsigned, 2>> read_channels(Section& in, std::string_view key) {
  if (!in.has(key)) return std::nullopt;
  const std::vector<unsigned> numbers = read_numbers(in, key);
  if (numbers.size() != 2) in.fail(key, "must be two channels, left and right, such as [0, 1]");
  return std::array{numbers[0], numbers[1]};
}

/// Refuses a digital line that two keys name: it would be both read and set, or mean two things.
void check_lines(const Section& in, const ComediSetup& setup) {
  std::set<unsigned> used;
  const auto claim = [&](const char* key, unsigned line) {
    if (!used.insert(line).second) {
      in.fail(key, "asks for digital line " + std::to_string(line) + ", which is in use already");
    }
  };
  used.insert(setup.relay_line);
  if (setup.enable_line) claim("enable_line", *setup.enable_line);
  if (setup.input_subdevice != setup.line_subdevice) used.clear();
  if (setup.relay_closed_line) claim("relay_closed_line", *setup.relay_closed_line);
  if (setup.stop_line) claim("stop_line", *setup.stop_line);
  if (setup.fault_line) claim("fault_line", *setup.fault_line);
  for (const unsigned line : setup.bumper_lines) claim("bumper_lines", line);
  for (const unsigned line : setup.rear_bumper_lines) claim("rear_bumper_lines", line);
}

ComediSetup read_card(Section& in) {
  ComediSetup setup;
  setup.library = in.text_or("library", setup.library);
  setup.output_subdevice = read_number(in, "output_subdevice");
  setup.outputs = read_channels(in, "outputs").value_or(setup.outputs);
  if (setup.outputs[0] == setup.outputs[1]) {
    in.fail("outputs", "must be two channels, left and right, not one twice");
  }
  setup.reversed_outputs = {in.flag_or("reverse_left", false), in.flag_or("reverse_right", false)};
  setup.counter_subdevices = read_numbers(in, "counter_subdevices");
  if (setup.counter_subdevices.size() > 2) {
    in.fail("counter_subdevices", "must be one for both wheels, or two: left and right");
  }
  setup.counters = read_channels(in, "counters");
  setup.reversed_counters = {in.flag_or("reverse_left_counter", false),
                             in.flag_or("reverse_right_counter", false)};
  if (in.has("counter_mode")) {
    setup.counter_mode = static_cast<unsigned>(in.whole_or("counter_mode", 0, {0, 4294967295.0}));
  }
  setup.line_subdevice = read_number(in, "line_subdevice");
  setup.input_subdevice = read_number(in, "input_subdevice");
  setup.relay_line = read_number(in, "relay_line").value_or(setup.relay_line);
  setup.enable_line = read_number(in, "enable_line");
  setup.relay_closed_line = read_number(in, "relay_closed_line");
  setup.stop_line = read_number(in, "stop_line");
  setup.fault_line = read_number(in, "fault_line");
  setup.bumper_lines = read_numbers(in, "bumper_lines");
  setup.rear_bumper_lines = read_numbers(in, "rear_bumper_lines");
  check_lines(in, setup);
  return setup;
}

/// Where the wheels stand, which must be within the hull.
void read_wheels(Section& in, algo::RobotSpec& spec) {
  const double track = in.number("track", {0.05, 1.5});
  const double width = 2 * (spec.half_length > 0 ? spec.half_width : spec.radius);
  if (track > width) {
    in.fail(
        "track",
        fmt::format("is {:g} m, and the hull is {:g} m wide: the wheels would stand outside of it",
                    track,
                    width));
  }
  spec.half_track = track / 2;
  const double half_length = spec.half_length > 0 ? spec.half_length : spec.radius;
  spec.axle = in.number_or("axle", 0, {-half_length, half_length});
}

}  // namespace

std::vector<algo::Pose2> pioneer_sonars() {
  struct Place {
    double x_mm = 0, y_mm = 0, heading_deg = 0;
  };
  // The P3-DX's rings, front then rear (AriaCoda's parameter file).
  constexpr std::array<Place, 16> kPlaces{{{69, 136, 90},
                                           {114, 119, 50},
                                           {148, 78, 30},
                                           {166, 27, 10},
                                           {166, -27, -10},
                                           {148, -78, -30},
                                           {114, -119, -50},
                                           {69, -136, -90},
                                           {-157, -136, -90},
                                           {-203, -119, -130},
                                           {-237, -78, -150},
                                           {-255, -27, -170},
                                           {-255, 27, 170},
                                           {-237, 78, 150},
                                           {-203, 119, 130},
                                           {-157, 136, 90}}};
  std::vector<algo::Pose2> out;
  out.reserve(kPlaces.size());
  for (const Place& p : kPlaces) {
    out.push_back({p.x_mm / 1000, p.y_mm / 1000, p.heading_deg * kRadiansPerDegree});
  }
  return out;
}

void read_base(Section& in, RobotFile& robot) {
  BaseEntry& base = robot.base;
  const std::string type = in.text("type");
  base.port = in.port();
  base.battery_low = in.number_or("battery_low", 0, {0, 60});
  read_wheels(in, robot.spec);
  if (type == "pioneer") {
    p2os::PioneerSetup setup = read_pioneer(in, robot.limits);
    setup.half_track = robot.spec.half_track;
    setup.limits = robot.limits;
    base.watchdog = setup.watchdog;
    if (setup.sonar) {
      for (const algo::Pose2& mount : pioneer_sonars()) {
        base.sonar_mounts_R.push_back(algo::compose({robot.spec.axle, 0, 0}, mount));
      }
    }
    base.setup = setup;
  } else if (type == "roboteq") {
    roboteq::RoboteqSetup setup = read_roboteq(in);
    setup.half_track = robot.spec.half_track;
    setup.limits = robot.limits;
    base.watchdog = setup.watchdog;
    check_roboteq(in, setup);
    base.setup = setup;
  } else if (type == "analog") {
    if (base.battery_low > 0)
      in.fail("battery_low", "cannot be watched: an analog base reports no voltage");
    AnalogEntry entry{read_analog(in), read_card(in)};
    entry.base.half_track = robot.spec.half_track;
    entry.base.limits = robot.limits;
    entry.card.max_volts = entry.base.max_volts;
    base.watchdog = entry.base.watchdog;
    check_analog(in, entry.base);
    base.setup = entry;
  } else {
    in.fail("type", "is '" + type + "'; it can be pioneer, roboteq or analog");
  }
  in.done();
}

}  // namespace drivers
