// algo/pipeline/grid_thinning.hpp: grids are large: people need them twice a second, and only when
// they are others.
#pragma once

#include <optional>

#include "algo/layer.hpp"

namespace algo {

class GridThinning {
 public:
  void reset();
  /// Whether the controller is to bring its grids in the tick at `stamp` [s, run clock].
  bool due(double stamp);
  /// Takes out of `layers`, which were due at `stamp`, grids that people have already.
  void thin(double stamp, Recycled<Layer>& layers);

 private:
  Recycled<Layer> shown_{};           // the newest that telemetry brought
  std::optional<double> asked_at_{};  // [s]
  std::optional<double> shown_at_{};  // [s]
};

}  // namespace algo
