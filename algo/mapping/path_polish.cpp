// algo/mapping/path_polish.cpp: one more pass over all scans.
#include "algo/mapping/path_polish.hpp"

#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"

namespace algo {
namespace {

constexpr MatchPrior kPolishPrior{.position = 1, .heading = 2};  // holds the path together
constexpr double kCarried = 0.9;  // of the last scan's correction, where a scan alone tells little

}  // namespace

std::vector<Pose2> polish_path(std::span<const Pose2> path_W,
                               std::span<const LaserScan> scans,
                               const MapperSettings& settings) {
  std::vector<Pose2> polished_W;
  polished_W.reserve(path_W.size());
  OccupancyMap map(settings.cell);
  ScanMatcher matcher;
  Pose2 entered_W{};
  Pose2 correction{};  // of the scan before, seen from its fitted pose
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    matcher.take(scans[i], settings.reach);
    const Pose2 guess_W =
        compose(path_W[i],
                {kCarried * correction.x, kCarried * correction.y, kCarried * correction.heading});
    const Pose2 pose_W = matcher.match(map, guess_W, kPolishPrior).pose_W;
    correction = pose_step(path_W[i], pose_W);
    polished_W.push_back(pose_W);
    if (i > 0 && !apart(entered_W, pose_W, settings)) continue;
    map.insert(scans[i], compose(pose_W, scans[i].mount_R), settings.reach);
    entered_W = pose_W;
  }
  return polished_W;
}

}  // namespace algo
