// server/run/robot_library.cpp: built-in robots come from sim/robots, embedded at build time.
#include "server/run/robot_library.hpp"

#include <map>
#include <system_error>

#include <fmt/format.h>

#include "server/run/embedded_documents.hpp"
#include "server/run/io_thread.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/library_files.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/sensor_json.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using Kind = LibraryError::Kind;
using nlohmann::json;

struct Read {
  RobotEntry entry{};
  sim::RobotModel robot{};
};

/// @param where  the file's name in messages
Read parse(const std::string& text, const std::string& where) {
  try {
    const json document = parse_json(text, kOwnDocument);
    const JsonReader in(document, "");
    Read out{.robot = robot_from_json(in)};
    out.entry = {.name = out.robot.name,
                 .title = in.text_or("title", out.robot.name),
                 .description = in.text_or("description", "")};
    return out;
  } catch (const std::exception& e) {
    throw LibraryError(Kind::Unreadable, fmt::format("{}: {}", where, e.what()));
  }
}

/// Parsed once, because every scenario names a robot.
const std::map<std::string, Read>& builtin() {
  static const auto kRobots = [] {
    std::map<std::string, Read> robots;
    for (const EmbeddedDocument& each : embedded_robots()) {
      Read read = parse(std::string(each.json), std::string(each.name));
      read.entry.builtin = true;
      robots.emplace(each.name, std::move(read));
    }
    return robots;
  }();
  return kRobots;
}

Read read_own(const fs::path& path, const std::string& shown) {
  Read read = parse(read_file(path, shown), shown);
  if (read.robot.name != path.stem().string()) {
    throw LibraryError(Kind::Unreadable,
                       fmt::format("{}: name: is '{}', must be '{}' as the file's",
                                   shown,
                                   read.robot.name,
                                   path.stem().string()));
  }
  return read;
}

}  // namespace

std::vector<RobotEntry> RobotLibrary::list() const {
  std::vector<RobotEntry> entries;
  for (const auto& [name, read] : builtin()) entries.push_back(read.entry);
  if (own_.empty()) return entries;
  net::not_on_io_thread("Listing robots");
  for_each_file(own_, ".json", [&](const fs::path& path) {
    const std::string name = path.stem().string();
    if (builtin().contains(name)) return;
    try {
      entries.push_back(read_own(path, path.filename().string()).entry);
    } catch (const LibraryError& e) {
      entries.push_back({.name = name, .title = name, .description = e.what(), .usable = false});
    }
  });
  return entries;
}

sim::RobotModel RobotLibrary::load(const std::string& name) const {
  const auto found = builtin().find(name);
  if (found != builtin().end()) return found->second.robot;
  if (!own_.empty() && valid_name(name)) {
    net::not_on_io_thread("Reading a robot");
    std::error_code error;
    const fs::path own = own_ / (name + ".json");
    if (fs::is_regular_file(own, error)) return read_own(own, own.filename().string()).robot;
  }
  std::string known;
  for (const RobotEntry& entry : list()) known += (known.empty() ? "" : ", ") + entry.name;
  throw LibraryError(Kind::NotFound, fmt::format("'{}' is unknown; known are {}", name, known));
}

sim::RobotModel RobotLibrary::load_file_or_name(const std::string& text) const {
  if (!names_file(text)) return load(text);
  return parse(read_file(text, text), text).robot;
}

sim::RobotModel builtin_robot(const std::string& name) {
  return RobotLibrary().load(name);
}

sim::RobotModel read_robot(const JsonReader& in, const RobotLibrary& robots) {
  if (in.raw()["robot"].is_object()) return robot_from_json(in.object("robot"));
  try {
    return robots.load(in.text("robot", 64));
  } catch (const LibraryError& e) {
    in.fail("robot", e.what());
  }
}

void replace_robot(sim::Scenario& scenario, const sim::RobotModel& robot) {
  for (sim::OtherRobot& other : scenario.robots) {
    if (other.robot && same_sensors(other.robot->sensors, scenario.robot.sensors)) {
      other.robot->sensors = robot.sensors;
    }
  }
  scenario.robot = robot;
  scenario.drive.max_v.reset();
  scenario.drive.max_omega.reset();
  scenario.drive.max_acceleration.reset();
  scenario.drive.max_angular_acceleration.reset();
}

void choose_robot(sim::Scenario& scenario, const json& choice, const RobotLibrary& robots) {
  if (!scenario.log.empty()) throw DocumentError("robot", "cannot be chosen for a recorded log");
  const json document = {{"robot", choice}};
  if (choice != scenario.robot.name) {
    replace_robot(scenario, read_robot({document, ""}, robots));
    return;
  }
  try {
    sim::RobotModel again = robots.load(scenario.robot.name);
    again.sensors = scenario.robot.sensors;
    scenario.robot = std::move(again);
  } catch (const LibraryError& e) {
    if (e.kind() != Kind::NotFound) throw DocumentError("robot", e.what());
    // The robot exists only in the scenario: there is no newer version.
  }
}

json robot_reference(const sim::RobotModel& robot) {
  // A name implies the default sensors too. A document lists only the differences from them.
  const auto found = builtin().find(robot.name);
  if (found != builtin().end() && static_cast<const sim::Machine&>(robot) == found->second.robot &&
      same_sensors(found->second.robot.sensors, {})) {
    return robot.name;
  }
  return to_json(robot);
}

}  // namespace server
