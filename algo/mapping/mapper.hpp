// algo/mapping/mapper.hpp: builds a map from scans and odometry, with scan matching if enabled.
#pragma once

#include <optional>

#include "algo/laser_scan.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

struct MapperSettings {
  bool match = true;      // false: trusts the odometry
  double cell = 0.05;     // [m]
  double reach = 20;      // [m] farther returns are ignored
  double new_way = 0.25;  // [m] travel between two scans that enter the map,
  double new_turn = 0.2;  // [rad] or turn
  double lost = 0.3;      // smallest share of a scan's points on the map without a search
  MatchPrior prior{};
};

/// Takes scans one by one. It places each by the odometry's step since the last, and then matches
/// it to the map. Now and then a scan enters the map. Old walls stay: a returning robot is
/// corrected by them if its error is smaller than the search window.
class Mapper {
 public:
  /// The map is a square of `side` cells about `centre_W`.
  Mapper(const MapperSettings& settings, int side, const Vec2& centre_W);

  /// Takes a scan of a robot at the odometry pose `odometry_W`. Returns its pose in the map; the
  /// first pose is that of the odometry.
  Pose2 add(const LaserScan& scan, const Pose2& odometry_W);

  const OccupancyMap& map() const { return map_; }
  /// The match of the newest scan.
  const ScanMatch& match() const { return match_; }

 private:
  void place(const LaserScan& scan, const Pose2& guess_W);
  bool is_new() const;

  MapperSettings settings_{};
  OccupancyMap map_;
  ScanMatcher matcher_{};
  ScanMatch match_{};
  std::optional<Pose2> odometry_W_{};  // of the previous scan
  std::optional<Pose2> entered_W_{};   // pose of the last scan that entered the map
};

}  // namespace algo
