// server/lab/mapping/drawn_maps.cpp: maps of drawings, as a mapping robot would have made them.
#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "server/lab/mapping/locate_study.hpp"
#include "server/run/drawn_map.hpp"

namespace server::mapping {
namespace {

using algo::OccupancyMap;
using algo::Vec2;

constexpr double kMapCell = 0.05;  // [m]

/// The corners of a piece on a map: of a wall, its middle line.
std::vector<Vec2> drawn(const algo::Obstacle& piece) {
  const auto* wall = std::get_if<algo::Wall>(&piece.shape);
  if (wall == nullptr) return algo::outline_W(piece);
  return {algo::to_parent(piece.pose_W, Vec2(-wall->length / 2, 0)),
          algo::to_parent(piece.pose_W, Vec2(wall->length / 2, 0))};
}

OccupancyMap walls_of(const std::vector<Piece>& pieces) {
  OccupancyMap map(kMapCell);
  for (const Piece& piece : pieces) {
    const std::vector<Vec2> outline_W = drawn(piece.obstacle);
    for (std::size_t k = 0; k < outline_W.size(); ++k) {
      const Vec2 edge = outline_W[(k + 1) % outline_W.size()] - outline_W[k];
      const int points = std::max(1, static_cast<int>(edge.norm() / (kMapCell / 2)));
      for (int i = 0; i < points; ++i) map.mark_wall(outline_W[k] + edge * i / points);
    }
  }
  return map;
}

/// Calls `see(p)` for the middle of each cell that is joined to `inside_W` between the walls.
template <typename See>
void each_inside(OccupancyMap walls, const Vec2& inside_W, const See& see) {
  const auto tiles = walls.tiles();
  const auto [left, right] = std::ranges::minmax(tiles, {}, &OccupancyMap::Index::i);
  const auto [bottom, top] = std::ranges::minmax(tiles, {}, &OccupancyMap::Index::j);
  constexpr int kSide = OccupancyMap::kTileSide;
  const OccupancyMap::Index low{left.i * kSide, bottom.j * kSide};
  const OccupancyMap::Index high{(right.i + 1) * kSide, (top.j + 1) * kSide};
  std::vector<OccupancyMap::Index> open{walls.cell_of(inside_W)};
  while (!open.empty()) {
    const OccupancyMap::Index at = open.back();
    open.pop_back();
    const bool inside = at.i >= low.i && at.j >= low.j && at.i < high.i && at.j < high.j;
    if (!inside || walls.at(at).known()) continue;
    walls.mark_free(walls.centre(at));
    see(walls.centre(at));
    open.insert(open.end(),
                {{at.i + 1, at.j}, {at.i - 1, at.j}, {at.i, at.j + 1}, {at.i, at.j - 1}});
  }
}

}  // namespace

std::shared_ptr<const KnownMap> map_of(const std::vector<Piece>& pieces,
                                       const Drawing& truth,
                                       bool planned) {
  OccupancyMap map = walls_of(pieces);
  KnownMap known{.walls = algo::Submap(map)};
  if (planned) {
    each_inside(walls_of(truth.pieces), truth.way_W.front(), [&map](const Vec2& p) {
      if (!map.at(map.cell_of(p)).known()) map.mark_free(p);
    });
    known.space = std::make_shared<const algo::DrawnSpace>(drawn_space(map));
  }
  return std::make_shared<const KnownMap>(std::move(known));
}

}  // namespace server::mapping
