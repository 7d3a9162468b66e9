// server/experiment/series.hpp: runs that differ only in their seed, and their combined figures.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/metrics.hpp"
#include "server/experiment/trial.hpp"

namespace server::experiment {

/// The runs of one scenario with one controller, in order of seed.
struct Series {
  std::string scenario{};
  std::string controller{};
  std::vector<Row> runs{};
};

/// The trials of one series: `spec` with `seeds` seeds, counted from `spec.seed`.
struct SeriesPlan {
  std::string scenario{};
  std::string controller{};
  RunSpec spec{};
  std::size_t seeds = 1;
};

/// The judges of every study: the figures of algo/metrics.hpp, of the path, of standing still, and
/// of the place where the run ends.
const std::vector<JudgeChoice>& common_judges();

/// Runs the series of `plans`, in their order. Keeps the track of the first run of each. Throws
/// std::runtime_error naming the scenario, controller and seed of a run that breaks. Throws
/// std::invalid_argument for a shard, because the runs of a series stay together.
std::vector<Series> run_series(const std::vector<SeriesPlan>& plans,
                               const std::vector<JudgeChoice>& judges,
                               const PoolOptions& options);

/// True for "runs", the name of an outcome (a count of runs) and the name of a column.
bool is_figure(std::string_view name);

/// The figure of that name over the series, which must have at least one run. Throws
/// std::out_of_range if no judge wrote it.
double figure(const Series& series, std::string_view name);

/// The figure to compare with a limit. A least clearance must hold for every run, so an upper limit
/// is compared with the largest one.
double figure_against(const Series& series, std::string_view name, bool at_least);

std::size_t count(const Series& series, algo::Outcome outcome);
/// The outcome that all runs share, or nothing if they differ.
std::optional<algo::Outcome> common_outcome(const Series& series);
/// True if every run reached its goal.
inline bool all_reach(const Series& series) {
  return common_outcome(series) == algo::Outcome::Reached;
}
/// "10 reached", "7 reached, 3 stuck".
std::string outcomes_text(const Series& series);
/// "r", "s", "t" or "C"; "r2 s1" if runs end differently.
std::string outcome_letters(const Series& series);

const Series* find_series(std::span<const Series> all,
                          std::string_view scenario,
                          std::string_view controller);

/// All figures of the series by name. A value that is not finite becomes null.
nlohmann::json figures_json(const Series& series);

}  // namespace server::experiment
