// algo/mapping/mapper.hpp: a map from scans and odometry, held together by matching where asked.
#pragma once

#include <optional>

#include "algo/laser_scan.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

struct MapperSettings {
  bool match = true;      // false: the odometry is believed
  double cell = 0.05;     // [m]
  double reach = 20;      // [m] farther returns are left out
  double new_way = 0.25;  // [m] the robot moves between two scans that enter the map,
  double new_turn = 0.2;  // [rad] or turns
  double lost = 0.3;  // share of a scan's points on the map below which it searches about itself
  MatchPrior prior{};
};

/// Scans one by one, as they come. Each is first placed by the odometry's step since the one before
/// and then moved onto what the map holds; now and then one enters the map. Old walls stay, so that
/// a robot that comes back is set right by them as long as it is off by less than the search
/// window.
class Mapper {
 public:
  /// The map is a square of `side` cells about `centre_W`.
  Mapper(const MapperSettings& settings, int side, const Vec2& centre_W);

  /// Takes a scan of a robot whose odometry says `odometry_W`. Returns where it stands in the map;
  /// the first stands where its odometry says.
  Pose2 add(const LaserScan& scan, const Pose2& odometry_W);

  const OccupancyMap& map() const { return map_; }
  /// Of the newest scan.
  const ScanMatch& match() const { return match_; }

 private:
  void place(const LaserScan& scan, const Pose2& guess_W);
  bool is_new() const;

  MapperSettings settings_{};
  OccupancyMap map_;
  ScanMatcher matcher_{};
  ScanMatch match_{};
  std::optional<Pose2> odometry_W_{};  // of the scan before
  std::optional<Pose2> entered_W_{};   // where the last scan that entered the map was taken
};

}  // namespace algo
