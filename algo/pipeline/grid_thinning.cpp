// algo/pipeline/grid_thinning.cpp: the periods of grids, and the comparison of grids.
#include "algo/pipeline/grid_thinning.hpp"

namespace algo {
namespace {

constexpr double kGridPeriod = 0.5;  // [s] between two grids
constexpr double kRefresh = 5.0;  // [s] after which an unchanged one comes again, for new viewers

bool brings_grid(const Layer& layer) {
  return layer.kind == LayerKind::Grid && !layer.empty();
}

/// Written so that a NaN stamp counts as long enough.
bool passed(const std::optional<double>& since, double now, double period) {
  return !since || !(now - *since < period);
}

}  // namespace

void GridThinning::reset() {
  shown_.clear();
  asked_at_.reset();
  shown_at_.reset();
}

bool GridThinning::due(double stamp) {
  if (!passed(asked_at_, stamp, kGridPeriod)) return false;
  asked_at_ = stamp;
  return true;
}

void GridThinning::thin(double stamp, Recycled<Layer>& layers) {
  std::size_t grids = 0;
  bool same = !passed(shown_at_, stamp, kRefresh);
  for (const Layer& layer : layers) {
    if (!brings_grid(layer)) continue;
    same = same && grids < shown_.size() && shown_[grids].values == layer.values &&
           shown_[grids].cells == layer.cells;
    ++grids;
  }
  if (grids == 0) return;
  if (!same) {
    shown_.clear();
    shown_at_ = stamp;
  }
  for (Layer& layer : layers) {
    if (!brings_grid(layer)) continue;
    if (same) {
      layer.values.clear();
      layer.cells.clear();
    } else {
      shown_.push_back(layer);
    }
  }
}

}  // namespace algo
