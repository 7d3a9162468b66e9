// drivers/robot_file.cpp: TOML to a RobotFile; whatever is wrong is named with its line.
#include "drivers/robot_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include <toml++/toml.h>

#include "algo/units.hpp"
#include "drivers/text.hpp"

namespace drivers {
namespace {

using algo::units::kRadiansPerDegree;

constexpr double kLongestCoast = 0.2;  // [m] a robot may go on when this program dies

struct Limits {
  double min = 0;
  double max = 0;
};

/// One table of the file. Every key has to be asked for; done() refuses those that were not.
class Section {
 public:
  Section(const toml::table& table, std::string name, const std::string& file)
      : table_(table), name_(std::move(name)), file_(file) {}

  [[noreturn]] void fail_at(std::size_t line, const std::string& sentence) const {
    throw RobotFileError(file_ + ":" + std::to_string(line) + ": " + sentence);
  }
  [[noreturn]] void fail(std::string_view key, const std::string& sentence) const {
    const toml::node* node = table_.get(key);
    const toml::source_region& at = node != nullptr ? node->source() : table_.source();
    const std::string where = name_.empty() ? std::string(key) : name_ + " " + std::string(key);
    fail_at(at.begin.line, where + " " + sentence);
  }
  bool has(std::string_view key) const { return table_.contains(key); }

  double number(std::string_view key, Limits limits) {
    const toml::node* node = find(key);
    if (node == nullptr) fail(key, "is missing");
    const std::optional<double> value = node->value<double>();
    if (!value || !node->is_number()) fail(key, "must be a number");
    if (!(*value >= limits.min && *value <= limits.max)) {
      fail(key, format("must be %g to %g, not %g", limits.min, limits.max, *value));
    }
    return *value;
  }
  double number_or(std::string_view key, double fallback, Limits limits) {
    return has(key) ? number(key, limits) : fallback;
  }
  int whole_or(std::string_view key, int fallback, Limits limits) {
    if (!has(key)) return fallback;
    const double value = number(key, limits);
    if (value != std::floor(value)) fail(key, "must be a whole number");
    return static_cast<int>(value);
  }
  bool flag_or(std::string_view key, bool fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) fail(key, "must be true or false");
    return node->value<bool>().value_or(fallback);
  }
  std::string text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) fail(key, "is missing");
    const std::optional<std::string> value = node->value<std::string>();
    if (!value || !node->is_string()) fail(key, "must be a text in quotes");
    if (value->empty()) fail(key, "must not be empty");
    return *value;
  }
  std::string text_or(std::string_view key, std::string fallback) {
    return has(key) ? text(key) : std::move(fallback);
  }
  /// One of the numbers in `allowed`.
  template <std::size_t N>
  double one_of(std::string_view key, double fallback, const std::array<double, N>& allowed) {
    const double value = number_or(key, fallback, {-1e9, 1e9});
    if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
    std::string known;
    for (const double a : allowed) known += (known.empty() ? "" : ", ") + format("%g", a);
    fail(key, format("is %g; it can be ", value) + known);
  }
  Section table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr)
      fail_at(std::max(1U, table_.source().begin.line), "there is no [" + std::string(key) + "]");
    if (!node->is_table()) fail(key, "must be a table: [" + std::string(key) + "]");
    return {*node->as_table(), "[" + std::string(key) + "]", file_};
  }
  std::vector<Section> tables(std::string_view key) {
    std::vector<Section> out;
    const toml::node* node = find(key);
    if (node == nullptr) return out;
    const std::string name = "[[" + std::string(key) + "]]";
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) fail(key, "must be tables: " + name);
    for (const toml::node& item : *list) {
      if (!item.is_table()) fail(key, "must be tables: " + name);
      out.emplace_back(*item.as_table(), name, file_);
    }
    return out;
  }
  std::vector<int> whole_list(std::string_view key, Limits limits) {
    std::vector<int> out;
    const toml::node* node = find(key);
    if (node == nullptr) return out;
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(key, "must be a list of numbers");
    for (const toml::node& item : *list) {
      const auto value = item.value<std::int64_t>();
      if (!value || !item.is_integer() || static_cast<double>(*value) < limits.min ||
          static_cast<double>(*value) > limits.max) {
        fail(key, format("must be whole numbers from %g to %g", limits.min, limits.max));
      }
      out.push_back(static_cast<int>(*value));
    }
    return out;
  }
  void done() const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (asked_.contains(name)) continue;
      fail_at(node.source().begin.line,
              (name_.empty() ? "" : name_ + " ") + "'" + name + "' is no key known here");
    }
  }

 private:
  const toml::node* find(std::string_view key) {
    asked_.emplace(key);
    return table_.get(key);
  }

  const toml::table& table_;
  std::string name_;
  const std::string& file_;
  std::set<std::string> asked_{};
};

/// [m], and degrees at this edge alone.
algo::Pose2 read_mount(Section& in) {
  algo::Pose2 mount;
  mount.x = in.number_or("x", 0, {-5, 5});
  mount.y = in.number_or("y", 0, {-5, 5});
  mount.heading = algo::wrap_angle(in.number_or("heading_deg", 0, {-360, 360}) * kRadiansPerDegree);
  return mount;
}

