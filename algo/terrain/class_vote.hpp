// algo/terrain/class_vote.hpp: the vote of the trials over one piece of ground.
//
// Source: Masuda et al. 2008, section 5.3.
#pragma once

#include <array>
#include <cstddef>

#include "algo/terrain/ground_class.hpp"

namespace algo {

constexpr std::size_t kGroundTrials = 20;
constexpr std::size_t kTrenchTrials = 5;  // with more of them it is a trench

class ClassVote {
 public:
  void add(GroundClass kind) { ++counts_[static_cast<std::size_t>(kind)]; }
  std::size_t count(GroundClass kind) const { return counts_[static_cast<std::size_t>(kind)]; }
  std::size_t trials() const;
  /// Trench with more than kTrenchTrials; else the most frequent class, and of several the first in
  /// the order of GroundClass.
  GroundClass winner() const;

 private:
  std::array<std::size_t, kGroundClasses> counts_{};
};

}  // namespace algo
