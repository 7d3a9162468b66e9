// algo/layer.hpp: a drawing as data: the page, Foxglove and the record draw and keep it by its
// kind, without knowing whose it is.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// What the values of a layer are; p is a position of `axes` numbers.
enum class LayerKind : std::uint8_t {
  Points,    // p ...  Dashed: each is tied to the robot by a dotted line
  Polyline,  // p ...  a position that is not a number begins a new line
  Arrows,    // p d ...  from p, by the vector d
  Circles,   // p r ...
  Arcs,      // length turn ...  [m] driven and [rad] turned from the origin of R, along an arc
  Grid,      // corner_x corner_y cell columns; the bytes of `cells` row by row, columns along x
  Polar,     // density of each sector about the robot, by bearing in the layer's frame, ccw from 0
  Text,      // p ...; `text` has one line a position
};
enum class LayerFrame : std::uint8_t { World, Robot };
/// Which meaning the colour has: the page and Foxglove have one palette for it.
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

/// What stays the same of a layer; its texts in static storage.
struct LayerInfo {
  std::string_view name{};   // "strip.nodes": the key of its switch in the page
  std::string_view label{};  // "Strip": for people
  LayerKind kind = LayerKind::Points;
  LayerFrame frame = LayerFrame::World;
  Tone tone = Tone::Accent;
  LayerStyle style = LayerStyle::Solid;
  std::uint8_t axes = 2;    // coordinates of a position: 2 on the ground, 3 in space
  std::string_view unit{};  // of the values that are no positions
};

struct Layer : LayerInfo {
  float level = 0;  // of a polar: below it a sector is free
  std::vector<float> values{};
  std::vector<std::uint8_t> cells{};  // of a grid: 0 free, 127 even, 254 occupied, or kUnknownCell
  std::string text{};

  bool empty() const { return values.empty(); }
};

constexpr std::uint8_t kUnknownCell = 255;

/// A further layer, empty. A controller adds its layers in the same order each tick, also those
/// that have nothing to show, so that each finds its own buffers again. With room for `values`: a
/// tick with more than its predecessors then allocates nothing.
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
inline void put(std::vector<float>& values, const Vec2& p) {
  values.insert(values.end(), {static_cast<float>(p.x()), static_cast<float>(p.y())});
}
template <typename... Parts>
void put(Layer& layer, const Parts&... parts) {
  (put(layer.values, parts), ...);
}

}  // namespace algo
