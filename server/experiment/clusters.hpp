// server/experiment/clusters.hpp: intervals where the scenario, not the run, is the unit.
//
// The seeds of one scenario give nearly the same run. An interval that takes runs as independent is
// then too narrow. Here whole scenarios are drawn, with all their runs (a cluster bootstrap:
// Davison and Hinkley 1997, section 3.8).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "server/experiment/statistics.hpp"

namespace server::experiment {

/// The runs of one scenario that have a figure: the sum of the figure, and their number, above 0.
/// For a rate, the sum is the count.
struct Cluster {
  double sum = 0;
  double n = 0;
};

/// Ratios sum / n of `count` resamples of whole clusters with replacement, in the order of drawing.
std::vector<double> resampled_ratios(std::span<const Cluster> clusters,
                                     std::size_t count,
                                     std::uint64_t seed);

/// Interval of the mean over all runs, sum / n, of two or more clusters: BCa from the ratios of
/// resamples, with the jackknife over clusters. Without width if all clusters have the same mean.
Interval cluster_interval(std::span<const Cluster> clusters,
                          std::vector<double> ratios,
                          double level = kLevel);

/// The method of a rate's interval.
enum class Basis : std::uint8_t {
  Runs,       // Wilson: one run per scenario, so that runs are independent
  Seeds,      // Wilson: one scenario; holds for that scenario alone, over its seeds
  Scenarios,  // BCa over scenarios
  Alike,      // Wilson with the number of scenarios as n: all scenarios have the same rate
};
/// "wilson_runs", "wilson_seeds", "bca_scenarios", "wilson_scenarios"
std::string_view name(Basis basis);

struct RateInterval {
  Interval bounds{};
  Basis basis = Basis::Runs;
};
/// Nothing without clusters. A rate that is the same in all scenarios, such as 0, gives a bootstrap
/// no width; then each scenario counts as a single run.
std::optional<RateInterval> rate_interval(std::span<const Cluster> clusters);

/// The values of a figure, scenario by scenario. The interval of the mean is over scenarios; if
/// only one has values, it is over them, and holds for that scenario alone. Nothing without values.
std::optional<Summary> summarise_clusters(const std::vector<std::vector<double>>& by_scenario);

}  // namespace server::experiment
