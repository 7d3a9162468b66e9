// algo/full_strip/weighing.hpp: what the velocity stage and the beam search weighed in a tick.
#pragma once

#include <cstddef>
#include <optional>

#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// A motion that was weighed: constant twist held for `horizon`.
struct Candidate {
  Twist2 twist{};
  double horizon = 0;    // [s]
  bool allowed = false;  // passed the test of its stage
  bool chosen = false;
};

/// Candidates in a fixed array: no tick allocates, however many it weighs.
class Weighing {
 public:
  static constexpr std::size_t kMost = 32;

  Weighing() { candidates.reserve(kMost); }
  void clear() {
    candidates.clear();
    pass_W.reset();
  }

  Recycled<Candidate> candidates{};
  std::optional<Vec2> pass_W{};  // where the robot is sent
};

}  // namespace algo
