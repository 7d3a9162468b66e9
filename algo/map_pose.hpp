// algo/map_pose.hpp: where a robot that knows a map is on it, and how sure that is.
#pragma once

#include <cstdint>
#include <string_view>

#include "algo/types.hpp"

namespace algo {

enum class MapFix : std::uint8_t {
  Searching,  // looks for places that fit
  Nowhere,    // none fits
  NotUnique,  // several fit
  Unsure,     // one fits, but not well enough to drive by it
  Located,
};
/// "not_unique", as REST and CSV spell it.
std::string_view name(MapFix fix);
/// For people, without numbers.
std::string_view sentence(MapFix fix);

/// The pose on the map beside the odometry, of a robot that drives by its map. Odometry::pose is
/// then the pose by matched scans, and M is W.
struct MapPose {
  MapFix fix = MapFix::Searching;
  std::uint32_t places = 0;  // that fit the scans
  std::uint32_t epoch = 0;   // how often the pose may have jumped, as where it is located anew
  Pose2 wheels{};            // by the odometry alone, in a frame of its own
  double xx = 0;             // [m2] variances of the pose in W
  double xy = 0;             // [m2]
  double yy = 0;             // [m2]
  double turn = 0;           // [rad2]
  double fit = 0;            // share of the newest scans' points on the map's walls
  bool located() const { return fix == MapFix::Located; }
  bool operator==(const MapPose&) const = default;
};

}  // namespace algo
