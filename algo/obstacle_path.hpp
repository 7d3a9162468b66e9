// algo/obstacle_path.hpp: the path of an obstacle that moves by itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algo/types.hpp"

namespace algo {

/// Linear between keys, repeated; jumps from the last key to the first. An obstacle that comes and
/// goes is there from the first key to the last of each repetition, and nowhere in between.
struct ObstaclePath {
  struct Key {
    double time = 0;  // [s] of the path, ascending
    Vec2 position_W{0, 0};
    bool operator==(const Key&) const = default;
  };
  double period = 0;  // [s] above 0
  double phase = 0;   // [s] of the path at the start of the run
  std::vector<Key> keys{};
  bool comes_and_goes = false;
  bool operator==(const ObstaclePath&) const = default;

  /// The position at `stamp` [s, run clock].
  Vec2 at(double stamp) const;
  /// False while the obstacle is away: nobody can see or touch it.
  bool is_there(double stamp) const;

 private:
  double time_at(double stamp) const;
};

}  // namespace algo
