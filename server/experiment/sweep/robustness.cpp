// server/experiment/sweep/robustness.cpp: counts the same runs again by other rules.
#include "server/experiment/sweep/robustness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace server::sweep {
namespace {

/// Which runs count, and what a success must be.
struct Reading {
  std::string name{};
  double time_limit_share = 1;
  double least_clearance = -std::numeric_limits<double>::infinity();  // [m]
  std::optional<std::size_t> seed_half{};                             // 0: even, 1: odd
  std::optional<std::size_t> scenario_half{};
};

struct Score {
  std::size_t runs = 0;
  std::size_t successes = 0;
  double time = 0;  // [s] sum over the successes

  double rate() const {
    return runs > 0 ? static_cast<double>(successes) / static_cast<double>(runs) : std::nan("");
  }
  double mean_time() const {
    return successes > 0 ? time / static_cast<double>(successes)
                         : std::numeric_limits<double>::infinity();
  }
};

std::vector<Reading> readings_for(const Plan& plan) {
  std::vector<Reading> all{{.name = "all runs"},
                           {.name = "time limit x 0.5", .time_limit_share = 0.5},
                           {.name = "time limit x 0.75", .time_limit_share = 0.75},
                           {.name = "clearance of 0.05 m or more", .least_clearance = 0.05},
                           {.name = "clearance of 0.10 m or more", .least_clearance = 0.10}};
  if (plan.document().most_repeats() > 1) {
    all.push_back({.name = "1st, 3rd, 5th ... seed", .seed_half = 0});
    all.push_back({.name = "2nd, 4th, 6th ... seed", .seed_half = 1});
  }
  if (plan.document().scenarios.size() > 1) {
    all.push_back({.name = "1st, 3rd, 5th ... scenario", .scenario_half = 0});
    all.push_back({.name = "2nd, 4th, 6th ... scenario", .scenario_half = 1});
  }
  return all;
}

bool counts(const Reading& reading, const RunPlace& at) {
  return (!reading.seed_half || at.repeat % 2 == *reading.seed_half) &&
         (!reading.scenario_half || at.scenario % 2 == *reading.scenario_half);
}

/// `time_limit` [s] of the run as it was made.
bool succeeds(const Reading& reading, const Rows& rows, std::size_t run, double time_limit) {
  return rows.outcome(run) == algo::Outcome::Reached &&
         rows.figure(run, "time_s") <= reading.time_limit_share * time_limit &&
         !(rows.figure(run, "min_clearance_m") < reading.least_clearance);
}

/// 1 if `one` is better than `other`, -1 if worse, 0 if they tie or cannot be compared.
int better(const Score& one, const Score& other) {
  if (one.runs == 0 || other.runs == 0) return 0;
  if (one.rate() != other.rate()) return one.rate() > other.rate() ? 1 : -1;
  if (one.mean_time() == other.mean_time()) return 0;
  return one.mean_time() < other.mean_time() ? 1 : -1;
}

/// The scores of all arms in each reading.
std::vector<std::vector<Score>> scores_of(const Plan& plan,
                                          const Rows& rows,
                                          const std::vector<Reading>& readings) {
  std::vector<std::vector<Score>> scores(readings.size(), std::vector<Score>(plan.arms().size()));
  double time_limit = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RunPlace at = plan.place(i);
    if (at.repeat == 0) time_limit = plan.time_limit(at.scenario, at.arm);
    if (!rows.has(i)) continue;
    for (std::size_t k = 0; k < readings.size(); ++k) {
      if (!counts(readings[k], at)) continue;
      Score& score = scores[k][at.arm];
      ++score.runs;
      if (!succeeds(readings[k], rows, i, time_limit)) continue;
      ++score.successes;
      score.time += rows.figure(i, "time_s");
    }
  }
  return scores;
}

/// `arms`: those that are compared; `all`: the scores of all runs.
Ranking ranking_of(std::string name,
                   const std::vector<std::size_t>& arms,
                   const std::vector<Score>& scores,
                   const std::vector<Score>& all) {
  Ranking out{.reading = std::move(name), .order = arms};
  for (const Score& each : scores) out.rates.push_back(each.rate());
  // An arm without runs comes last; the comparison must order all arms.
  const auto key = [&](std::size_t arm) {
    const Score& score = scores[arm];
    return std::pair(score.runs > 0 ? -score.rate() : 1.0, score.mean_time());
  };
  std::ranges::stable_sort(out.order, {}, key);
  for (auto a = arms.begin(); a != arms.end(); ++a) {
    for (auto b = a + 1; b != arms.end(); ++b) {
      ++out.pairs;
      if (better(scores[*a], scores[*b]) * better(all[*a], all[*b]) < 0) ++out.swapped;
    }
  }
  return out;
}

/// Success in other scenarios says nothing about the order.
std::vector<std::size_t> arms_in_all_scenarios(const Plan& plan) {
  std::vector<std::size_t> arms;
  for (std::size_t arm = 0; arm < plan.arms().size(); ++arm) {
    if (plan.drives_all(arm)) arms.push_back(arm);
  }
  return arms;
}

}  // namespace

std::vector<Ranking> rankings_of(const Plan& plan, const Rows& rows) {
  std::vector<Ranking> all;
  const std::vector<std::size_t> arms = arms_in_all_scenarios(plan);
  if (arms.size() < 2 || arms.size() > kMostRanked) return all;
  const std::vector<Reading> readings = readings_for(plan);
  const std::vector<std::vector<Score>> scores = scores_of(plan, rows, readings);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    all.push_back(ranking_of(readings[k].name, arms, scores[k], scores.front()));
  }
  return all;
}

}  // namespace server::sweep
