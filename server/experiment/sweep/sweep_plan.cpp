// server/experiment/sweep/sweep_plan.cpp: numbers the runs and makes their trials.
#include "server/experiment/sweep/sweep_plan.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "server/experiment/path_picture.hpp"
#include "server/experiment/series.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/version.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

std::string arm_label(const ControllerChoice& controller, const Point& point) {
  std::string label = controller.label;
  const char* separator = ",";
  for (const auto& [key, value] : point) {
    label += fmt::format("{} {}={:.6g}", separator, key, value);
    separator = "";
  }
  return label;
}

}  // namespace

Plan::Plan(Document document) : document_(std::move(document)) {
  for (std::size_t c = 0; c < document_.controllers.size(); ++c) {
    for (std::size_t p = 0; p < document_.points.size(); ++p) {
      const ControllerChoice& controller = document_.controllers[c];
      const Point& point = document_.points[p];
      Arm& arm = arms_.emplace_back(Arm{arm_label(controller, point), c, p, point});
      arm.parameters.insert(controller.parameters.begin(), controller.parameters.end());
    }
  }
  first_.push_back(0);
  for (const sim::Scenario& scenario : document_.scenarios) {
    for (const Arm& arm : arms_) {
      const ControllerChoice& controller = document_.controllers[arm.controller];
      first_.push_back(first_.back() + (controller.drives(scenario) ? controller.repeats : 0));
    }
  }
}

std::size_t Plan::repeats(std::size_t scenario, std::size_t arm) const {
  const std::size_t series = scenario * arms_.size() + arm;
  return first_[series + 1] - first_[series];
}

bool Plan::drives_all(std::size_t arm) const {
  const std::set<std::string>& only = document_.controllers[arms_[arm].controller].only;
  return only.empty() || only.size() == document_.scenarios.size();
}

RunPlace Plan::place(std::size_t i) const {
  // The last series that begins at or before the run; those without runs begin there too.
  const auto series =
      static_cast<std::size_t>(std::ranges::upper_bound(first_, i) - first_.begin() - 1);
  return {series / arms_.size(), series % arms_.size(), i - first_[series]};
}

std::size_t Plan::number(const RunPlace& place) const {
  return first_[place.scenario * arms_.size() + place.arm] + place.repeat;
}

RunSpec Plan::spec(std::size_t scenario, std::size_t arm, std::uint64_t seed) const {
  RunOverrides overrides;
  overrides.controller = document_.controllers[arms_[arm].controller].name;
  overrides.parameters = json(arms_[arm].parameters);
  overrides.seed = seed;
  overrides.controllers = document_.catalogue;
  return make_spec(document_.scenarios[scenario], overrides);
}

const std::vector<experiment::JudgeChoice>& judges() {
  static const std::vector<experiment::JudgeChoice> all = [] {
    std::vector<experiment::JudgeChoice> chosen = experiment::common_judges();
    chosen.push_back({.name = "motion"});
    return chosen;
  }();
  return all;
}

experiment::Trial Plan::trial(std::size_t i) const {
  const RunPlace at = place(i);
  experiment::Trial trial{.spec = spec(at.scenario, at.arm, seed(i)),
                          .judges = judges(),
                          .keep_track = keeps_track(at)};
  trial.name = fmt::format(
      "{}, {}, seed {}", document_.scenarios[at.scenario].name, arms_[at.arm].label, seed(i));
  return trial;
}

bool Plan::keeps_track(const RunPlace& place) const {
  return place.repeat == 0 && place.arm < experiment::kMostPaths &&
         place.scenario < kMostPathPictures;
}

double Plan::time_limit(std::size_t scenario, std::size_t arm) const {
  return server::time_limit(spec(scenario, arm, document_.seed));
}

std::string Plan::command(std::size_t i) const {
  const RunPlace at = place(i);
  const Arm& arm = arms_[at.arm];
  const std::string& name = document_.controllers[arm.controller].name;
  const bool outside = document_.catalogue && document_.catalogue->at(name).outside;
  std::string text = fmt::format("tautline run {} --controller {}{} --seed {}",
                                 scenario_file(document_.scenarios[at.scenario]),
                                 name,
                                 outside ? "=COMMAND" : "",
                                 seed(i));
  for (const auto& [key, value] : arm.parameters) text += fmt::format(" --set {}={}", key, value);
  return text;
}

void Plan::check(const std::stop_token& stop) const {
  for (std::size_t s = 0; s < document_.scenarios.size(); ++s) {
    if (stop.stop_requested()) return;
    const std::string& scenario = document_.scenarios[s].name;
    bool made_world = false;
    for (std::size_t a = 0; a < arms_.size(); ++a) {
      if (repeats(s, a) == 0) continue;
      const std::string path = fmt::format("controllers/{}", arms_[a].controller);
      RunSpec made;
      try {
        made = spec(s, a, document_.seed);
      } catch (const std::exception& e) {
        throw DocumentError(
            path, fmt::format("'{}' in scenario '{}': {}", arms_[a].label, scenario, e.what()));
      }
      if (made_world) continue;
      made_world = true;
      try {
        make_robot(made);
      } catch (const std::exception& e) {
        throw DocumentError("scenarios", fmt::format("'{}': {}", scenario, e.what()));
      }
    }
  }
}

json identity_of(const Document& document) {
  json scenarios = json::object();
  for (const sim::Scenario& scenario : document.scenarios) {
    scenarios[scenario.name] = hash_of({to_json(scenario), robot_document(scenario.robot)});
  }
  json figures = json::array();
  for (const experiment::JudgeChoice& judge : judges()) {
    for (const experiment::Column& column : experiment::find_judge(judge.name).columns) {
      figures.push_back(column.name);
    }
  }
  return {{"tautline", kVersion},
          {"document", document.source},
          {"scenarios", scenarios},
          {"figures", figures}};
}

std::string hash_of(const json& document) {
  // FNV-1a, 64 bits: told apart by accident, not against forgery.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : dump_json(document)) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return fmt::format("{:016x}", hash);
}

std::string scenario_file(const sim::Scenario& scenario) {
  return fmt::format("scenarios/{}.json", scenario.name);
}

}  // namespace server::sweep
