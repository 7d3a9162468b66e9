// algo/pipeline/grid_thinning.hpp: limits grids, which are large, to two a second, and only if they
// have changed.
#pragma once

#include <optional>

#include "algo/layer.hpp"

namespace algo {

class GridThinning {
 public:
  void reset();
  /// True if the controller is to make its grids in the tick at `stamp` [s, run clock].
  bool due(double stamp);
  /// Removes grids that people have already from `layers`, which were due at `stamp`.
  void thin(double stamp, Recycled<Layer>& layers);

 private:
  Recycled<Layer> shown_{};           // the newest in the telemetry
  std::optional<double> asked_at_{};  // [s]
  std::optional<double> shown_at_{};  // [s]
};

}  // namespace algo
