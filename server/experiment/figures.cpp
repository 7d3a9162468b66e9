// server/experiment/figures.cpp: the table of metrics and how runs are summed up.
#include "server/experiment/figures.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

using algo::Outcome;
constexpr double kMillimetres = 1000;

constexpr auto kTable = std::to_array<MetricInfo>({
    {"runs", Aggregate::Sum, [](const RunFigures&) { return 1.0; }},
    {"reached",
     Aggregate::Sum,
     [](const RunFigures& r) { return r.outcome == Outcome::Reached ? 1.0 : 0.0; }},
    {"stuck",
     Aggregate::Sum,
     [](const RunFigures& r) { return r.outcome == Outcome::Stuck ? 1.0 : 0.0; }},
    {"out_of_time",
     Aggregate::Sum,
     [](const RunFigures& r) { return r.outcome == Outcome::OutOfTime ? 1.0 : 0.0; }},
    {"collided",
     Aggregate::Sum,
     [](const RunFigures& r) { return r.outcome == Outcome::Collided ? 1.0 : 0.0; }},
    {"time_s", Aggregate::Mean, [](const RunFigures& r) { return r.metrics.time; }},
    {"path_mm",
     Aggregate::Mean,
     [](const RunFigures& r) { return r.metrics.path_length * kMillimetres; }},
    {"min_clearance_mm",
     Aggregate::Least,
     [](const RunFigures& r) { return r.metrics.min_clearance * kMillimetres; }},
    {"safety_infringed_s",
     Aggregate::Largest,
     [](const RunFigures& r) { return r.metrics.infringed_time; }},
    {"safety_depth_mm",
     Aggregate::Largest,
     [](const RunFigures& r) { return r.metrics.intrusion * kMillimetres; }},
    {"body1000_infringed_s",
     Aggregate::Largest,
     [](const RunFigures& r) { return r.path.body_infringed_time; }},
    {"body1000_depth_mm",
     Aggregate::Largest,
     [](const RunFigures& r) { return r.path.body_intrusion * kMillimetres; }},
    {"turning_rad", Aggregate::Mean, [](const RunFigures& r) { return r.metrics.turning; }},
    // 1e-3 rad2/mm is rad2/m: the factors of the unit and of its name cancel.
    {"curv2_e-3_rad2_per_mm", Aggregate::Mean, [](const RunFigures& r) { return r.path.bending; }},
    {"via_points",
     Aggregate::Mean,
     [](const RunFigures& r) { return static_cast<double>(r.metrics.via_points); }},
    {"standing_s", Aggregate::Mean, [](const RunFigures& r) { return r.standing.time; }},
    {"pauses",
     Aggregate::Mean,
     [](const RunFigures& r) { return static_cast<double>(r.standing.pauses); }},
    {"pause_s", Aggregate::Mean, [](const RunFigures& r) { return r.standing.pause_time; }},
});

double aggregate(const Row& row, const MetricInfo& metric, Aggregate how) {
  double result = metric.of(row.runs.front());
  for (std::size_t i = 1; i < row.runs.size(); ++i) {
    const double value = metric.of(row.runs[i]);
    if (how == Aggregate::Largest) {
      result = std::max(result, value);
    } else if (how == Aggregate::Least) {
      result = std::min(result, value);
    } else {
      result += value;
    }
  }
  return how == Aggregate::Mean ? result / static_cast<double>(row.runs.size()) : result;
}

}  // namespace

std::span<const MetricInfo> metric_table() {
  return kTable;
}

const MetricInfo* find_metric(std::string_view name) {
  const auto* const found = std::ranges::find(kTable, name, &MetricInfo::name);
  return found == kTable.end() ? nullptr : &*found;
}

double figure(const Row& row, const MetricInfo& metric) {
  return aggregate(row, metric, metric.aggregate);
}

double figure_against(const Row& row, const MetricInfo& metric, bool at_least) {
  const bool every_run = metric.aggregate == Aggregate::Least;
  return aggregate(row, metric, every_run && !at_least ? Aggregate::Largest : metric.aggregate);
}

std::size_t count(const Row& row, Outcome outcome) {
  return static_cast<std::size_t>(std::ranges::count(row.runs, outcome, &RunFigures::outcome));
}

std::optional<Outcome> common_outcome(const Row& row) {
  const Outcome first = row.runs.front().outcome;
  if (count(row, first) == row.runs.size()) return first;
  return std::nullopt;
}

std::string outcomes_text(const Row& row) {
  std::string text;
  for (const Outcome outcome :
       {Outcome::Reached, Outcome::Stuck, Outcome::OutOfTime, Outcome::Collided}) {
    const std::size_t runs = count(row, outcome);
    if (runs == 0) continue;
    const std::string_view word = outcome == Outcome::OutOfTime ? "timeout" : algo::name(outcome);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", runs, word);
  }
  return text;
}

std::string outcome_letters(const Row& row) {
  std::string text;
  for (const auto& [outcome, letter] : {std::pair{Outcome::Reached, 'r'},
                                        std::pair{Outcome::Stuck, 's'},
                                        std::pair{Outcome::OutOfTime, 't'},
                                        std::pair{Outcome::Collided, 'C'}}) {
    const std::size_t runs = count(row, outcome);
    if (runs == row.runs.size()) return {letter};
    if (runs > 0) text += fmt::format("{}{}{}", text.empty() ? "" : " ", letter, runs);
  }
  return text;
}

const Row* find_row(std::span<const Row> rows, std::string_view layout, std::string_view reading) {
  const auto found = std::ranges::find_if(
      rows, [&](const Row& row) { return row.layout == layout && row.reading == reading; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace server::reproduce
