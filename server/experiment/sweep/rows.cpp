// server/experiment/sweep/rows.cpp: one block of numbers for the figures of all runs.
#include "server/experiment/sweep/rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::sweep {
namespace {

/// Rows::columns().size() if there is none of that name.
std::size_t index_of(std::string_view column) {
  const std::vector<std::string_view>& all = Rows::columns();
  return static_cast<std::size_t>(std::ranges::find(all, column) - all.begin());
}

}  // namespace

Rows::Rows(std::size_t size)
    : marks_(size),
      outcomes_(size, algo::Outcome::Running),
      reasons_(size),
      tracks_(size),
      figures_(size * columns().size(), std::nan("")) {}

const std::vector<std::string_view>& Rows::columns() {
  static const std::vector<std::string_view> all = [] {
    std::vector<std::string_view> names;
    for (const experiment::JudgeChoice& judge : judges()) {
      for (const experiment::Column& column : experiment::find_judge(judge.name).columns) {
        names.push_back(column.name);
      }
    }
    return names;
  }();
  return all;
}

double Rows::figure(std::size_t run, std::string_view column) const {
  const std::size_t index = index_of(column);
  return index == columns().size() ? std::nan("") : figures_[run * columns().size() + index];
}

experiment::Row Rows::row(std::size_t run) const {
  experiment::Row row{.outcome = outcomes_[run], .reason = reasons_[run], .broken = broken(run)};
  row.track_W = tracks_[run];
  if (!is(run, kMeasured)) return row;
  for (std::size_t k = 0; k < columns().size(); ++k) {
    row.figures.emplace_back(columns()[k], figures_[run * columns().size() + k]);
  }
  return row;
}

void Rows::set(std::size_t run, const experiment::Row& row) {
  erase(run);
  for (const auto& [column, value] : row.figures) {
    const std::size_t index = index_of(column);
    if (index == columns().size()) {
      throw std::out_of_range(fmt::format("no run of an experiment has the figure '{}'", column));
    }
    figures_[run * columns().size() + index] = value;
  }
  outcomes_[run] = row.outcome;
  reasons_[run] = row.reason;
  tracks_[run] = row.track_W;
  marks_[run] = static_cast<std::uint8_t>(kEnded | (row.broken ? kBroken : 0) |
                                          (row.figures.empty() ? 0 : kMeasured));
}

void Rows::set_killed_twice(std::size_t run) {
  set(run,
      {.outcome = algo::Outcome::Failed,
       .reason = "The run killed the program twice.",
       .broken = true});
  marks_[run] |= kKilledTwice;
}

void Rows::erase(std::size_t run) {
  marks_[run] = 0;
  outcomes_[run] = algo::Outcome::Running;
  reasons_[run].clear();
  tracks_[run].clear();
  const auto width = static_cast<std::ptrdiff_t>(columns().size());
  std::fill_n(figures_.begin() + static_cast<std::ptrdiff_t>(run) * width, width, std::nan(""));
}

}  // namespace server::sweep
