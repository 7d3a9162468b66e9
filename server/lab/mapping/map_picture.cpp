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
  bool any = false;
  Part part;
  map.each_cell([&](const OccupancyMap::Index& at, const OccupancyMap::Tally& tally) {
    if (shade(tally) == Shade::Unknown) return;
    if (!any) part = {at.i, at.i + 1, at.j, at.j + 1};
    any = true;
    part.left = std::min(part.left, at.i);
    part.right = std::max(part.right, at.i + 1);
    part.bottom = std::min(part.bottom, at.j);
    part.top = std::max(part.top, at.j + 1);
  });
  return {part.left - kEdge, part.right + kEdge, part.bottom - kEdge, part.top + kEdge};
}

/// A picture of the map's cells, `block` of them along the edge of each of its own.
struct Shades {
  int block = 1;
  int columns = 0, rows = 0;
  std::vector<Shade> cells{};
};

/// A block is a wall if any of its cells is one, else free if any is free.
Shades shades_of(const OccupancyMap& map, const Part& part) {
  Shades out;
  out.block = (std::max(part.columns(), part.rows()) + kMostColumns - 1) / kMostColumns;
  out.columns = (part.columns() + out.block - 1) / out.block;
  out.rows = (part.rows() + out.block - 1) / out.block;
  out.cells.resize(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows));
  map.each_cell([&](const OccupancyMap::Index& at, const OccupancyMap::Tally& tally) {
    const Shade seen = shade(tally);
    if (seen == Shade::Unknown) return;
    const int column = (at.i - part.left) / out.block;
    const int row = (at.j - part.bottom) / out.block;
    Shade& cell = out.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(out.columns) +
                            static_cast<std::size_t>(column)];
    cell = std::max(cell, seen);
  });
  return out;
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
  const Shades shades = shades_of(map, part);
  const double cell = map.cell_edge() * shades.block;
  const Vec2 low_W = map.cell_edge() * Vec2(part.left, part.bottom);
  const Vec2 high_W = low_W + cell * Vec2(shades.columns, shades.rows);
  constexpr const char* kPath = "stroke=\"#3f88c5\" stroke-width=\"1\"";
  experiment::SvgPlot plot(low_W, high_W, kWidth, 1);
  plot.cells(low_W, cell, runs_of(shades.cells, shades.columns, Shade::Free), "#e4e4df");
  plot.cells(low_W, cell, runs_of(shades.cells, shades.columns, Shade::Wall), "#1c1c1c");
  plot.polyline(thinned(path_W), kPath);
  plot.legend(kPath, title);
  return plot.document(title);
}

}  // namespace server::mapping
