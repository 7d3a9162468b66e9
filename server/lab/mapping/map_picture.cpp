// server/lab/mapping/map_picture.cpp: a map as SVG: free cells in grey, walls in black.
#include <algorithm>
#include <vector>

#include "server/experiment/svg_plot.hpp"
#include "server/lab/mapping/map_study.hpp"

namespace server::mapping {
namespace {

using algo::OccupancyMap;
using algo::Vec2;
using experiment::CellRun;

constexpr double kWidth = 900;        // [px]
constexpr int kMostColumns = 800;     // in cells; a larger map is drawn coarser
constexpr int kEdge = 6;              // cells of margin around the known part of the map
constexpr double kSpacing = 0.15;     // [m] between the drawn points of the path
constexpr std::uint16_t kEnough = 3;  // beams through a cell that make it surely free

/// The known part of the map: cells with first <= i < end.
struct Part {
  int left = 0, right = 0, bottom = 0, top = 0;
  int columns() const { return right - left; }
  int rows() const { return top - bottom; }
};

enum class Shade : std::uint8_t { Unknown, Free, Wall };

Shade shade(const OccupancyMap::Tally& tally) {
  if (tally.occupied()) return Shade::Wall;
  return tally.passes >= kEnough ? Shade::Free : Shade::Unknown;
}

Part known_part(const OccupancyMap& map) {
  Part part{map.side(), 0, map.side(), 0};
  for (int row = 0; row < map.side(); ++row) {
    for (int column = 0; column < map.side(); ++column) {
      if (shade(map.at(column, row)) == Shade::Unknown) continue;
      part.left = std::min(part.left, column);
      part.right = std::max(part.right, column + 1);
      part.bottom = std::min(part.bottom, row);
      part.top = std::max(part.top, row + 1);
    }
  }
  if (part.columns() <= 0) return {0, map.side(), 0, map.side()};
  return {std::max(0, part.left - kEdge),
          std::min(map.side(), part.right + kEdge),
          std::max(0, part.bottom - kEdge),
          std::min(map.side(), part.top + kEdge)};
}

/// The shade of a block of the map in the picture: wall if any cell is a wall, else free if any is
/// free.
Shade shade_of_block(const OccupancyMap& map, const Part& part, int block, int column, int row) {
  Shade most = Shade::Unknown;
  const int right = std::min(part.right, part.left + (column + 1) * block);
  const int top = std::min(part.top, part.bottom + (row + 1) * block);
  for (int y = part.bottom + row * block; y < top; ++y) {
    for (int x = part.left + column * block; x < right; ++x) {
      most = std::max(most, shade(map.at(x, y)));
    }
  }
  return most;
}

std::vector<CellRun> runs_of(const std::vector<Shade>& shades, int columns, Shade wanted) {
  std::vector<CellRun> runs;
  for (std::size_t at = 0; at < shades.size(); ++at) {
    if (shades[at] != wanted) continue;
    const int column = static_cast<int>(at) % columns;
    const int row = static_cast<int>(at) / columns;
    const bool goes_on = !runs.empty() && runs.back().row == row &&
                         runs.back().column + runs.back().length == column;
    if (goes_on) {
      ++runs.back().length;
    } else {
      runs.push_back({column, row, 1});
    }
  }
  return runs;
}

std::vector<Vec2> thinned(const std::vector<algo::Pose2>& path_W) {
  std::vector<Vec2> kept_W;
  for (const algo::Pose2& pose_W : path_W) {
    const bool apart = kept_W.empty() || (pose_W.position() - kept_W.back()).norm() >= kSpacing;
    if (apart) kept_W.push_back(pose_W.position());
  }
  return kept_W;
}

}  // namespace

std::string draw_map(const Recording& log,
                     const std::vector<algo::Pose2>& path_W,
                     const std::string& title) {
  const OccupancyMap map = map_along(log, path_W);
  const Part part = known_part(map);
  const int block = (part.columns() + kMostColumns - 1) / kMostColumns;
  const int columns = (part.columns() + block - 1) / block;
  const int rows = (part.rows() + block - 1) / block;
  std::vector<Shade> shades;
  shades.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      shades.push_back(shade_of_block(map, part, block, column, row));
    }
  }
  const double cell = map.cell_edge() * block;
  const Vec2 low_W = map.corner_W() + map.cell_edge() * Vec2(part.left, part.bottom);
  const Vec2 high_W = low_W + cell * Vec2(columns, rows);
  constexpr const char* kPath = "stroke=\"#3f88c5\" stroke-width=\"1\"";
  experiment::SvgPlot plot(low_W, high_W, kWidth, 1);
  plot.cells(low_W, cell, runs_of(shades, columns, Shade::Free), "#e4e4df");
  plot.cells(low_W, cell, runs_of(shades, columns, Shade::Wall), "#1c1c1c");
  plot.polyline(thinned(path_W), kPath);
  plot.legend(kPath, title);
  return plot.document(title);
}

}  // namespace server::mapping
