// server/experiment/paired_tests.hpp: do two controllers differ on the same scenarios and seeds?
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace server::experiment {

/// One yes or no of a pair of runs, such as "reached".
struct PairedOutcome {
  bool baseline = false;
  bool other = false;
};

struct McNemar {
  std::size_t pairs = 0;
  std::size_t only_baseline = 0;  // yes for the baseline, no for the other
  std::size_t only_other = 0;
  double p = 1;
};
/// Exact and two-sided: under the null hypothesis, pairs that differ go either way like a fair
/// coin. Source: McNemar 1947, with the binomial distribution.
McNemar mcnemar(std::span<const PairedOutcome> pairs);

struct Wilcoxon {
  std::size_t pairs = 0;
  std::size_t nonzero = 0;  // pairs that differ; the others are left out
  double w_plus = 0;        // sum of the ranks of the positive differences
  double w_minus = 0;
  double p = 1;
  bool exact = true;
  /// Matched-pairs rank-biserial correlation, (W+ - W-) / (W+ + W-): -1 if every difference is
  /// negative, 1 if every one is positive. Source: Kerby 2014.
  double rank_biserial = 0;
};
/// Most differences for which p is exact: every pattern of signs is counted, tied ranks included.
/// With more, p comes from the normal approximation, with the correction for ties and without one
/// for continuity.
constexpr std::size_t kMostExact = 50;
/// Two-sided signed-rank test of `differences`, other minus baseline. Equal sizes share their mean
/// rank. Source: Wilcoxon 1945.
Wilcoxon wilcoxon(std::span<const double> differences);

/// p values adjusted by Holm 1979 for all of them together, in the same order.
std::vector<double> holm(std::span<const double> p);

}  // namespace server::experiment
