// algo/mapping/facing.cpp: normals of the chords between neighbouring returns.
#include "algo/mapping/facing.hpp"

namespace algo {
namespace {

// The normal of a return is that of the chord between two others, one on each side.
constexpr double kHalfChord = 0.1;   // [m] from it at least,
constexpr double kChordReach = 0.3;  // [m] and at most

/// The first point after `i`, or before it, that is kHalfChord from it; point `i` if none is
/// within kChordReach.
Vec2 chord_end(std::span<const Vec2> points, std::size_t i, bool ahead) {
  const std::size_t count = ahead ? points.size() - i : i + 1;
  for (std::size_t k = 1; k < count; ++k) {
    const Vec2& p = points[ahead ? i + k : i - k];
    const double far = (p - points[i]).norm();
    if (far > kChordReach) break;
    if (far >= kHalfChord) return p;
  }
  return points[i];
}

}  // namespace

void find_facings(std::span<const Vec2> points, const Vec2& scanner, std::vector<Facing>& out) {
  out.clear();
  out.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 chord = chord_end(points, i, true) - chord_end(points, i, false);
    const Vec2 back = scanner - points[i];
    const Vec2 across(-chord.y(), chord.x());
    const bool normal = chord.norm() > 0;
    const Vec2 side = normal ? across : back;
    out.push_back({(side.dot(back) < 0 ? -1 : 1) * side.normalized(), normal});
  }
}

void FacedPoints::take(const LaserScan& scan, const Pose2& sensor, double reach) {
  points.clear();
  points.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] != Beam::Ok || scan.ranges[i] > reach) continue;
    points.push_back(to_parent(sensor, scan.ranges[i] * direction(scan.angle(i))));
  }
  find_facings(points, sensor.position(), facings);
}

}  // namespace algo
