// server/lab/mapping/sharpness.cpp: counts the cells that the scans of a piece hit.
#include "server/lab/mapping/sharpness.hpp"

#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace server::mapping {
namespace {

constexpr double kCell = 0.04;    // [m]
constexpr double kReach = 15;     // [m]
constexpr double kMapPiece = 10;  // [m]

class Cells {
 public:
  void add(const algo::LaserScan& scan, const algo::Pose2& pose_W) {
    const algo::Pose2 sensor_W = algo::compose(pose_W, scan.mount_R);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.status[i] != algo::Beam::Ok || scan.ranges[i] > kReach) continue;
      add(algo::to_parent(sensor_W, scan.ranges[i] * algo::direction(scan.angle(i))));
    }
  }
  std::size_t count() const { return cells_.size(); }
  void clear() { cells_.clear(); }

 private:
  void add(const algo::Vec2& point_W) {
    const auto column = static_cast<std::int64_t>(std::floor(point_W.x() / kCell));
    const auto row = static_cast<std::int64_t>(std::floor(point_W.y() / kCell));
    cells_.insert(column * (std::int64_t{1} << 32) + row);
  }
  std::unordered_set<std::int64_t> cells_{};
};

}  // namespace

std::vector<std::size_t> wall_cells(std::span<const algo::LaserScan> scans,
                                    std::span<const algo::Pose2> path_W,
                                    std::span<const algo::Pose2> reference_W) {
  std::vector<std::size_t> counts;
  Cells cells;
  double length = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > 0) length += (reference_W[i].position() - reference_W[i - 1].position()).norm();
    if (length >= kMapPiece) {
      counts.push_back(cells.count());
      cells.clear();
      length = 0;
    }
    cells.add(scans[i], path_W[i]);
  }
  if (cells.count() > 0) counts.push_back(cells.count());
  return counts;
}

}  // namespace server::mapping
