// server/experiment/sweep/sweep_results.cpp: groups and pairs the runs.
#include "server/experiment/sweep/sweep_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace server::sweep {
namespace {

using algo::Outcome;

constexpr std::array<Figure, 13> kFigures{{{"time_s", true},
                                           {"path_m", true},
                                           {"turning_rad", true},
                                           {"min_clearance_m", false},
                                           {"safety_infringed_s", false},
                                           {"standing_s", false},
                                           {"path_ratio", true},
                                           {"mean_clearance_m", false},
                                           {"bending_rad2_per_m", true},
                                           {"jerk_rms_m_s3", true},
                                           {"effort_m2_s3", true},
                                           {"turn_flips", true},
                                           {"turn_rms_rad_s2", true}}};

constexpr std::array kOutcomes{
    Outcome::Reached, Outcome::Collided, Outcome::Stuck, Outcome::OutOfTime, Outcome::Failed};
constexpr std::array kOnlyWithGround{Outcome::Overturned, Outcome::Fallen};

using Runs = std::vector<std::size_t>;  // numbers of runs that have ended

/// The outcomes to list; the rare ones only if a run of the sweep had them.
std::vector<Outcome> outcomes_of(const Rows& rows) {
  std::vector<Outcome> listed(kOutcomes.begin(), kOutcomes.end());
  for (const Outcome outcome : kOnlyWithGround) {
    for (std::size_t run = 0; run < rows.size(); ++run) {
      if (!rows.has(run) || rows.outcome(run) != outcome) continue;
      listed.push_back(outcome);
      break;
    }
  }
  return listed;
}

/// The finite values of a figure; a broken run may have none.
std::vector<double> values_of(const Rows& rows, const Runs& runs, const Figure& figure) {
  std::vector<double> values;
  for (const std::size_t run : runs) {
    if (figure.reached_only && rows.outcome(run) != Outcome::Reached) continue;
    const double value = rows.figure(run, figure.column);
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

Rate rate_of(const Rows& rows, const std::vector<Runs>& by_scenario, Outcome outcome) {
  Rate rate{.outcome = outcome};
  std::vector<experiment::Cluster> clusters;
  for (const Runs& runs : by_scenario) {
    if (runs.empty()) continue;
    const auto count = static_cast<std::size_t>(
        std::ranges::count(runs, outcome, [&](std::size_t run) { return rows.outcome(run); }));
    rate.count += count;
    rate.runs += runs.size();
    clusters.push_back({static_cast<double>(count), static_cast<double>(runs.size())});
  }
  rate.interval = experiment::rate_interval(clusters);
  return rate;
}

/// The runs of `arm` in the scenarios from `first` to before `last`.
Group group_of(
    const Plan& plan, const Rows& rows, std::size_t arm, std::size_t first, std::size_t last) {
  Group group{.arm = arm};
  std::vector<Runs> by_scenario(last - first);
  for (std::size_t scenario = first; scenario < last; ++scenario) {
    for (std::size_t repeat = 0; repeat < plan.repeats(scenario, arm); ++repeat) {
      const std::size_t run = plan.number({scenario, arm, repeat});
      if (rows.has(run)) by_scenario[scenario - first].push_back(run);
      ++(rows.has(run) ? group.runs : group.missing);
    }
  }
  for (const Outcome outcome : outcomes_of(rows)) {
    group.rates.push_back(rate_of(rows, by_scenario, outcome));
  }
  for (const Figure& figure : kFigures) {
    std::vector<std::vector<double>> values;
    values.reserve(by_scenario.size());
    for (const Runs& runs : by_scenario) values.push_back(values_of(rows, runs, figure));
    group.figures.push_back(experiment::summarise_clusters(values));
  }
  return group;
}

/// The numbers of two runs, both of which have ended.
struct Pair {
  std::size_t baseline = 0;
  std::size_t other = 0;
};
/// Other minus baseline; nothing if the pair has no such difference.
using Difference = std::optional<double> (*)(const Rows& rows, const Pair& pair);

template <Outcome outcome>
std::optional<double> rate_difference(const Rows& rows, const Pair& pair) {
  return (rows.outcome(pair.other) == outcome ? 1 : 0) -
         (rows.outcome(pair.baseline) == outcome ? 1 : 0);
}

std::optional<double> time_difference(const Rows& rows, const Pair& pair) {
  const bool both = rows.outcome(pair.baseline) == Outcome::Reached &&
                    rows.outcome(pair.other) == Outcome::Reached;
  if (!both) return std::nullopt;
  return rows.figure(pair.other, "time_s") - rows.figure(pair.baseline, "time_s");
}

/// The pairs, scenario by scenario.
using Pairs = std::vector<std::vector<Pair>>;

Pairs pairs_of(const Plan& plan, const Rows& rows, std::size_t baseline, std::size_t arm) {
  Pairs pairs(plan.document().scenarios.size());
  for (std::size_t scenario = 0; scenario < pairs.size(); ++scenario) {
    const std::size_t seeds =
        std::min(plan.repeats(scenario, baseline), plan.repeats(scenario, arm));
    for (std::size_t repeat = 0; repeat < seeds; ++repeat) {
      const Pair pair{plan.number({scenario, baseline, repeat}),
                      plan.number({scenario, arm, repeat})};
      if (rows.has(pair.baseline) && rows.has(pair.other)) pairs[scenario].push_back(pair);
    }
  }
  return pairs;
}

/// Of the differences of single pairs, which are -1, 0 or 1.
experiment::McNemar mcnemar_of(const std::vector<double>& differences) {
  std::vector<experiment::PairedOutcome> outcomes;
  outcomes.reserve(differences.size());
  for (const double each : differences) outcomes.push_back({each<0, each> 0});
  return experiment::mcnemar(outcomes);
}

PairedTest test_of(const Rows& rows, const Pairs& pairs, Difference difference, bool is_rate) {
  PairedTest test;
  std::vector<double> units;
  bool single = true;  // each unit is one pair
  for (const std::vector<Pair>& of_scenario : pairs) {
    std::vector<double> found;
    for (const Pair& pair : of_scenario) {
      if (const std::optional<double> each = difference(rows, pair)) found.push_back(*each);
    }
    test.pairs += found.size();
    if (pairs.size() == 1) {
      units = found;
    } else if (!found.empty()) {
      single = single && found.size() == 1;
      units.push_back(std::accumulate(found.begin(), found.end(), 0.0) /
                      static_cast<double>(found.size()));
    }
  }
  if (is_rate && single) test.mcnemar = mcnemar_of(units);
  test.signed_rank = experiment::wilcoxon(units);
  test.differences = experiment::summarise(units);
  return test;
}

Pairing pairing_of(const Plan& plan, const Rows& rows, std::size_t baseline, std::size_t arm) {
  const Pairs pairs = pairs_of(plan, rows, baseline, arm);
  return {.arm = arm,
          .baseline = baseline,
          .over_scenarios = pairs.size() > 1,
          .reached = test_of(rows, pairs, rate_difference<Outcome::Reached>, true),
          .collided = test_of(rows, pairs, rate_difference<Outcome::Collided>, true),
          .time = test_of(rows, pairs, time_difference, false)};
}

void correct(std::vector<Pairing>& pairings) {
  std::vector<PairedTest*> tests;
  std::vector<double> p;
  for (Pairing& each : pairings) {
    for (PairedTest* const test : {&each.reached, &each.collided, &each.time}) {
      tests.push_back(test);
      p.push_back(test->p());
    }
  }
  const std::vector<double> adjusted = experiment::holm(p);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i]->p_holm = adjusted[i];
}

std::size_t controller_labelled(const Document& document, const std::string& label) {
  const auto found = std::ranges::find(document.controllers, label, &ControllerChoice::label);
  return static_cast<std::size_t>(found - document.controllers.begin());
}

std::vector<Pairing> pairings_of(const Plan& plan, const Rows& rows) {
  std::vector<Pairing> all;
  const Document& document = plan.document();
  if (!document.comparisons) return all;
  const std::size_t points = document.points.size();
  const std::size_t baseline = controller_labelled(document, document.comparisons->baseline);
  for (const std::string& other : document.comparisons->others) {
    const std::size_t controller = controller_labelled(document, other);
    for (std::size_t point = 0; point < points; ++point) {  // arms: point by point
      all.push_back(pairing_of(plan, rows, baseline * points + point, controller * points + point));
    }
  }
  correct(all);
  return all;
}

}  // namespace

std::span<const Figure> figures() {
  return kFigures;
}

Results results_of(const Plan& plan, const Rows& rows) {
  Results out{.runs = rows.size()};
  const std::size_t scenarios = plan.document().scenarios.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows.has(i)) ++out.missing;
    if (rows.has(i) && rows.outcome(i) == Outcome::Failed) ++out.failed;
  }
  for (std::size_t arm = 0; arm < plan.arms().size(); ++arm) {
    out.arms.push_back(group_of(plan, rows, arm, 0, scenarios));
  }
  for (std::size_t scenario = 0; scenario < scenarios; ++scenario) {
    for (std::size_t arm = 0; arm < plan.arms().size(); ++arm) {
      if (plan.repeats(scenario, arm) == 0) continue;
      out.scenarios.push_back(group_of(plan, rows, arm, scenario, scenario + 1));
      out.scenarios.back().scenario = scenario;
    }
  }
  out.pairings = pairings_of(plan, rows);
  out.rankings = rankings_of(plan, rows);
  return out;
}

}  // namespace server::sweep
