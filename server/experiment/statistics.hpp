// server/experiment/statistics.hpp: quantiles, and intervals for means and for rates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace server::experiment {

struct Interval {
  double low = 0;
  double high = 0;
};

constexpr double kLevel = 0.95;              // confidence of every interval
constexpr std::size_t kResamples = 2000;     // of a bootstrap
constexpr std::uint64_t kBootstrapSeed = 1;  // the same values give the same interval

/// The quantile at `p` in 0 to 1 of one or more sorted values: linear between the order statistics
/// around (n - 1) p, counted from 0. Source: Hyndman and Fan 1996, definition 7; the default of R
/// and of numpy.
double quantile(std::span<const double> sorted, double p);
/// The same of values in any order; NaN of none.
double quantile_of(std::vector<double> values, double p);

/// The values of one figure over runs.
struct Summary {
  std::size_t n = 0;
  double mean = 0;
  std::optional<Interval> mean_interval{};  // nothing for a single value
  double least = 0, lower_quartile = 0, median = 0, upper_quartile = 0, largest = 0;
};
/// The order of `values` does not matter. Nothing if there are none. The interval of the mean is
/// BCa with kResamples resamples, and takes the values as independent.
std::optional<Summary> summarise(std::vector<double> values);
/// The same without an interval.
std::optional<Summary> order_statistics(std::vector<double> values);

/// Means of `count` resamples of `values` with replacement, in the order of drawing.
std::vector<double> resampled_means(std::span<const double> values,
                                    std::size_t count,
                                    std::uint64_t seed);

/// Interval of the mean of two or more values, bias-corrected and accelerated, from the means of
/// resamples. The acceleration is that of the jackknife. Half of the resamples that equal the mean
/// count as below it. Source: Efron 1987, eq. 2.3 and 6.6.
Interval bca_interval(std::span<const double> values,
                      std::vector<double> means,
                      double level = kLevel);

/// Interval of any `estimate`, bias-corrected and accelerated, from its `resampled` values. The
/// acceleration comes from `jackknife`, the estimates without each unit. Source: Efron 1987.
Interval bca_interval(double estimate,
                      std::span<const double> jackknife,
                      std::vector<double> resampled,
                      double level);

/// Interval of `rate`, found in `n` independent runs, n above 0; n need not be whole.
Interval wilson_of_rate(double rate, double n, double level = kLevel);
/// Interval of the rate `count` of `n`, n above 0. Source: Wilson 1927.
Interval wilson_interval(std::size_t count, std::size_t n, double level = kLevel);

/// Phi(z), the standard normal distribution.
double normal_below(double z);
/// Its inverse for p in 0 to 1, both excluded.
double normal_quantile(double p);

}  // namespace server::experiment
