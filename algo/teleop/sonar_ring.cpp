// algo/teleop/sonar_ring.cpp: readings, and the virtual cones.
#include "algo/teleop/sonar_ring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/geometry.hpp"

namespace algo {
namespace {

constexpr auto kBearings = ring_bearings();

/// The beams of one virtual cone.
struct Cone {
  double nearest = std::numeric_limits<double>::infinity();  // [m] from the robot's centre
  double bearing = 0;                                        // [rad] of the nearest
  int beams = 0;                                             // that point into it
  int silent = 0;                                            // of these, without a measurement
};

/// Calls `see` for each cone that a ray from the centre at `bearing` [rad] lies in.
template <typename See>
void each_cone(std::array<Cone, kRingSonars>& cones, double bearing, See&& see) {
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    if (in_cone(kBearings[n], bearing)) see(cones[n]);
  }
}

}  // namespace

double heard(double d, const Parameters& parameters) {
  if (std::isnan(d)) return parameters[kStopDistance];
  return std::clamp(d, 0.0, parameters[kRingReach]);
}

double nearest_heard(std::span<const double> distances, const Parameters& parameters) {
  if (distances.empty()) return parameters[kStopDistance];
  double least = parameters[kRingReach];
  for (const double d : distances) least = std::min(least, heard(d, parameters));
  return least;
}

Ring virtual_sonars(const LaserScan& scan, const Parameters& parameters) {
  std::array<Cone, kRingSonars> cones{};
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool ok = scan.status[i] == Beam::Ok && std::isfinite(scan.ranges[i]);
    const bool silent = !ok && scan.status[i] != Beam::Free;
    each_cone(cones, scan.mount_R.heading + scan.angle(i), [silent](Cone& cone) {
      ++cone.beams;
      if (silent) ++cone.silent;
    });
    if (!ok) continue;
    // A scanner off the centre sees a return elsewhere than the centre would.
    const Vec2 p_R = beam_point_R(scan.mount_R, scan.angle(i), scan.ranges[i]);
    const double bearing = std::atan2(p_R.y(), p_R.x());
    each_cone(cones, bearing, [&](Cone& cone) {
      if (p_R.norm() < cone.nearest) cone = {p_R.norm(), bearing, cone.beams, cone.silent};
    });
  }
  Ring ring;
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    const Cone& cone = cones[n];
    const bool unknown = 2 * cone.silent > cone.beams && !std::isfinite(cone.nearest);
    ring.distances[n] = unknown ? std::numeric_limits<double>::quiet_NaN()
                                : std::min(cone.nearest, parameters[kRingReach]);
    if (std::isfinite(cone.nearest)) ring.bearings[n] = cone.bearing;
  }
  return ring;
}

}  // namespace algo
