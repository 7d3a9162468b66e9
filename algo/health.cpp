// algo/health.cpp: counting late ticks.
#include "algo/health.hpp"

#include <algorithm>

namespace algo {

void LatenessHistogram::add(double late) {
  const auto it = std::upper_bound(kLimits.begin(), kLimits.end(), late);
  ++counts_[static_cast<std::size_t>(it - kLimits.begin())];
  worst_ = std::max(worst_, late);
  ++ticks_;
}

}  // namespace algo
