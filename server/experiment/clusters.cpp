// server/experiment/clusters.cpp: the bootstrap over scenarios.
#include "server/experiment/clusters.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sim/random.hpp"

namespace server::experiment {
namespace {

constexpr std::uint64_t kClusterPurpose =
    0x636c757374657273;  // "clusters": the generator's purpose

Cluster total(std::span<const Cluster> clusters) {
  Cluster all;
  for (const Cluster& each : clusters) {
    all.sum += each.sum;
    all.n += each.n;
  }
  return all;
}

double ratio(const Cluster& cluster) {
  return cluster.sum / cluster.n;
}

bool alike(std::span<const Cluster> clusters) {
  return std::ranges::all_of(
      clusters, [&](const Cluster& each) { return ratio(each) == ratio(clusters.front()); });
}

}  // namespace

std::vector<double> resampled_ratios(std::span<const Cluster> clusters,
                                     std::size_t count,
                                     std::uint64_t seed) {
  sim::Random random(seed, kClusterPurpose);
  const auto n = static_cast<double>(clusters.size());
  std::vector<double> ratios(count);
  for (double& each : ratios) {
    Cluster drawn;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const Cluster& one = clusters[static_cast<std::size_t>(random.uniform() * n)];
      drawn.sum += one.sum;
      drawn.n += one.n;
    }
    each = ratio(drawn);
  }
  return ratios;
}

Interval cluster_interval(std::span<const Cluster> clusters,
                          std::vector<double> ratios,
                          double level) {
  const Cluster all = total(clusters);
  std::vector<double> without;  // the ratio without each cluster
  without.reserve(clusters.size());
  for (const Cluster& each : clusters) {
    without.push_back(ratio({all.sum - each.sum, all.n - each.n}));
  }
  return bca_interval(ratio(all), without, std::move(ratios), level);
}

std::string_view name(Basis basis) {
  switch (basis) {
    case Basis::Runs:
      return "wilson_runs";
    case Basis::Seeds:
      return "wilson_seeds";
    case Basis::Scenarios:
      return "bca_scenarios";
    case Basis::Alike:
      return "wilson_scenarios";
  }
  return "";
}

std::optional<RateInterval> rate_interval(std::span<const Cluster> clusters) {
  if (clusters.empty()) return std::nullopt;
  const Cluster all = total(clusters);
  const bool single = std::ranges::all_of(clusters, [](const Cluster& c) { return c.n == 1; });
  if (clusters.size() == 1) {
    return RateInterval{wilson_of_rate(ratio(all), all.n), Basis::Seeds};
  }
  if (single) return RateInterval{wilson_of_rate(ratio(all), all.n), Basis::Runs};
  if (alike(clusters)) {
    return RateInterval{wilson_of_rate(ratio(all), static_cast<double>(clusters.size())),
                        Basis::Alike};
  }
  std::vector<double> ratios = resampled_ratios(clusters, kResamples, kBootstrapSeed);
  return RateInterval{cluster_interval(clusters, std::move(ratios)), Basis::Scenarios};
}

std::optional<Summary> summarise_clusters(const std::vector<std::vector<double>>& by_scenario) {
  std::vector<Cluster> clusters;
  std::vector<double> values;
  for (const std::vector<double>& each : by_scenario) {
    if (each.empty()) continue;
    clusters.push_back(
        {std::accumulate(each.begin(), each.end(), 0.0), static_cast<double>(each.size())});
    values.insert(values.end(), each.begin(), each.end());
  }
  if (clusters.size() < 2) return summarise(std::move(values));
  std::optional<Summary> out = order_statistics(std::move(values));
  out->mean_interval =
      cluster_interval(clusters, resampled_ratios(clusters, kResamples, kBootstrapSeed));
  return out;
}

}  // namespace server::experiment
