// algo/filter/causal_median.cpp: median of the last N samples, equations.md B.
#include "algo/filter/causal_median.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace algo {

double descending_median(std::span<double> values, MedianRank rank) {
  if (values.empty()) throw std::invalid_argument("the median of no values does not exist");
  std::ranges::sort(values, std::greater<>());
  const std::size_t n = values.size();
  // D[1] is values[0].
  const std::size_t d =
      rank == MedianRank::Corrected ? (n + 1) / 2 : std::max<std::size_t>(n / 2, 1);
  return values[d - 1];
}

CausalMedian::CausalMedian(std::size_t window, MedianRank rank) : rank_(rank) {
  if (window == 0) throw std::invalid_argument("a median's window must hold at least 1 sample");
  recent_.resize(window);
  sorted_.resize(window);
}

std::optional<double> CausalMedian::push(double sample) {
  if (!std::isfinite(sample)) return std::nullopt;
  if (!started_) {
    std::ranges::fill(recent_, sample);
    next_ = 0;
    started_ = true;
  }
  recent_[next_] = sample;
  next_ = (next_ + 1) % recent_.size();
  std::ranges::copy(recent_, sorted_.begin());
  return descending_median(sorted_, rank_);
}

}  // namespace algo
