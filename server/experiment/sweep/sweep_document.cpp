// server/experiment/sweep/sweep_document.cpp: reads the parts, counts the runs, then expands the
// lists.
#include "server/experiment/sweep/sweep_document.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "algo/pipeline/controllers.hpp"
#include "server/experiment/sweep/scenario_entries.hpp"
#include "server/experiment/sweep/scenario_overrides.hpp"
#include "server/run/scenario_json.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxSeed = 1'000'000'000'000;

const std::vector<std::string_view> kFields{"name",
                                            "scenarios",
                                            "controllers",
                                            "sweep",
                                            "repeats",
                                            "seed",
                                            "physics",
                                            "filter",
                                            "noise",
                                            "limits",
                                            "time_limit",
                                            "time_factor",
                                            "comparisons"};

std::size_t repeats_from_json(const JsonReader& in, std::size_t fallback) {
  const std::size_t repeats = in.whole_or("repeats", fallback, kMostRepeats);
  if (repeats == 0) in.fail("repeats", "must be at least 1");
  return repeats;
}

std::set<std::string> names_from_json(const JsonReader& in) {
  std::set<std::string> names;
  in.each("scenarios", kMostScenarios, [&](const json& value, const std::string& path) {
    if (!value.is_string()) throw DocumentError(path, "must be the name of a scenario");
    if (!names.insert(value.get<std::string>()).second) throw DocumentError(path, "stands twice");
  });
  if (names.empty()) in.fail("scenarios", "is empty");
  return names;
}

/// `repeats`: of a controller that gives none.
ControllerChoice controller_from_json(const json& value,
                                      const std::string& path,
                                      std::size_t repeats,
                                      const algo::ControllerCatalogue& catalogue) {
  ControllerChoice choice;
  const json object = value.is_string() ? json{{"name", value}} : value;
  const JsonReader in(object, path);
  in.only({"name", "label", "parameters", "repeats", "scenarios"});
  choice.name = in.text("name", 64);
  if (catalogue.find(choice.name) == nullptr) {
    std::string known;
    for (const auto& each : catalogue.entries()) {
      known += fmt::format(" {}", each.name);
    }
    in.fail("name", fmt::format("'{}' is unknown; known are{}", choice.name, known));
  }
  choice.label = in.has("label") ? in.text("label", 64) : choice.name;
  const auto breaks_a_table = [](char c) { return c == '|' || (c >= 0 && c < ' ') || c == 127; };
  if (choice.label.empty() || std::ranges::any_of(choice.label, breaks_a_table)) {
    in.fail("label", "must not be empty, nor have a | or a line break");
  }
  if (in.has("parameters")) choice.parameters = point_from_json(in.object("parameters"));
  choice.repeats = repeats_from_json(in, repeats);
  if (in.has("scenarios")) choice.only = names_from_json(in);
  return choice;
}

std::vector<ControllerChoice> controllers_from_json(const JsonReader& in,
                                                    std::size_t repeats,
                                                    const algo::ControllerCatalogue& catalogue) {
  std::vector<ControllerChoice> all;
  in.each("controllers", kMostControllers, [&](const json& value, const std::string& path) {
    all.push_back(controller_from_json(value, path, repeats, catalogue));
    const std::string& label = all.back().label;
    if (std::ranges::count(all, label, &ControllerChoice::label) > 1) {
      throw DocumentError(path, fmt::format("the label '{}' stands twice", label));
    }
  });
  if (all.empty()) in.fail("controllers", "is empty");
  return all;
}

/// A parameter must not be both swept and fixed.
void check_sweep(const Design& design, const Document& document) {
  std::set<std::string> swept;
  for (const Design::Axis& axis : design.axes) swept.emplace(axis.parameter->key());
  if (!design.list.empty()) {
    for (const auto& [key, unused] : design.list.front()) swept.insert(key);
  }
  for (std::size_t i = 0; i < document.controllers.size(); ++i) {
    for (const auto& [key, unused] : document.controllers[i].parameters) {
      if (!swept.contains(key)) continue;
      throw DocumentError(fmt::format("controllers/{}/parameters/{}", i, key),
                          "is swept too; it must be fixed or swept");
    }
  }
}