LaserEntry read_laser(Section& in, std::size_t number) {
  LaserEntry laser;
  const std::string type = in.text_or("type", "lms200");
  if (type != "lms200") in.fail("type", "is '" + type + "'; it can be lms200");
  laser.port = in.text("port");
  laser.name = in.text_or("name", "laser " + std::to_string(number));
  laser.mount_R = read_mount(in);
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
  if (setup.password.size() != 8) in.fail("password", "must have 8 characters");
  in.done();
  return laser;
}

p2os::PioneerSetup read_pioneer(Section& in) {
  p2os::PioneerSetup setup;
  setup.baud =
      static_cast<unsigned>(in.one_of<5>("rate", setup.baud, {9600, 19200, 38400, 57600, 115'200}));
  setup.watchdog = in.number_or("watchdog", setup.watchdog, {0.2, 10});
  setup.units.metres_per_count = in.number_or("metres_per_count", 1e-3, {1e-5, 1e-2});
  setup.units.metres_per_second = in.number_or("speed_unit", 1e-3, {1e-5, 1e-2});
  setup.units.position_bits = static_cast<unsigned>(in.one_of<2>("position_bits", 15, {12, 15}));
  setup.sonar = in.flag_or("sonar", true);
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
  setup.max_current = in.number_or("max_current", 0, {0, 1000});
  setup.reversed = {in.flag_or("reverse_left", false), in.flag_or("reverse_right", false)};
  setup.swapped = in.flag_or("swap_channels", false);
  setup.bumper_inputs = in.whole_list("bumper_inputs", {1, 6});
  return setup;
}

void read_base(Section& in, RobotFile& robot) {
  BaseEntry& base = robot.base;
  const std::string type = in.text("type");
  base.port = in.text("port");
  base.battery_low = in.number_or("battery_low", 0, {0, 100});
  robot.spec.half_track = in.number("track", {0.05, 5}) / 2;
  if (type == "pioneer") {
    p2os::PioneerSetup setup = read_pioneer(in);
    setup.half_track = robot.spec.half_track;
    setup.limits = robot.limits;
    base.watchdog = setup.watchdog;
    if (setup.sonar) base.sonar_mounts_R = pioneer_sonars();
    base.setup = setup;
  } else if (type == "roboteq") {
    roboteq::RoboteqSetup setup = read_roboteq(in);
    setup.half_track = robot.spec.half_track;
    setup.limits = robot.limits;
    base.watchdog = setup.watchdog;
    const double fastest = setup.wheel.speed(setup.wheel.full_speed_rpm);
    const double needed = robot.limits.speed + robot.limits.turn * setup.half_track;
    if (fastest < needed) {
      in.fail("full_speed_rpm",
              format("is %.3f m/s at the wheel, and [limits] ask for %.3f", fastest, needed));
    }
    base.setup = setup;
  } else {
    in.fail("type", "is '" + type + "'; it can be pioneer or roboteq");
  }
  in.done();
}

void read_limits(Section in, RobotFile& robot) {
  BaseLimits& limits = robot.limits;
  limits.speed = in.number_or("speed", limits.speed, {0.001, 2});
  limits.turn = in.number_or("turn", limits.turn, {0.01, 5});
  limits.acceleration = in.number_or("acceleration", limits.acceleration, {0.01, 5});
  limits.turn_acceleration =
      in.number_or("turn_acceleration", limits.turn_acceleration, {0.01, 20});
  in.done();
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

/// What needs the whole file.
void check(const Section& top, RobotFile& robot) {
  const double coast = robot.limits.speed * robot.base.watchdog;
  if (coast > kLongestCoast) {
    robot.warnings.push_back(format(
        "Should this program die, the robot goes on for up to %.2f m before its own watchdog "
        "stops it (%.2f m/s for %.2f s): take a lower speed or a shorter watchdog.",
        coast,
        robot.limits.speed,
        robot.base.watchdog));
  }
  if (robot.spec.period > robot.base.watchdog / 3) {
    top.fail(
        "period",
        format("is %.3f s; commands must come three times within the base's watchdog of %.2f s",
               robot.spec.period,
               robot.base.watchdog));
  }
  std::set<std::string> ports{robot.base.port};
  std::set<std::string> names{"base"};
  for (const LaserEntry& laser : robot.lasers) {
    if (!ports.insert(laser.port).second) {
      top.fail("laser", "port " + laser.port + " is used by two devices");
    }
    if (!names.insert(laser.name).second) {
      top.fail("laser", "name '" + laser.name + "' is used by two devices");
    }
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
  robot.filter = top.text_or("filter", robot.filter);
  read_hull(top.table("hull"), spec);
  if (top.has("limits")) read_limits(top.table("limits"), robot);
  for (Section& laser : top.tables("laser")) {
    robot.lasers.push_back(read_laser(laser, robot.lasers.size() + 1));
  }
  Section base = top.table("base");
  read_base(base, robot);
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
  spec.drives = true;
  return robot;
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

RobotFile parse_robot(std::string_view text, const std::string& name) {
  try {
    return read(toml::parse(text, name), name);
  } catch (const toml::parse_error& error) {
    throw RobotFileError(name + ":" + std::to_string(error.source().begin.line) + ": " +
                         std::string(error.description()));
  }
}

RobotFile read_robot_file(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) throw RobotFileError(path.string() + " cannot be read.");
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_robot(text.str(), path.string());
}

}  // namespace drivers
