// server/run/drawn_map.cpp: measures the distances to a map's walls, window by window.
#include "server/run/drawn_map.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algo/full_strip/distance_field.hpp"

namespace server {
namespace {

using algo::DistanceField;
using algo::DrawnSpace;
using algo::OccupancyMap;
using algo::Vec2;

constexpr int kFinePerCell = 4;  // cells of the field along the edge of a drawn one
static_assert(kFinePerCell * DistanceField::kCell == DrawnSpace::kCell);
/// Drawn cells at each side of a window whose surroundings are not inside it.
constexpr int kWindowRim = 6;
static_assert(kWindowRim * DrawnSpace::kCell > DistanceField::kReach);
constexpr int kWindow = DistanceField::kSize / kFinePerCell;  // drawn cells along its edge
constexpr int kWithin = kWindow - 2 * kWindowRim;
constexpr int kNearWall = 70;                    // [cm] nearer to a wall, a cell is known
constexpr std::size_t kMostDrawn = 200'000'000;  // cells

int drawn_cell(double metres) {
  return algo::whole_below(metres / DrawnSpace::kCell);
}

/// Builds the cells of one map.
class Drawing {
 public:
  explicit Drawing(const OccupancyMap& map) : map_(map) {
    const auto tiles = map.tiles();
    if (tiles.empty()) return;
    const double tile = OccupancyMap::kTileSide * map.cell_edge();
    const auto first = tiles.front();
    int left = first.i, right = first.i, bottom = first.j, top = first.j;
    for (const auto& at : tiles) {
      left = std::min(left, at.i);
      right = std::max(right, at.i);
      bottom = std::min(bottom, at.j);
      top = std::max(top, at.j);
    }
    left_ = drawn_cell(left * tile);
    bottom_ = drawn_cell(bottom * tile);
    columns_ = drawn_cell((right + 1) * tile) + 1 - left_;
    rows_ = drawn_cell((top + 1) * tile) + 1 - bottom_;
    const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    cells_.assign(count, DrawnSpace::kUnknown);
    mark_known();
    for (int row = bottom_; row < bottom_ + rows_; row += kWithin) {
      for (int column = left_; column < left_ + columns_; column += kWithin) measure(column, row);
    }
  }
  DrawnSpace space() && { return {left_, bottom_, columns_, rows_, std::move(cells_)}; }

 private:
  std::uint8_t& at(int column, int row) {
    return cells_[static_cast<std::size_t>(row - bottom_) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column - left_)];
  }

  void mark_known() {
    const double half = map_.cell_edge() / 2 - 1e-9;
    map_.each_cell([&](const auto& cell, const auto& tally) {
      if (!tally.known()) return;
      const Vec2 middle = map_.centre(cell);
      for (int row = drawn_cell(middle.y() - half); row <= drawn_cell(middle.y() + half); ++row) {
        for (int column = drawn_cell(middle.x() - half); column <= drawn_cell(middle.x() + half);
             ++column) {
          at(column, row) = 0;
        }
      }
    });
  }

  /// The cells of a window whose inner part begins at (column, row).
  void measure(int column, int row) {
    field_.reset();
    const int x0 = column - kWindowRim;
    const int y0 = row - kWindowRim;
    const double half = kWindow * DrawnSpace::kCell / 2;
    const Vec2 middle = DrawnSpace::kCell * Vec2(x0, y0) + Vec2(half, half);
    bool any = false;
    map_.each_near(middle, half, [&](const Vec2& wall) {
      any = true;
      occupy((wall - middle) + Vec2(half, half));
    });
    for (int y = row; y < std::min(row + kWithin, bottom_ + rows_); ++y) {
      for (int x = column; x < std::min(column + kWithin, left_ + columns_); ++x) {
        std::uint8_t& cell = at(x, y);
        const int cm = any ? room(x - x0, y - y0) : DrawnSpace::kMost;
        if (cell != DrawnSpace::kUnknown || cm < kNearWall) {
          cell = static_cast<std::uint8_t>(std::min<int>(cm, DrawnSpace::kMost));
        }
      }
    }
  }

  /// Enters the square of a cell of the map, about `p` from the window's corner.
  void occupy(const Vec2& p) {
    const double half = std::max(0.0, map_.cell_edge() - DistanceField::kCell) / 2;
    const auto fine = [](double metres) {
      return algo::whole_below(metres / DistanceField::kCell);
    };
    const int right = std::min(fine(p.x() + half), DistanceField::kSize - 1);
    const int top = std::min(fine(p.y() + half), DistanceField::kSize - 1);
    for (int y = std::max(0, fine(p.y() - half)); y <= top; ++y) {
      for (int x = std::max(0, fine(p.x() - half)); x <= right; ++x) {
        if (field_.at(x, y) > 0) field_.occupy(x, y);
      }
    }
  }

  /// [cm] The largest distance within a cell of the window.
  int room(int column, int row) const {
    std::int16_t most = 0;  // [mm]
    for (int v = 0; v < kFinePerCell; ++v) {
      const std::int16_t* const from = field_.from(column * kFinePerCell, row * kFinePerCell + v);
      most = std::max(most, *std::max_element(from, from + kFinePerCell));
    }
    return most / 10;
  }

  const OccupancyMap& map_;
  DistanceField field_{};
  int left_ = 0, bottom_ = 0, columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> cells_{};
};

}  // namespace

algo::DrawnSpace drawn_space(const algo::OccupancyMap& map) {
  return Drawing(map).space();
}

nlohmann::json to_json(const algo::DrawnSpace& space) {
  nlohmann::json runs = nlohmann::json::array();
  const std::vector<std::uint8_t>& cells = space.cells();
  for (std::size_t k = 0; k < cells.size();) {
    std::size_t end = k;
    while (end < cells.size() && cells[end] == cells[k]) ++end;
    runs.push_back(cells[k]);
    runs.push_back(end - k);
    k = end;
  }
  return {{"left", space.left()},
          {"bottom", space.bottom()},
          {"columns", space.columns()},
          {"rows", space.rows()},
          {"cells", std::move(runs)}};
}

algo::DrawnSpace drawn_space_from_json(const nlohmann::json& value) {
  const auto columns = value.at("columns").get<int>();
  const auto rows = value.at("rows").get<int>();
  const nlohmann::json& runs = value.at("cells");
  std::vector<std::uint8_t> cells;
  for (std::size_t k = 0; k + 1 < runs.size(); k += 2) {
    const auto count = runs[k + 1].get<std::size_t>();
    if (count > kMostDrawn - cells.size()) {
      throw std::invalid_argument("The map has too many cells.");
    }
    cells.insert(cells.end(), count, runs[k].get<std::uint8_t>());
  }
  return {
      value.at("left").get<int>(), value.at("bottom").get<int>(), columns, rows, std::move(cells)};
}

}  // namespace server
