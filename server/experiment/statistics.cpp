// server/experiment/statistics.cpp: the formulas, and the seeded bootstrap.
#include "server/experiment/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "sim/random.hpp"

namespace server::experiment {
namespace {

constexpr std::uint64_t kBootstrapPurpose =
    0x626f6f7473747270;  // "bootstrp": the generator's purpose

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// a = sum d^3 / (6 (sum d^2)^1.5), d the mean of the jackknife's estimates minus each of them.
double acceleration(std::span<const double> jackknife) {
  const double mean = mean_of(jackknife);
  double squares = 0;
  double cubes = 0;
  for (const double each : jackknife) {
    const double d = mean - each;
    squares += d * d;
    cubes += d * d * d;
  }
  return squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
}

/// z0 = Phi^-1(share of the resamples below the mean).
double bias(std::span<const double> sorted, double mean) {
  const double rounding = 1e-12 * std::abs(mean);  // sums in another order differ by so much
  const auto low = std::ranges::lower_bound(sorted, mean - rounding);
  const auto high = std::ranges::upper_bound(sorted, mean + rounding);
  const auto below = static_cast<double>(low - sorted.begin());
  const auto equal = static_cast<double>(high - low);
  const auto n = static_cast<double>(sorted.size());
  // A share of 0 or 1 has no z0; half a resample keeps it finite.
  return normal_quantile(std::clamp((below + equal / 2) / n, 0.5 / n, 1 - 0.5 / n));
}

}  // namespace

double quantile(std::span<const double> sorted, double p) {
  const double at = static_cast<double>(sorted.size() - 1) * p;
  const auto low = static_cast<std::size_t>(at);
  if (low + 1 >= sorted.size()) return sorted.back();
  return std::lerp(sorted[low], sorted[low + 1], at - static_cast<double>(low));
}

double quantile_of(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  return quantile(values, p);
}

std::optional<Summary> order_statistics(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  return Summary{.n = values.size(),
                 .mean = mean_of(values),
                 .least = values.front(),
                 .lower_quartile = quantile(values, 0.25),
                 .median = quantile(values, 0.5),
                 .upper_quartile = quantile(values, 0.75),
                 .largest = values.back()};
}

std::optional<Summary> summarise(std::vector<double> values) {
  std::ranges::sort(values);
  std::optional<Summary> out = order_statistics(values);
  if (values.size() > 1) {
    out->mean_interval =
        bca_interval(values, resampled_means(values, kResamples, kBootstrapSeed), kLevel);
  }
  return out;
}

std::vector<double> resampled_means(std::span<const double> values,
                                    std::size_t count,
                                    std::uint64_t seed) {
  sim::Random random(seed, kBootstrapPurpose);
  const auto n = static_cast<double>(values.size());
  std::vector<double> means(count);
  for (double& mean : means) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      mean += values[static_cast<std::size_t>(random.uniform() * n)];
    }
    mean /= n;
  }
  return means;
}

Interval bca_interval(std::span<const double> values, std::vector<double> means, double level) {
  const double mean = mean_of(values);
  const auto n = static_cast<double>(values.size());
  std::vector<double> without;
  without.reserve(values.size());
  for (const double value : values) without.push_back(mean - (value - mean) / (n - 1));
  return bca_interval(mean, without, std::move(means), level);
}

Interval bca_interval(double estimate,
                      std::span<const double> jackknife,
                      std::vector<double> resampled,
                      double level) {
  std::ranges::sort(resampled);
  const double z0 = bias(resampled, estimate);
  const double a = acceleration(jackknife);
  const auto bound = [&](double tail) {
    const double z = z0 + normal_quantile(tail);
    return quantile(resampled, normal_below(z0 + z / (1 - a * z)));
  };
  return {bound((1 - level) / 2), bound((1 + level) / 2)};
}

Interval wilson_of_rate(double rate, double n, double level) {
  const double z = normal_quantile((1 + level) / 2);
  const double scale = 1 + z * z / n;
  const double middle = (rate + z * z / (2 * n)) / scale;
  const double half = z * std::sqrt(rate * (1 - rate) / n + z * z / (4 * n * n)) / scale;
  // The sums leave a last bit at the ends, where the bound is exact.
  return {rate == 0 ? 0 : middle - half, rate == 1 ? 1 : middle + half};
}

Interval wilson_interval(std::size_t count, std::size_t n, double level) {
  const auto all = static_cast<double>(n);
  return wilson_of_rate(static_cast<double>(count) / all, all, level);
}

double normal_below(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

double normal_quantile(double p) {
  // The upper tail is 1 - p, which rounds; mirroring keeps both tails equally exact.
  if (p > 0.5) return -normal_quantile(1 - p);
  double low = -40;
  double high = 0;
  for (int halvings = 0; halvings < 64; ++halvings) {
    const double middle = (low + high) / 2;
    (normal_below(middle) < p ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace server::experiment
