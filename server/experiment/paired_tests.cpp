// server/experiment/paired_tests.cpp: exact distributions, by counting.
#include "server/experiment/paired_tests.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "server/experiment/statistics.hpp"

namespace server::experiment {
namespace {

/// Two-sided p of `count` heads or fewer, count <= n / 2, in n tosses of a fair coin.
double coin(std::size_t count, std::size_t n) {
  double sum = 0;
  for (std::size_t k = 0; k <= count; ++k) {
    const auto i = static_cast<double>(k);
    const auto all = static_cast<double>(n);
    sum += std::exp(std::lgamma(all + 1) - std::lgamma(i + 1) - std::lgamma(all - i + 1) -
                    all * std::log(2));
  }
  return std::min(1.0, 2 * sum);
}

struct Ranked {
  double difference = 0;
  std::size_t twice_rank = 0;  // whole, since a tie's mean rank may end in a half
};

/// The differences other than 0 with their ranks by size.
std::vector<Ranked> ranked(std::span<const double> differences) {
  std::vector<Ranked> all;
  for (const double each : differences) {
    if (each != 0) all.push_back({each, 0});
  }
  const auto size = [](const Ranked& each) { return std::abs(each.difference); };
  std::ranges::sort(all, {}, size);
  for (auto first = all.begin(); first != all.end();) {
    const auto last = std::ranges::upper_bound(first, all.end(), size(*first), {}, size);
    const auto twice = static_cast<std::size_t>((first - all.begin()) + 1 + (last - all.begin()));
    for (; first != last; ++first) first->twice_rank = twice;
  }
  return all;
}

/// Two-sided p of the rank sum `twice_w` over all 2^n patterns of signs: the probability of each
/// sum, one rank after the other.
double exact_p(const std::vector<Ranked>& all, std::size_t twice_w) {
  const std::size_t most = all.size() * (all.size() + 1);
  std::vector<double> probability(most + 1, 0.0);
  probability[0] = 1;
  for (const Ranked& each : all) {
    for (std::size_t sum = most + 1; sum-- > 0;) {
      const double with = sum >= each.twice_rank ? probability[sum - each.twice_rank] : 0;
      probability[sum] = (probability[sum] + with) / 2;
    }
  }
  const auto at = probability.begin() + static_cast<std::ptrdiff_t>(twice_w);
  const double below = std::accumulate(probability.begin(), at, 0.0);
  const double above = std::accumulate(at + 1, probability.end(), 0.0);
  return std::min(1.0, 2 * (std::min(below, above) + *at));
}

/// Variance n (n + 1) (2 n + 1) / 24 minus sum (t^3 - t) / 48 over groups of t ties. That is a
/// quarter of the sum of the squared ranks.
double normal_p(const std::vector<Ranked>& all, double w) {
  double mean = 0;
  double variance = 0;
  for (const Ranked& each : all) {
    const double rank = static_cast<double>(each.twice_rank) / 2;
    mean += rank / 2;
    variance += rank * rank / 4;
  }
  return 2 * normal_below(-std::abs(w - mean) / std::sqrt(variance));
}

}  // namespace

McNemar mcnemar(std::span<const PairedOutcome> pairs) {
  McNemar out{.pairs = pairs.size()};
  for (const PairedOutcome& pair : pairs) {
    if (pair.baseline && !pair.other) ++out.only_baseline;
    if (!pair.baseline && pair.other) ++out.only_other;
  }
  out.p = coin(std::min(out.only_baseline, out.only_other), out.only_baseline + out.only_other);
  return out;
}

Wilcoxon wilcoxon(std::span<const double> differences) {
  const std::vector<Ranked> all = ranked(differences);
  Wilcoxon out{.pairs = differences.size(), .nonzero = all.size()};
  if (all.empty()) return out;
  std::size_t twice_plus = 0;
  std::size_t twice_all = 0;
  for (const Ranked& each : all) {
    twice_all += each.twice_rank;
    if (each.difference > 0) twice_plus += each.twice_rank;
  }
  out.w_plus = static_cast<double>(twice_plus) / 2;
  out.w_minus = static_cast<double>(twice_all - twice_plus) / 2;
  out.exact = all.size() <= kMostExact;
  out.p = out.exact ? exact_p(all, twice_plus) : normal_p(all, out.w_plus);
  out.rank_biserial = (out.w_plus - out.w_minus) / (out.w_plus + out.w_minus);
  return out;
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double scaled = static_cast<double>(p.size() - k) * p[order[k]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[k]] = largest;
  }
  return adjusted;
}

}  // namespace server::experiment