void check_count(double scenarios, double points, const Document& document) {
  double runs = 0;
  for (const ControllerChoice& each : document.controllers) {
    const double driven = each.only.empty() ? scenarios : static_cast<double>(each.only.size());
    runs += driven * points * static_cast<double>(each.repeats);
  }
  if (runs <= static_cast<double>(kMostRuns)) return;
  throw DocumentError(
      "",
      fmt::format("asks for {:.0f} runs (scenarios {:.0f}, controllers {}, swept settings {:.0f}, "
                  "repeats {}); at most {} are allowed",
                  runs,
                  scenarios,
                  document.controllers.size(),
                  points,
                  document.most_repeats(),
                  kMostRuns));
}

/// Each scenario that a controller names must be one of the document.
void check_drivers(const Document& document) {
  for (std::size_t i = 0; i < document.controllers.size(); ++i) {
    for (const std::string& name : document.controllers[i].only) {
      if (std::ranges::count(document.scenarios, name, &sim::Scenario::name) > 0) continue;
      throw DocumentError(fmt::format("controllers/{}/scenarios", i),
                          fmt::format("no scenario of the document has the name '{}'", name));
    }
  }
}

void check_label(const std::string& label, const std::string& path, const Document& document) {
  if (std::ranges::count(document.controllers, label, &ControllerChoice::label) > 0) return;
  throw DocumentError(path, fmt::format("no controller has the label '{}'", label));
}

Comparisons comparisons_from_json(const JsonReader& in, const Document& document) {
  in.only({"baseline", "others"});
  Comparisons out;
  out.baseline = in.text("baseline", 64);
  check_label(out.baseline, in.at("baseline"), document);
  if (in.has("others")) {
    in.each("others", kMostControllers, [&](const json& value, const std::string& path) {
      if (!value.is_string()) throw DocumentError(path, "must be text");
      const std::string label = value.get<std::string>();
      check_label(label, path, document);
      if (label == out.baseline) throw DocumentError(path, "is the baseline itself");
      if (std::ranges::count(out.others, label) > 0) throw DocumentError(path, "stands twice");
      out.others.push_back(label);
    });
    if (out.others.empty()) in.fail("others", "is empty");
    return out;
  }
  for (const ControllerChoice& each : document.controllers) {
    if (each.label != out.baseline) out.others.push_back(each.label);
  }
  if (out.others.empty()) in.fail("baseline", "has no other controller beside it");
  return out;
}

}  // namespace

std::size_t Document::most_repeats() const {
  return std::ranges::max_element(controllers, {}, &ControllerChoice::repeats)->repeats;
}

std::size_t Document::runs() const {
  std::size_t runs = 0;
  for (const ControllerChoice& each : controllers) {
    const std::size_t driven = each.only.empty() ? scenarios.size() : each.only.size();
    runs += driven * points.size() * each.repeats;
  }
  return runs;
}

namespace {

/// All but the scenarios. `count` counts those, before anything is made.
Document without_scenarios(const JsonReader& in,
                           std::shared_ptr<const algo::ControllerCatalogue> controllers,
                           const std::function<double()>& count) {
  in.only(kFields);
  Document document{.source = in.raw()};
  document.name = in.text("name", 64);
  if (!valid_name(document.name)) {
    in.fail("name", "must be 1 to 64 of the characters a-z, 0-9, _ and -");
  }
  document.catalogue = std::move(controllers);
  document.controllers =
      controllers_from_json(in,
                            repeats_from_json(in, 1),
                            document.catalogue ? *document.catalogue : algo::builtin_controllers());
  document.seed = in.whole_or("seed", 1, kMaxSeed);
  if (in.has("comparisons")) {
    document.comparisons = comparisons_from_json(in.object("comparisons"), document);
  }
  const Design design = design_from_json(in);
  check_sweep(design, document);
  check_count(count(), design.size(), document);
  document.points = design.points();
  return document;
}

}  // namespace

Document document_from_json(const json& source,
                            const ScenarioLibrary& library,
                            std::shared_ptr<const algo::ControllerCatalogue> controllers,
                            Files files) {
  const JsonReader in(source, "");
  Document document =
      without_scenarios(in, std::move(controllers), [&] { return count_scenarios(in, files); });
  document.scenarios = scenarios_from_json(in, library, files);
  check_drivers(document);
  override_scenarios(in, document.scenarios);
  return document;
}

Document document_with(const json& source,
                       std::vector<sim::Scenario> scenarios,
                       std::shared_ptr<const algo::ControllerCatalogue> controllers) {
  Document document = without_scenarios(JsonReader(source, ""), std::move(controllers), [&] {
    return static_cast<double>(scenarios.size());
  });
  document.scenarios = std::move(scenarios);
  check_drivers(document);
  return document;
}

}  // namespace server::sweep
