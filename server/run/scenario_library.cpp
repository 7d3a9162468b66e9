// server/run/scenario_library.cpp: built-in worlds come from sim/worlds, embedded at build time.
#include "server/run/scenario_library.hpp"

#include <mutex>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/run/embedded_documents.hpp"
#include "server/run/io_thread.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/map_file.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using Kind = LibraryError::Kind;

constexpr std::size_t kMostOwn = 1000;

std::mutex writing;  // two concurrent saves must not share a draft

sim::Scenario parse(const std::string& text, const std::string& where, const RobotLibrary& robots) {
  try {
    return scenario_from_json(parse_json(text, kOwnDocument), robots);
  } catch (const std::exception& e) {
    throw LibraryError(Kind::Unreadable, fmt::format("{}: {}", where, e.what()));
  }
}

const EmbeddedDocument* find_embedded(const std::string& name) {
  for (const EmbeddedDocument& world : embedded_worlds()) {
    if (world.name == name) return &world;
  }
  return nullptr;
}

sim::Scenario with_map_in(const fs::path& folder, sim::Scenario scenario) {
  if (!scenario.map.empty() && !folder.empty()) {
    scenario.map = (fs::absolute(folder) / scenario.map).string();
  }
  return scenario;
}

}  // namespace

ScenarioLibrary::ScenarioLibrary(fs::path own, fs::path logs, RobotLibrary robots, fs::path map)
    : own_(std::move(own)),
      logs_(std::move(logs)),
      robots_(std::move(robots)),
      map_(std::move(map)) {}

std::vector<ScenarioEntry> ScenarioLibrary::list() const {
  net::not_on_io_thread("Listing scenarios");
  std::vector<ScenarioEntry> entries;
  for (const EmbeddedDocument& world : embedded_worlds()) {
    const sim::Scenario s = parse(std::string(world.json), std::string(world.name), robots_);
    entries.push_back({s.name, s.title, s.description, true, false});
  }
  for_each_file(own_, ".json", [&](const fs::path& path) {
    try {
      const std::string shown = path.filename().string();
      const sim::Scenario s = parse(read_file(path, shown), shown, robots_);
      entries.push_back({path.stem().string(), s.title, s.description, false, false});
    } catch (const LibraryError& e) {
      entries.push_back({path.stem().string(), path.stem().string(), e.what(), false, false});
    }
  });
  for_each_file(logs_, ".log", [&](const fs::path& path) {
    const sim::Scenario s = from_log(path);
    entries.push_back({s.name, s.title, s.description, true, true});
  });
  return entries;
}

bool ScenarioLibrary::has(const std::string& name) const {
  std::error_code error;
  return find_embedded(name) != nullptr ||
         (valid_name(name) && !own_.empty() && fs::is_regular_file(own_ / (name + ".json"), error));
}

sim::Scenario ScenarioLibrary::load(const std::string& name) const {
  net::not_on_io_thread("Reading a scenario");
  if (const EmbeddedDocument* world = find_embedded(name)) {
    return parse(std::string(world->json), name, robots_);
  }
  if (valid_name(name)) {
    std::error_code error;
    const fs::path own = own_ / (name + ".json");
    if (!own_.empty() && fs::is_regular_file(own, error)) {
      const std::string shown = own.filename().string();
      return placed(parse(read_file(own, shown), shown, robots_));
    }
    const fs::path log = logs_ / (name + ".log");
    if (!logs_.empty() && fs::is_regular_file(log, error)) return from_log(log);
  }
  std::string known;
  for (const ScenarioEntry& entry : list()) known += (known.empty() ? "" : ", ") + entry.name;
  throw LibraryError(Kind::NotFound,
                     fmt::format("There is no scenario '{}'. Known are {}.", name, known));
}

sim::Scenario ScenarioLibrary::placed(sim::Scenario scenario) const {
  std::error_code error;
  const bool names_it = !map_.empty() && scenario.map == map_.filename();
  if (names_it && !fs::exists(own_ / scenario.map, error)) scenario.map = map_.string();
  return with_map_in(own_, std::move(scenario));
}

sim::Scenario ScenarioLibrary::save(sim::Scenario scenario) const {
  if (!valid_name(scenario.name)) {
    throw LibraryError(
        Kind::BadName,
        fmt::format("'{}' is no name: 1 to 64 of the characters a-z, 0-9, _ and -", scenario.name));
  }
  if (find_embedded(scenario.name) != nullptr) {
    throw LibraryError(
        Kind::Builtin,
        fmt::format("'{}' is built in and cannot be changed; save it under another name.",
                    scenario.name));
  }
  net::not_on_io_thread("Saving a scenario");
  std::optional<algo::OccupancyMap> map;
  if (fs::path(scenario.map).has_parent_path()) {
    map = read_map(scenario.map);
    scenario.map = own_map(scenario.name).filename().string();
  }
  const std::string text = dump_json(to_json(scenario)) + '\n';
  parse(text, scenario.name, robots_);  // refuse a scenario that could not be loaded again
  const std::lock_guard lock(writing);
  std::error_code error;
  fs::create_directories(own_, error);
  const fs::path target = own_ / (scenario.name + ".json");
  if (!fs::exists(target, error)) {
    std::size_t count = 0;
    for_each_file(own_, ".json", [&](const fs::path&) { ++count; });
    if (count >= kMostOwn) {
      throw LibraryError(
          Kind::NoRoom,
          fmt::format("You have {} scenarios of your own, as many as may. Delete one.", count));
    }
  }
  try {
    if (map) write_map(*map, own_map(scenario.name));
    replace_text(target, text);
    return scenario;
  } catch (const std::exception&) {
    throw LibraryError(
        Kind::NoRoom,
        fmt::format("Cannot write {}. Is the disk full?", target.filename().string()));
  }
}

void ScenarioLibrary::remove(const std::string& name) const {
  if (find_embedded(name) != nullptr) {
    throw LibraryError(Kind::Builtin, fmt::format("'{}' is built in and cannot be deleted.", name));
  }
  net::not_on_io_thread("Deleting a scenario");
  const std::lock_guard lock(writing);
  std::error_code error;
  if (!valid_name(name) || !fs::remove(own_ / (name + ".json"), error)) {
    throw LibraryError(Kind::NotFound, fmt::format("You have no scenario '{}' of your own.", name));
  }
  fs::remove(own_map(name), error);
  fs::remove(picture_beside(own_map(name)), error);
}

/// The copy of a saved scenario's map. No scenario's name has a dot.
fs::path ScenarioLibrary::own_map(const std::string& name) const {
  return own_ / (name + ".map.yaml");
}

sim::Scenario ScenarioLibrary::from_file(const fs::path& path, const RobotLibrary& robots) {
  if (path.extension() == ".log") return from_log(path);
  return with_map_in(fs::absolute(path).parent_path(),
                     parse(read_file(path, path.string()), path.string(), robots));
}

sim::Scenario ScenarioLibrary::from_log(const fs::path& path) {
  sim::Scenario s;
  s.name = path.stem().string();
  s.title = "Log " + path.filename().string();
  s.description = "A recorded laser log, replayed through the same pipeline.";
  s.robot.name = "log";
  s.log = path.string();
  return s;
}

}  // namespace server
