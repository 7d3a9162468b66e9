// server/experiment/series.cpp: combines runs into figures.
#include "server/experiment/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace server::experiment {
namespace {

using algo::Outcome;

/// The outcomes of a study's runs, in the order of the tables.
constexpr std::array kOutcomes{Outcome::Reached,
                               Outcome::Stuck,
                               Outcome::OutOfTime,
                               Outcome::Collided,
                               Outcome::Overturned,
                               Outcome::Fallen};

const Outcome* find_outcome(std::string_view words) {
  const auto* const found =
      std::ranges::find_if(kOutcomes, [&](Outcome outcome) { return name(outcome) == words; });
  return found == kOutcomes.end() ? nullptr : found;
}

double aggregate(const Series& series, std::string_view column, Aggregate how) {
  double result = series.runs.front()[column];
  for (const Row& run : std::span(series.runs).subspan(1)) {
    const double value = run[column];
    if (how == Aggregate::Largest) {
      result = std::max(result, value);
    } else if (how == Aggregate::Least) {
      result = std::min(result, value);
    } else {
      result += value;
    }
  }
  return how == Aggregate::Mean ? result / static_cast<double>(series.runs.size()) : result;
}

Aggregate aggregate_of(std::string_view column) {
  const Column* const found = find_column(column);
  if (found == nullptr) throw std::out_of_range(fmt::format("no judge has '{}'", column));
  return found->aggregate;
}

}  // namespace

const std::vector<JudgeChoice>& common_judges() {
  static const std::vector<JudgeChoice> judges{
      {.name = "metrics"}, {.name = "path"}, {.name = "standing"}, {.name = "place"}};
  return judges;
}

std::vector<Series> run_series(const std::vector<SeriesPlan>& plans,
                               const std::vector<JudgeChoice>& judges,
                               const PoolOptions& options) {
  if (options.shard.count != 1) throw std::invalid_argument("a series is run as a whole");
  std::vector<std::pair<const SeriesPlan*, std::size_t>> runs;  // plan and index of the seed
  for (const SeriesPlan& plan : plans) {
    for (std::size_t seed = 0; seed < plan.seeds; ++seed) runs.emplace_back(&plan, seed);
  }
  std::vector<Row> rows = run_trials(
      runs.size(),
      [&](std::size_t i) {
        const auto& [plan, seed] = runs[i];
        Trial trial{.spec = plan->spec, .judges = judges, .keep_track = seed == 0};
        trial.spec.seed += seed;
        trial.name =
            fmt::format("{}, {}, seed {}", plan->scenario, plan->controller, trial.spec.seed);
        return trial;
      },
      options);
  std::vector<Series> all;
  auto next = std::make_move_iterator(rows.begin());
  for (const SeriesPlan& plan : plans) {
    const auto end = next + static_cast<std::ptrdiff_t>(plan.seeds);
    all.push_back({plan.scenario, plan.controller, std::vector<Row>(next, end)});
    next = end;
  }
  return all;
}

bool is_figure(std::string_view name) {
  return name == "runs" || find_outcome(name) != nullptr || find_column(name) != nullptr;
}

double figure(const Series& series, std::string_view name) {
  if (name == "runs") return static_cast<double>(series.runs.size());
  if (const Outcome* const outcome = find_outcome(name)) {
    return static_cast<double>(count(series, *outcome));
  }
  return aggregate(series, name, aggregate_of(name));
}

double figure_against(const Series& series, std::string_view name, bool at_least) {
  const Column* const column = find_column(name);
  const bool every_run = column != nullptr && column->aggregate == Aggregate::Least;
  return every_run && !at_least ? aggregate(series, name, Aggregate::Largest)
                                : figure(series, name);
}

std::size_t count(const Series& series, Outcome outcome) {
  return static_cast<std::size_t>(std::ranges::count(series.runs, outcome, &Row::outcome));
}

std::optional<Outcome> common_outcome(const Series& series) {
  const Outcome first = series.runs.front().outcome;
  if (count(series, first) == series.runs.size()) return first;
  return std::nullopt;
}

std::string outcomes_text(const Series& series) {
  std::string text;
  for (const Outcome outcome : kOutcomes) {
    const std::size_t runs = count(series, outcome);
    if (runs == 0) continue;
    const std::string_view word = outcome == Outcome::OutOfTime ? "timeout" : algo::name(outcome);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", runs, word);
  }
  return text;
}

std::string outcome_letters(const Series& series) {
  std::string text;
  for (const auto& [outcome, letter] : {std::pair{Outcome::Reached, 'r'},
                                        std::pair{Outcome::Stuck, 's'},
                                        std::pair{Outcome::OutOfTime, 't'},
                                        std::pair{Outcome::Collided, 'C'},
                                        std::pair{Outcome::Overturned, 'O'},
                                        std::pair{Outcome::Fallen, 'F'}}) {
    const std::size_t runs = count(series, outcome);
    if (runs == series.runs.size()) return {letter};
    if (runs > 0) text += fmt::format("{}{}{}", text.empty() ? "" : " ", letter, runs);
  }
  return text;
}

const Series* find_series(std::span<const Series> all,
                          std::string_view scenario,
                          std::string_view controller) {
  const auto found = std::ranges::find_if(all, [&](const Series& series) {
    return series.scenario == scenario && series.controller == controller;
  });
  return found == all.end() ? nullptr : &*found;
}

nlohmann::json figures_json(const Series& series) {
  nlohmann::json out = {{"runs", series.runs.size()}};
  for (const Outcome outcome : kOutcomes) out[std::string(name(outcome))] = count(series, outcome);
  for (const auto& [column, unused] : series.runs.front().figures) {
    const double value = figure(series, column);
    out[std::string(column)] =
        std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
  }
  return out;
}

}  // namespace server::experiment
