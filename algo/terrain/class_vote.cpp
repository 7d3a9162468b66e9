// algo/terrain/class_vote.cpp: counts trials.
#include "algo/terrain/class_vote.hpp"

#include <algorithm>
#include <numeric>

namespace algo {

std::size_t ClassVote::trials() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

GroundClass ClassVote::winner() const {
  if (count(GroundClass::Trench) > kTrenchTrials) return GroundClass::Trench;
  const auto most = std::ranges::max_element(counts_);  // the first of equals
  return static_cast<GroundClass>(most - counts_.begin());
}

}  // namespace algo
