// algo/layer.hpp: a drawing as data. The page, Foxglove and the record handle a layer by its kind,
// without knowing which method made it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// How to read a layer's values; p is a position of `axes` numbers.
enum class LayerKind : std::uint8_t {
  Points,    // p ...  Dashed: a dotted line ties each to the robot
  Polyline,  // p ...  a position that is not finite begins a new line
  Arrows,    // p d ...  from p, along the vector d
  Circles,   // p r ...
  Arcs,      // length turn ...  [m] driven and [rad] turned from the origin of R, along an arc
  Grid,      // corner_x corner_y cell columns; the bytes of `cells` row by row, columns along x
  Polar,     // density of each sector about the robot, by bearing in the layer's frame, ccw from 0
  Text,      // p ...; `text` has one line per position
};
enum class LayerFrame : std::uint8_t { World, Robot };
/// The meaning of a layer's colour. The page and Foxglove share one palette.
enum class Tone : std::uint8_t {
  Accent,
  Internal,
  External,
  Elastic,
  Plan,
  Moving,
  Muted,
  Refused,
  Good,
};
enum class LayerStyle : std::uint8_t { Solid, Dashed, Faint };

/// The constant part of a layer. Its texts are in static storage.
struct LayerInfo {
  std::string_view name{};   // "strip.nodes": the key of its switch in the page
  std::string_view label{};  // "Strip": for people
  LayerKind kind = LayerKind::Points;
  LayerFrame frame = LayerFrame::World;
  Tone tone = Tone::Accent;
  LayerStyle style = LayerStyle::Solid;
  std::uint8_t axes = 2;    // coordinates of a position: 2 on the ground, 3 in space
  std::string_view unit{};  // of the values other than positions
};

struct Layer : LayerInfo {
  float level = 0;  // of a polar: a sector below it is free
  std::vector<float> values{};
  std::vector<std::uint8_t> cells{};  // of a grid: 0 free, 127 even, 254 occupied, or kUnknownCell
  std::string text{};

  bool empty() const { return values.empty(); }
};

constexpr std::uint8_t kUnknownCell = 255;

/// Appends an empty layer. A controller adds its layers in the same order each tick, empty ones
/// too, so that each reuses its own buffers. Reserves room for `values`, so that a tick with more
/// values than the last does not allocate. Fill a layer before the next is added: the reference
/// then no longer holds.
inline Layer& add_layer(Recycled<Layer>& layers, const LayerInfo& info, std::size_t values = 0) {
  Layer& layer = layers.append();
  static_cast<LayerInfo&>(layer) = info;
  layer.level = 0;
  layer.values.clear();
  layer.values.reserve(values);
  layer.cells.clear();
  layer.text.clear();
  return layer;
}

/// Appends values in the order given: numbers and points.
inline void put(std::vector<float>& values, double value) {
  values.push_back(static_cast<float>(value));
}
template <typename Point>
void put(std::vector<float>& values, const Eigen::MatrixBase<Point>& p) {
  for (Eigen::Index k = 0; k < p.size(); ++k) values.push_back(static_cast<float>(p[k]));
}
template <typename... Parts>
void put(Layer& layer, const Parts&... parts) {
  (put(layer.values, parts), ...);
}

}  // namespace algo
