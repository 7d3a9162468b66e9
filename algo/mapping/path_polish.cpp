// algo/mapping/path_polish.cpp: passes over all scans.
#include "algo/mapping/path_polish.hpp"

#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"

namespace algo {
namespace {

constexpr int kPasses = 2;
constexpr MatchPrior kPolishPrior{.position = 0.2, .heading = 0.4};  // where no wall tells

OccupancyMap drawn_along(std::span<const Pose2> path_W,
                         std::span<const LaserScan> scans,
                         const MapperSettings& settings) {
  OccupancyMap map(settings.cell);
  Pose2 entered_W{};
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    if (i > 0 && !apart(entered_W, path_W[i], settings)) continue;
    map.insert(scans[i], compose(path_W[i], scans[i].mount_R), settings.reach);
    entered_W = path_W[i];
  }
  return map;
}

}  // namespace

std::vector<Pose2> polish_path(std::span<const Pose2> path_W,
                               std::span<const LaserScan> scans,
                               const MapperSettings& settings) {
  std::vector<Pose2> polished_W(path_W.begin(), path_W.end());
  ScanMatcher matcher;
  for (int pass = 0; pass < kPasses; ++pass) {
    const OccupancyMap map = drawn_along(polished_W, scans, settings);
    for (std::size_t i = 1; i < polished_W.size(); ++i) {
      matcher.take(scans[i], settings.reach);
      polished_W[i] = matcher.match(map, polished_W[i], kPolishPrior).pose_W;
    }
  }
  return polished_W;
}

}  // namespace algo
