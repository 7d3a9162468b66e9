// server/experiment/sweep/scenario_entries.cpp: one reader for each kind of entry.
#include "server/experiment/sweep/scenario_entries.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "algo/pipeline/parameter_table.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/experiment/barn_file.hpp"
#include "server/experiment/layouts.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/scenario_json.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

/// Random layouts from number `seed` on.
struct LayoutGenerator {
  std::size_t count = 0;
  std::uint64_t seed = 1;
  experiment::LayoutRules rules{};
  std::optional<std::string> robot{};  // in place of the default one
};

constexpr std::uint64_t kMostObstacles = 12;  // of a layout
constexpr NumberRange kGap{0, 5};             // [m]
constexpr NumberRange kAside{0.1, 5};         // [m]
constexpr std::uint64_t kMostSeed = 1'000'000'000;

LayoutGenerator generator_from_json(const JsonReader& in) {
  in.only({"count", "seed", "obstacles", "density", "gap", "aside", "k_r", "robot"});
  LayoutGenerator out;
  out.count = in.whole("count", kMostLayouts);
  if (out.count == 0) in.fail("count", "must be at least 1");
  out.seed = in.whole_or("seed", out.seed, kMostSeed);
  experiment::LayoutRules& rules = out.rules;
  rules.gap = in.number_or("gap", rules.gap, kGap);
  rules.aside = in.number_or("aside", rules.aside, kAside);
  rules.obstacles = in.whole_or("obstacles", rules.obstacles, kMostObstacles);
  if (rules.obstacles == 0) in.fail("obstacles", "must be at least 1");
  if (in.has("density")) {
    if (in.has("obstacles")) in.fail("density", "stands beside obstacles; give one of them");
    const double area = area_of(rules);
    const double density = in.number("density", {0, static_cast<double>(kMostObstacles) / area});
    rules.obstacles = static_cast<std::size_t>(std::max(1L, std::lround(density * area)));
  }
  rules.repulsion_gain = in.number_or("k_r", rules.repulsion_gain);
  if (const auto complaint = algo::limit_refusal(algo::kRepulsionGain, rules.repulsion_gain)) {
    in.fail("k_r", *complaint);
  }
  if (in.has("robot")) out.robot = in.text("robot", 64);
  return out;
}

/// Nothing if the entry is no generator.
std::optional<LayoutGenerator> generator(const json& entry, const std::string& path) {
  if (entry.is_string()) return std::nullopt;
  const JsonReader in(entry, path);
  if (!in.has("random_layouts")) return std::nullopt;
  in.only({"random_layouts"});
  return generator_from_json(in.object("random_layouts"));
}

void add_layouts(const LayoutGenerator& layouts,
                 const std::string& path,
                 const ScenarioLibrary& library,
                 std::vector<sim::Scenario>& all) {
  std::optional<sim::RobotModel> robot;
  try {
    if (layouts.robot) robot = library.robots().load(*layouts.robot);
  } catch (const LibraryError& e) {
    throw DocumentError(path + "/random_layouts/robot", e.what());
  }
  for (std::size_t i = 0; i < layouts.count; ++i) {
    try {
      all.push_back(experiment::random_layout(layouts.rules, layouts.seed + i));
    } catch (const std::runtime_error& e) {
      throw DocumentError(path + "/random_layouts", e.what());
    }
    if (!robot) continue;
    all.back().name += "-" + *layouts.robot;
    replace_robot(all.back(), *robot);
  }
}

/// The worlds of a file; nothing if the entry names none.
std::optional<std::vector<sim::Scenario>> barn_worlds(const json& entry,
                                                      const std::string& path,
                                                      Files files) {
  if (entry.is_string()) return std::nullopt;
  const JsonReader outer(entry, path);
  if (!outer.has("barn")) return std::nullopt;
  outer.only({"barn"});
  const JsonReader in = outer.object("barn");
  in.only({"worlds", "count", "stress"});
  const std::string file = in.text("worlds");
  const std::size_t count = in.whole_or("count", kMostLayouts, kMostLayouts);
  if (count == 0) in.fail("count", "must be at least 1");
  const barn::Conditions conditions{.stress = in.flag_or("stress", false)};
  if (files == Files::Refused) {
    in.fail("worlds",
            "is a file, which only `tautline sweep` reads; put its worlds in as scenarios instead");
  }
  std::vector<sim::Scenario> all;
  try {
    for (const barn::World& world : barn::read_worlds(file)) {
      if (all.size() < count) all.push_back(scenario_of(world, conditions));
    }
  } catch (const std::runtime_error& e) {
    in.fail("worlds", e.what());
  }
  return all;
}

sim::Scenario from_library(const std::string& name,
                           const std::string& path,
                           const ScenarioLibrary& library) {
  try {
    sim::Scenario scenario = library.load(name);
    if (!scenario.log.empty()) throw DocumentError(path, "is a recorded log, not a world");
    return scenario;
  } catch (const LibraryError& e) {
    throw DocumentError(path, e.what());
  }
}

sim::Scenario from_document(const json& entry,
                            const std::string& path,
                            const ScenarioLibrary& library) {
  try {
    return scenario_from_json(entry, library.robots());
  } catch (const DocumentError& e) {
    // "obstacles/2/radius: must be above 0", or "document: ..." about the whole scenario.
    const std::string_view what = e.what();
    const std::size_t colon = what.find(": ");
    const std::string_view field = what.substr(0, colon);
    throw DocumentError(field == "document" ? path : fmt::format("{}/{}", path, field),
                        std::string(what.substr(colon + 2)));
  } catch (const LibraryError& e) {  // about a robot
    throw DocumentError(path, e.what());
  }
}

void add_entry(const json& entry,
               const std::string& path,
               const ScenarioLibrary& library,
               Files files,
               std::vector<sim::Scenario>& all) {
  if (entry.is_string()) {
    all.push_back(from_library(entry.get<std::string>(), path, library));
  } else if (const auto layouts = generator(entry, path)) {
    add_layouts(*layouts, path, library, all);
  } else if (auto worlds = barn_worlds(entry, path, files)) {
    std::ranges::move(*worlds, std::back_inserter(all));
  } else {
    all.push_back(from_document(entry, path, library));
  }
}

}  // namespace

double count_scenarios(const JsonReader& in, Files files) {
  double count = 0;
  in.each("scenarios", kMostScenarios, [&](const json& entry, const std::string& path) {
    const std::optional<LayoutGenerator> layouts = generator(entry, path);
    const auto worlds = layouts ? std::nullopt : barn_worlds(entry, path, files);
    count += static_cast<double>(layouts ? layouts->count : worlds ? worlds->size() : 1);
  });
  if (count == 0) in.fail("scenarios", "is empty");
  return count;
}

std::vector<sim::Scenario> scenarios_from_json(const JsonReader& in,
                                               const ScenarioLibrary& library,
                                               Files files) {
  std::vector<sim::Scenario> all;
  std::set<std::string> names;
  in.each("scenarios", kMostScenarios, [&](const json& entry, const std::string& path) {
    const std::size_t before = all.size();
    add_entry(entry, path, library, files, all);
    for (std::size_t i = before; i < all.size(); ++i) {
      if (!all[i].end_W()) throw DocumentError(path, "has no goal to reach");
      if (!names.insert(all[i].name).second) {
        throw DocumentError(path, fmt::format("the scenario '{}' stands twice", all[i].name));
      }
    }
  });
  return all;
}

}  // namespace server::sweep
