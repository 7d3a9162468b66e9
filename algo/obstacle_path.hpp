// algo/obstacle_path.hpp: the path of an obstacle that moves by itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/types.hpp"

namespace algo {

/// Linear between keys, repeated; jumps from the last key to the first.
struct ObstaclePath {
  struct Key {
    double time = 0;  // [s] of the path, ascending
    Vec2 position_W{0, 0};
    bool operator==(const Key&) const = default;
  };
  double period = 0;  // [s] above 0
  double phase = 0;   // [s] of the path at the start of the run
  std::vector<Key> keys{};
  bool operator==(const ObstaclePath&) const = default;

  /// The position at `stamp` [s, run clock].
  Vec2 at(double stamp) const;
};

}  // namespace algo
