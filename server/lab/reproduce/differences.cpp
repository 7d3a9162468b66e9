// server/lab/reproduce/differences.cpp: one change at a time.
#include "server/lab/reproduce/differences.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

using algo::Outcome;

struct Change {
  const char* name = "";
  Conditions conditions{};
};
// Base and scanner need the short tick, so they include it. It is first tried alone.
constexpr std::array<Change, 3> kChanges{{
    {"the 26 ms tick", {.fast_period = true}},
    {"the base (Bullet: ramps, wheels, encoder odometry)", {.base = true, .fast_period = true}},
    {"the scanner (rolling LMS200 model)", {.scanner = true, .fast_period = true}},
}};

/// The most frequent outcome; of equally frequent ones, the better.
Outcome usual(const Series& row) {
  Outcome best = Outcome::Reached;
  for (const Outcome outcome : {Outcome::Stuck, Outcome::OutOfTime, Outcome::Collided}) {
    if (count(row, outcome) > count(row, best)) best = outcome;
  }
  return best;
}

bool same_outcomes(const Series& a, const Series& b) {
  const auto same = [&](Outcome outcome) { return count(a, outcome) == count(b, outcome); };
  return same(Outcome::Reached) && same(Outcome::Stuck) && same(Outcome::OutOfTime) &&
         same(Outcome::Collided);
}

/// The number of runs that do not end like most of the paper's.
std::size_t ends_otherwise(const Series& row, const Series& paper) {
  return row.runs.size() - count(row, usual(paper));
}

std::string capital(std::string sentence) {
  sentence.front() = static_cast<char>(std::toupper(sentence.front()));
  return sentence;
}

/// Which change alone is enough, judged by `tried`: the row under each of kChanges.
std::string cause(const Series& paper, std::span<const Series> tried) {
  if (ends_otherwise(tried[0], paper) > 0) {
    return capital(
        fmt::format("{} alone is enough, which the other changes include.", kChanges[0].name));
  }
  std::string names;
  for (std::size_t i = 1; i < kChanges.size(); ++i) {
    if (ends_otherwise(tried[i], paper) == 0) continue;
    names += fmt::format("{}{}", names.empty() ? "" : ", or ", kChanges[i].name);
  }
  return names.empty() ? "No change alone is enough; it takes them together."
                       : capital(fmt::format("{} alone is enough.", names));
}

double nearest_surface(const sim::Scenario& scenario, const algo::Vec2& p_W) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    nearest = std::min(nearest, algo::signed_distance(obstacle, p_W));
  }
  return nearest;
}

/// The average place of the stuck runs.
std::string place(const PaperConditions& conditions,
                  const sim::Scenario& scenario,
                  const Series& row) {
  const algo::Vec2 goal_W = scenario.goal->position_W;
  const std::size_t stuck = count(row, Outcome::Stuck);
  if (stuck == 0) return {};
  double to_goal = 0;
  double to_surface = 0;
  for (const experiment::Row& run : row.runs) {
    if (run.outcome != Outcome::Stuck) continue;
    const algo::Vec2 end_W{run["end_x_m"], run["end_y_m"]};
    to_goal += (end_W - goal_W).norm() / static_cast<double>(stuck);
    to_surface += nearest_surface(scenario, end_W) / static_cast<double>(stuck);
  }
  const double goal_to_surface = nearest_surface(scenario, goal_W);
  const double reach = conditions.safety_distance + kHullRadius;
  return fmt::format(
      " The stuck runs truly stand {:.3f} m from the goal (arrival, by the robot's odometry: {:g} "
      "m) and {:.2f} m from the nearest surface; the goal lies {:.2f} m from one, {} the {:.2f} m "
      "in which obstacles push linearly.",
      to_goal,
      conditions.arrival_radius,
      to_surface,
      goal_to_surface,
      goal_to_surface < reach ? "within" : "outside",
      reach);
}

/// `tried`: the row under each of kChanges.
std::string explain(const PaperConditions& conditions,
                    const sim::Scenario& scenario,
                    const Series& paper,
                    const Series& full,
                    std::span<const Series> tried) {
  std::string figures;
  for (std::size_t i = 0; i < kChanges.size(); ++i) {
    figures += fmt::format(
        "{}{}: {}", figures.empty() ? "" : "; ", kChanges[i].name, outcomes_text(tried[i]));
  }
  return fmt::format("{}{} With one change at a time: {}.",
                     cause(paper, tried),
                     place(conditions, scenario, full),
                     figures);
}

}  // namespace

std::vector<Difference> explain_differences(const StudyFile& file,
                                            std::span<const Series> paper,
                                            std::span<const Series> full,
                                            std::uint64_t first_seed,
                                            const experiment::PoolOptions& pool) {
  const auto scenario_of = [&](const Series& series) -> const sim::Scenario& {
    return *std::ranges::find(file.scenarios, series.scenario, &sim::Scenario::name);
  };
  std::vector<std::size_t> differing;
  std::vector<experiment::SeriesPlan> plans;
  for (std::size_t i = 0; i < std::min(paper.size(), full.size()); ++i) {
    if (same_outcomes(paper[i], full[i])) continue;
    differing.push_back(i);
    const sim::Scenario& scenario = scenario_of(paper[i]);
    const std::string& reading = paper[i].controller;
    for (const Change& change : kChanges) {
      plans.push_back({scenario.name,
                       reading,
                       make_run(file.conditions, scenario, reading, change.conditions, first_seed),
                       paper[i].runs.size()});
    }
  }
  const std::vector<Series> tried = run_series(plans, experiment::common_judges(), pool);
  std::vector<Difference> differences;
  for (std::size_t k = 0; k < differing.size(); ++k) {
    const Series& a = paper[differing[k]];
    const Series& b = full[differing[k]];
    const auto own = std::span(tried).subspan(k * kChanges.size(), kChanges.size());
    differences.push_back({a.scenario,
                           a.controller,
                           outcomes_text(a),
                           outcomes_text(b),
                           explain(file.conditions, scenario_of(a), a, b, own)});
  }
  return differences;
}

}  // namespace server::reproduce
