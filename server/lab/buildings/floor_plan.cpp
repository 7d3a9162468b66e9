// server/lab/buildings/floor_plan.cpp: edges, and the walls that they make.
#include "server/lab/buildings/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace server::buildings {
namespace {

constexpr double kJamb = 0.15;      // [m] of wall at least on either side of a door
constexpr double kTouching = 1e-6;  // [m] between pieces of one wall

}  // namespace

double on_raster(double metres) {
  return (std::floor(metres / kRaster) + 0.5) * kRaster;
}

FloorPlan::FloorPlan(std::vector<double> xs, std::vector<double> ys, double door_width)
    : xs_(std::move(xs)),
      ys_(std::move(ys)),
      door_width_(door_width),
      uprights_(xs_.size() * (ys_.size() - 1)),
      levels_((xs_.size() - 1) * ys_.size()) {}

FloorPlan FloorPlan::uniform(int columns, int rows, double pitch, double door_width) {
  const bool even = std::lround(pitch / kRaster) % 2 == 0;
  const double first = even ? kRaster / 2 : 0;
  const auto lines = [&](int count) {
    std::vector<double> out;
    for (int k = 0; k <= count; ++k) out.push_back(first + k * pitch);
    return out;
  };
  return {lines(columns), lines(rows), door_width};
}

algo::Vec2 FloorPlan::low(CellPlace c) const {
  return algo::Vec2(xs_[static_cast<std::size_t>(c.column)], ys_[static_cast<std::size_t>(c.row)]) +
         algo::Vec2(kWall / 2, kWall / 2);
}

algo::Vec2 FloorPlan::high(CellPlace c) const {
  return algo::Vec2(xs_[static_cast<std::size_t>(c.column) + 1],
                    ys_[static_cast<std::size_t>(c.row) + 1]) -
         algo::Vec2(kWall / 2, kWall / 2);
}

std::size_t FloorPlan::upright(int line, int row) const {
  return static_cast<std::size_t>(row) * xs_.size() + static_cast<std::size_t>(line);
}

std::size_t FloorPlan::level(int column, int line) const {
  return static_cast<std::size_t>(line) * (xs_.size() - 1) + static_cast<std::size_t>(column);
}

const Edge& FloorPlan::between(CellPlace a, CellPlace b) const {
  if (is_upright(a, b)) return uprights_[upright(std::max(a.column, b.column), a.row)];
  return levels_[level(a.column, std::max(a.row, b.row))];
}

Edge& FloorPlan::between(CellPlace a, CellPlace b) {
  return const_cast<Edge&>(std::as_const(*this).between(a, b));
}

void FloorPlan::put_door(CellPlace a, CellPlace b, double share) {
  const CellPlace c = holds(a) ? a : b;
  const int axis = is_upright(a, b) ? 1 : 0;
  const double margin = kJamb + door_width_ / 2 + kRaster;
  const double from = low(c)[axis] + margin;
  const double to = high(c)[axis] - margin;
  Edge& edge = between(a, b);
  edge.kind = from < to ? Edge::Kind::Door : Edge::Kind::Open;
  edge.middle = on_raster(from + share * (to - from));
}

std::vector<DoorPlace> FloorPlan::doors() const {
  std::vector<DoorPlace> out;
  const auto add =
      [&](const Edge& edge, const algo::Vec2& corner, int axis, double from, double to) {
        if (edge.kind != Edge::Kind::Door) return;
        DoorPlace door;
        door.middle_W = corner;
        door.middle_W[axis] = edge.middle;
        door.along = axis == 0 ? algo::Vec2(1, 0) : algo::Vec2(0, 1);
        door.before = edge.middle - door_width_ / 2 - from;
        door.behind = to - edge.middle - door_width_ / 2;
        out.push_back(door);
      };
  for (int j = 0; j < rows(); ++j) {
    for (int i = 0; i <= columns(); ++i) {
      const double y = ys_[static_cast<std::size_t>(j)];
      const double x = xs_[static_cast<std::size_t>(i)];
      add(uprights_[upright(i, j)], {x, y}, 1, y, ys_[static_cast<std::size_t>(j) + 1]);
    }
  }
  for (int j = 0; j <= rows(); ++j) {
    for (int i = 0; i < columns(); ++i) {
      const double y = ys_[static_cast<std::size_t>(j)];
      const double x = xs_[static_cast<std::size_t>(i)];
      add(levels_[level(i, j)], {x, y}, 0, x, xs_[static_cast<std::size_t>(i) + 1]);
    }
  }
  return out;
}

