// server/lab/tune/tune_document.cpp: reads the document as two sweeps and a search.
#include "server/lab/tune/tune_document.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "server/experiment/judge.hpp"
#include "server/run/scenario_json.hpp"

namespace server::tune {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 6> kRates{
    "reached", "collided", "stuck", "out_of_time", "overturned", "fallen"};

Goal goal_from_json(const JsonReader& in, const std::string& field, bool maximize) {
  Goal goal{.metric = in.text(field, 64), .maximize = maximize};
  goal.is_rate = std::ranges::count(kRates, goal.metric) > 0;
  if (!goal.is_rate && experiment::find_column(goal.metric) == nullptr) {
    in.fail(field,
            fmt::format("'{}' is neither reached, collided, stuck, out_of_time, overturned or "
                        "fallen nor a figure of a run (docs/experiments.md)",
                        goal.metric));
  }
  return goal;
}

/// Of the two fields, the one that is there.
Goal one_goal(const JsonReader& in, const std::string& prefix) {
  const std::string most = prefix + "maximize";
  const std::string least = prefix + "minimize";
  if (in.has(most) == in.has(least)) in.fail(most, "or '" + least + "' must be given, one of both");
  return in.has(most) ? goal_from_json(in, most, true) : goal_from_json(in, least, false);
}

std::vector<Goal> goals_from_json(const JsonReader& in) {
  in.only({"maximize", "minimize", "then maximize", "then minimize"});
  std::vector<Goal> goals{one_goal(in, "")};
  if (!in.has("then maximize") && !in.has("then minimize")) return goals;
  goals.push_back(one_goal(in, "then "));
  if (!goals.front().is_rate) {
    in.fail(goals.front().maximize ? "maximize" : "minimize",
            "must be a rate such as reached, since something follows that decides between equals");
  }
  return goals;
}

std::vector<sweep::Design::Axis> axes_from_json(const JsonReader& in) {
  if (!in.has("parameters")) in.fail("parameters", "is missing");
  const json draws = {
      {"sweep", {{"random", {{"count", 1}, {"parameters", in.raw()["parameters"]}}}}}};
  try {
    return sweep::design_from_json(JsonReader(draws, "")).axes;
  } catch (const DocumentError& e) {
    std::string text = e.what();
    constexpr std::string_view kWhere = "sweep/random/";
    if (text.starts_with(kWhere)) text.erase(0, kWhere.size());
    throw DocumentError(text.substr(0, text.find(": ")), text.substr(text.find(": ") + 2));
  }
}

/// The document of a sweep over the scenarios in `field`, with what both parts share.
json sweep_over(const JsonReader& in, const std::string& field) {
  if (!in.has(field)) in.fail(field, "is missing");
  json out = {{"name", in.text("name", 64)},
              {"scenarios", in.raw()[field]},
              {"controllers", json::array({in.text("controller", 64)})}};
  for (const char* const shared : {"repeats", "seed", "physics", "filter", "time_limit"}) {
    if (in.has(shared)) out[shared] = in.raw()[shared];
  }
  return out;
}

/// As sweep::document_from_json(); errors name the field of this document.
sweep::Document read_part(const json& part,
                          const std::string& field,
                          const ScenarioLibrary& library,
                          const std::shared_ptr<const algo::ControllerCatalogue>& controllers) {
  try {
    return sweep::document_from_json(part, library, controllers);
  } catch (const DocumentError& e) {
    const std::string text = e.what();
    throw DocumentError(field, text);
  }
}

std::string content(const sim::Scenario& scenario) {
  json whole = to_json(scenario);
  for (const char* const words : {"name", "title", "description"}) whole.erase(words);
  return whole.dump();
}

void check_apart(const sweep::Document& training, const sweep::Document& test) {
  for (const sim::Scenario& scenario : test.scenarios) {
    const auto same = [&](const sim::Scenario& other) {
      return other.name == scenario.name || content(other) == content(scenario);
    };
    if (std::ranges::none_of(training.scenarios, same)) continue;
    throw DocumentError("test",
                        fmt::format("'{}' is a training scenario too; a test on it would say "
                                    "nothing about other scenarios",
                                    scenario.name));
  }
}

}  // namespace

json Document::test_of(const sweep::Point& tuned) const {
  json out = test;
  const json controller = test["controllers"][0];
  out["controllers"] = {{{"name", controller}, {"label", "untuned"}},
                        {{"name", controller}, {"label", "tuned"}, {"parameters", tuned}}};
  out["comparisons"] = {{"baseline", "untuned"}};
  return out;
}

Document document_from_json(const json& source,
                            const ScenarioLibrary& library,
                            const std::shared_ptr<const algo::ControllerCatalogue>& controllers) {
  const JsonReader in(source, "");
  in.only({"name",
           "controller",
           "parameters",
           "objective",
           "training",
           "test",
           "repeats",
           "seed",
           "budget",
           "physics",
           "filter",
           "time_limit"});
  Document document{.goals = goals_from_json(in.object("objective")),
                    .axes = axes_from_json(in),
                    .test = sweep_over(in, "test"),
                    .source = source};
  document.training = read_part(sweep_over(in, "training"), "training", library, controllers);
  check_apart(document.training, read_part(document.test, "test", library, controllers));
  const std::size_t each = document.training.runs();
  document.settings = in.whole("budget", sweep::kMostRuns) / each;
  const std::size_t least = 2 * (document.axes.size() + 2);
  if (document.settings < least) {
    in.fail("budget",
            fmt::format("must be at least {}: {} settings of {} training runs each",
                        least * each,
                        least,
                        each));
  }
  return document;
}

}  // namespace server::tune
