// server/experiment/series.hpp: runs that differ in their seed only, and the figures they come to.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/metrics.hpp"
#include "server/experiment/trial.hpp"

namespace server::experiment {

/// The runs of one scenario with one controller, in the order of their seeds.
struct Series {
  std::string scenario{};
  std::string controller{};
  std::vector<Row> runs{};
};

/// The trials of one series: as `spec`, with `seeds` seeds from `spec.seed` on.
struct SeriesPlan {
  std::string scenario{};
  std::string controller{};
  RunSpec spec{};
  std::size_t seeds = 1;
};

/// What every study of many series measures: the figures of algo/metrics.hpp, of the path, of
/// standing still, and where the run ends.
const std::vector<JudgeChoice>& common_judges();

/// The series of `plans`, in their order. The track of the first run of each is kept. Throws
/// std::runtime_error naming the scenario, controller and seed of a run that breaks, and
/// std::invalid_argument for a shard: the runs of a series stay together.
std::vector<Series> run_series(const std::vector<SeriesPlan>& plans,
                               const std::vector<JudgeChoice>& judges,
                               const PoolOptions& options);

/// "runs", the name of an outcome (a count of runs) or of a column.
bool is_figure(std::string_view name);

/// The figure of that name over the series, which has at least one run. Throws std::out_of_range
/// when no judge wrote it.
double figure(const Series& series, std::string_view name);

/// The figure that must keep a limit. A least clearance holds for every run, so that an upper
/// limit is held against the largest of them.
double figure_against(const Series& series, std::string_view name, bool at_least);

std::size_t count(const Series& series, algo::Outcome outcome);
/// The outcome of every run, or nothing when they differ.
std::optional<algo::Outcome> common_outcome(const Series& series);
/// Whether every run reached its goal.
inline bool all_reach(const Series& series) {
  return common_outcome(series) == algo::Outcome::Reached;
}
/// "10 reached", "7 reached, 3 stuck".
std::string outcomes_text(const Series& series);
/// "r", "s", "t" or "C"; "r2 s1" when runs end differently.
std::string outcome_letters(const Series& series);

const Series* find_series(std::span<const Series> all,
                          std::string_view scenario,
                          std::string_view controller);

/// Every figure of the series by its name; what is not finite is null.
nlohmann::json figures_json(const Series& series);

}  // namespace server::experiment