std::vector<algo::Vec2> FloorPlan::doors_of(CellPlace c) const {
  std::vector<algo::Vec2> out;
  const auto add = [&](CellPlace to) {
    const Edge& edge = between(c, to);
    if (edge.kind != Edge::Kind::Door) return;
    const double x = xs_[static_cast<std::size_t>(std::max(c.column, to.column))];
    const double y = ys_[static_cast<std::size_t>(std::max(c.row, to.row))];
    out.push_back(is_upright(c, to) ? algo::Vec2(x, edge.middle) : algo::Vec2(edge.middle, y));
  };
  add({c.column - 1, c.row});
  add({c.column + 1, c.row});
  add({c.column, c.row - 1});
  add({c.column, c.row + 1});
  return out;
}

/// The pieces of wall of one edge from `from` to `to` [m], which fill the corners too.
void FloorPlan::add_pieces(const Edge& edge,
                           double from,
                           double to,
                           std::vector<Piece>& out) const {
  if (edge.kind == Edge::Kind::Open) return;
  const double begin = from - kWall / 2;
  const double end = to + kWall / 2;
  if (edge.kind == Edge::Kind::Wall) {
    out.push_back({begin, end});
    return;
  }
  out.push_back({begin, edge.middle - door_width_ / 2});
  out.push_back({edge.middle + door_width_ / 2, end});
}

/// The pieces of wall along one line, in order, joined where they touch.
std::vector<FloorPlan::Piece> FloorPlan::pieces(Line line, int number) const {
  std::vector<Piece> all;
  const int count = line == Line::Upright ? rows() : columns();
  const std::vector<double>& places = line == Line::Upright ? ys_ : xs_;
  for (int k = 0; k < count; ++k) {
    const Edge& edge =
        line == Line::Upright ? uprights_[upright(number, k)] : levels_[level(k, number)];
    const auto at = static_cast<std::size_t>(k);
    add_pieces(edge, places[at], places[at + 1], all);
  }
  std::vector<Piece> joined;
  for (const Piece& piece : all) {
    if (!joined.empty() && piece.from <= joined.back().to + kTouching) {
      joined.back().to = std::max(joined.back().to, piece.to);
    } else {
      joined.push_back(piece);
    }
  }
  return joined;
}

std::vector<algo::Obstacle> FloorPlan::walls() const {
  std::vector<algo::Obstacle> out;
  const auto add = [&](const Piece& piece, bool is_level, double at) {
    const double middle = (piece.from + piece.to) / 2;
    algo::Obstacle wall;
    wall.id = static_cast<std::uint32_t>(out.size() + 1);
    wall.pose_W =
        is_level ? algo::Pose2{middle, at, 0} : algo::Pose2{at, middle, std::numbers::pi / 2};
    wall.shape = algo::Wall{piece.to - piece.from, kWall};
    out.push_back(wall);
  };
  for (int i = 0; i <= columns(); ++i) {
    for (const Piece& piece : pieces(Line::Upright, i)) {
      add(piece, false, xs_[static_cast<std::size_t>(i)]);
    }
  }
  for (int j = 0; j <= rows(); ++j) {
    for (const Piece& piece : pieces(Line::Level, j)) {
      add(piece, true, ys_[static_cast<std::size_t>(j)]);
    }
  }
  return out;
}

}  // namespace server::buildings
