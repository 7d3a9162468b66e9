// algo/full_strip/weighing.hpp: the candidate motions of the velocity stage and the beam search in
// a tick.
#pragma once

#include <cstddef>
#include <optional>

#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// A candidate motion: a constant twist held for `horizon`.
struct Candidate {
  Twist2 twist{};
  double horizon = 0;    // [s]
  bool allowed = false;  // passed the test of its stage
  bool chosen = false;
};

/// Candidates in a fixed array, so that no tick allocates.
class Weighing {
 public:
  static constexpr std::size_t kMost = 32;

  Weighing() { candidates.reserve(kMost); }
  void clear() {
    candidates.clear();
    pass_W.reset();
  }

  Recycled<Candidate> candidates{};
  std::optional<Vec2> pass_W{};  // the point the robot drives to
};

}  // namespace algo
