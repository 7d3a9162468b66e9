// server/experiment/sweep/report_sections.cpp: the words around the tables.
#include "server/experiment/sweep/report_sections.hpp"

#include <fmt/format.h>

#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/version.hpp"

namespace server::sweep {
namespace {

constexpr std::size_t kFewScenarios = 10;

constexpr const char* kRates =
    "Count of runs / runs that ended, rate [95 % interval]. Runs that failed, were stuck or ran "
    "out "
    "of time stay in the denominator. ";

constexpr const char* kFiguresText =
    "Clearances, infringed and standing time are of all runs, the other figures of those that "
    "reached their goal; n is their number. Quantiles are linear between order statistics "
    "(definition 7 of "
    "Hyndman and Fan). ";

constexpr const char* kPairs =
    "Pairs of runs have the same scenario, seed and swept setting; a run without a partner is left "
    "out. ";

constexpr const char* kTests =
    "Differences are other minus baseline, their mean with a BCa interval. Times are of pairs that "
    "both reached. The effect is the matched-pairs rank-biserial correlation, from -1 (every "
    "difference is negative) to 1. Holm's correction covers all tests of this table.";

/// How many scenarios and seeds there are decides what one independent observation is.
const char* unit_text(const Plan& plan) {
  if (plan.document().scenarios.size() == 1) {
    return "There is one scenario: Wilson's interval over its seeds, which says nothing about "
           "other "
           "scenarios.";
  }
  if (plan.document().most_repeats() == 1) {
    return "Wilson's interval: each scenario has one run, so the runs are independent.";
  }
  return "Seeds of one scenario give nearly the same run, so the scenario is the unit: BCa "
         "interval "
         "from 2000 resamples of whole scenarios. If all scenarios have the same rate, such as 0: "
         "Wilson's interval with the number of scenarios in place of the number of runs.";
}

/// "Not all controllers drive the same runs: strip_moving 9 of 309 scenarios, vff 1 of 10 seeds."
/// Empty if they do.
std::string shares_text(const Plan& plan) {
  const Document& document = plan.document();
  std::string shares;
  for (const ControllerChoice& each : document.controllers) {
    const auto add = [&](std::size_t part, std::size_t whole, const char* unit) {
      if (part == whole) return;
      shares += fmt::format(
          "{} {} {} of {} {}", shares.empty() ? "" : ",", each.label, part, whole, unit);
    };
    const std::size_t scenarios = document.scenarios.size();
    add(each.only.empty() ? scenarios : each.only.size(), scenarios, "scenarios");
    add(each.repeats, document.most_repeats(), "seeds");
  }
  if (shares.empty()) return {};
  return fmt::format(" Not all controllers drive the same runs:{}.", shares);
}

std::string rates_text(const Plan& plan) {
  std::string text = fmt::format("{}{}{}", kRates, unit_text(plan), shares_text(plan));
  const std::size_t scenarios = plan.document().scenarios.size();
  if (scenarios > 1 && scenarios < kFewScenarios) {
    text += fmt::format(" {} scenarios are few: the intervals and tests are rough.", scenarios);
  }
  return text;
}

std::string figures_text(const Plan& plan) {
  const char* const interval =
      plan.document().scenarios.size() == 1
          ? "The interval of the mean is BCa over the seeds of the one scenario."
          : "The interval of the mean is BCa with 2000 resamples of whole scenarios; of a figure "
            "that runs in one scenario alone have, over those runs.";
  return fmt::format("{}{}", kFiguresText, interval);
}

std::string pairings_text(const Plan& plan) {
  std::string text = kPairs;
  if (plan.document().scenarios.size() == 1) {
    text +=
        "There is one scenario: each pair is one observation, and the tests say nothing about "
        "other scenarios. Rates: McNemar's exact test. ";
  } else if (plan.document().most_repeats() == 1) {
    text += "Each scenario has one pair. Rates: McNemar's exact test. ";
  } else {
    text +=
        "The pairs of a scenario give one observation: the difference of the rates, or the mean "
        "difference of the times. Rates: Wilcoxon's signed-rank test over scenarios. ";
  }
  return fmt::format("{}Times: Wilcoxon's signed-rank test. {}", text, kTests);
}

const std::string kRobustness =
    "The same runs, counted by other rules. The order is by rate of success, then by mean time of "
    "success. Holds: no two controllers swap places; a tie is no swap. Only controllers that drive "
    "all "
    "scenarios are ordered.";

const std::string kByScenario = "Intervals are Wilson's, over the seeds of that scenario alone.";

constexpr std::size_t kMostLines = 500;  // of the table by scenario; results.json has any number

}  // namespace

std::vector<Section> sections_of(const Plan& plan, const Results& results) {
  std::vector<Section> all;
  all.push_back({"Outcomes", rates_text(plan), rates_table(plan, results)});
  all.push_back({"Figures", figures_text(plan), figures_table(plan, results)});
  if (!results.pairings.empty()) {
    all.push_back(
        {"Comparison with the baseline", pairings_text(plan), pairings_table(plan, results)});
  }
  if (!results.rankings.empty()) {
    all.push_back({"Robustness of the order", kRobustness, rankings_table(plan, results)});
  }
  if (results.scenarios.size() <= kMostLines) {
    all.push_back({"By scenario", kByScenario, scenarios_table(plan, results)});
  }
  return all;
}

std::string summary_of(const Plan& plan) {
  const Document& document = plan.document();
  return fmt::format(
      "Scenarios {}, controllers {}, swept settings {}, seeds {} to {}: {} runs. Made by tautline "
      "{}; document and scenarios have the hash {}.",
      document.scenarios.size(),
      document.controllers.size(),
      document.points.size(),
      document.seed,
      document.seed + document.most_repeats() - 1,
      plan.size(),
      kVersion,
      hash_of(identity_of(document)));
}

}  // namespace server::sweep
