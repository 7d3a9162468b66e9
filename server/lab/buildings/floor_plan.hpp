// server/lab/buildings/floor_plan.hpp: a floor of rectangular cells with walls and doors between
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace server::buildings {

inline constexpr double kWall = 0.1;     // [m] thickness of a wall
inline constexpr double kRaster = 0.05;  // [m] of the oracle's grid

/// The nearest middle of a raster cell below `metres`: a way through the middle of a door that lies
/// there leads over the middles of the oracle's cells.
double on_raster(double metres);

/// The boundary between two cells.
struct Edge {
  enum class Kind : std::uint8_t { Open, Wall, Door };
  Kind kind = Kind::Wall;
  double middle = 0;  // [m] of the door, as a coordinate of W along the edge
};

struct CellPlace {
  int column = 0;
  int row = 0;
  bool operator==(const CellPlace&) const = default;
};

/// A door in the wall from `from_W` to `to_W`.
struct DoorPlace {
  algo::Vec2 middle_W{0, 0};
  algo::Vec2 along{1, 0};  // unit vector of the wall
  double before = 0;       // [m] of wall before the door, and behind it
  double behind = 0;
};

class FloorPlan {
 public:
  /// The lines between columns and rows [m], ascending. All edges are walls.
  FloorPlan(std::vector<double> xs, std::vector<double> ys, double door_width);
  /// `columns` x `rows` equal cells of edge `pitch` [m], a multiple of kRaster. The middle line of
  /// each column and row leads over the middles of raster cells.
  static FloorPlan uniform(int columns, int rows, double pitch, double door_width);

  int columns() const { return static_cast<int>(xs_.size()) - 1; }
  int rows() const { return static_cast<int>(ys_.size()) - 1; }
  double door_width() const { return door_width_; }
  bool holds(CellPlace c) const {
    return c.column >= 0 && c.row >= 0 && c.column < columns() && c.row < rows();
  }
  algo::Vec2 low(CellPlace c) const;   // [m] corners of the free area
  algo::Vec2 high(CellPlace c) const;  // [m]
  algo::Vec2 middle(CellPlace c) const { return (low(c) + high(c)) / 2; }

  /// The edge between two neighbouring cells, or between a cell and the outside.
  Edge& between(CellPlace a, CellPlace b);
  const Edge& between(CellPlace a, CellPlace b) const;
  void open(CellPlace a, CellPlace b) { between(a, b).kind = Edge::Kind::Open; }
  void shut(CellPlace a, CellPlace b) { between(a, b).kind = Edge::Kind::Wall; }
  /// Puts a door at `share` (0 to 1) of the edge; opens the edge if it is too short for a door.
  void put_door(CellPlace a, CellPlace b, double share);

  std::vector<DoorPlace> doors() const;
  /// The middles of the doors of one cell.
  std::vector<algo::Vec2> doors_of(CellPlace c) const;
  /// The walls, with ids from 1. Walls in one line are one obstacle.
  std::vector<algo::Obstacle> walls() const;

 private:
  /// An interval of a wall along its line.
  struct Piece {
    double from = 0, to = 0;  // [m]
  };
  enum class Line : std::uint8_t { Upright, Level };
  std::size_t upright(int line, int row) const;
  std::size_t level(int column, int line) const;
  std::vector<Piece> pieces(Line line, int number) const;
  void add_pieces(const Edge& edge, double from, double to, std::vector<Piece>& out) const;
  bool is_upright(CellPlace a, CellPlace b) const { return a.row == b.row; }

  std::vector<double> xs_;
  std::vector<double> ys_;
  double door_width_;
  std::vector<Edge> uprights_;  // left of each cell, and right of the last one
  std::vector<Edge> levels_;    // below each cell, and above the last one
};

}  // namespace server::buildings
