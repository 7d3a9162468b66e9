// algo/mapping/facing.hpp: which way the returns of a scan and the walls of a map face.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

/// A wall is seen from one side. What the next scan sees may be its other side, or the opposite
/// side of a niche, centimetres or a door's width away.
struct Facing {
  Vec2 side{0, 0};      // unit; zero if nothing is known
  bool normal = false;  // the surface's normal; else only the direction to the scanner

  Facing turned(double angle) const { return {to_parent(Pose2{0, 0, angle}, side), normal}; }
};

/// Whether two points can lie on one surface, by their sides.
inline bool may_be_one(const Facing& a, const Facing& b) {
  constexpr double kTurned = 0.5;  // cosine of the largest angle between two normals of one surface
  if (a.side.isZero() || b.side.isZero()) return true;
  return a.side.dot(b.side) > (a.normal && b.normal ? kTurned : 0);
}

/// The facing of each of the returns `points`, in the order of their beams, of a scanner at
/// `scanner`, all in one frame. The normal is that of the chord between two neighbours.
void find_facings(std::span<const Vec2> points, const Vec2& scanner, std::vector<Facing>& out);

/// The Ok beams of a scan up to some reach as points, and their facings.
struct FacedPoints {
  std::vector<Vec2> points{};
  std::vector<Facing> facings{};

  /// `sensor`: pose of the scanner in the frame of the points.
  void take(const LaserScan& scan, const Pose2& sensor, double reach);
};

}  // namespace algo
