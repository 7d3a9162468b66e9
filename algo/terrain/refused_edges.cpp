// algo/terrain/refused_edges.cpp: segments in place of beams.
#include "algo/terrain/refused_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/geometry.hpp"

namespace algo {
namespace {

/// [m] Along a beam from the origin in direction `way` to the segment; infinite if it passes by.
double distance_along(const Vec2& way, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double across = cross(way, edge);
  if (across == 0) return std::numeric_limits<double>::infinity();
  const double along_beam = cross(a, edge) / across;
  const double along_edge = cross(a, way) / across;
  const bool meets = along_beam >= 0 && along_edge >= 0 && along_edge <= 1;
  return meets ? along_beam : std::numeric_limits<double>::infinity();
}

}  // namespace

void RefusedEdges::add(const Vec2& left_W, const Vec2& right_W, double now) {
  if (count_ == kMost) {
    std::rotate(edges_.begin(), edges_.begin() + 1, edges_.end());
    --count_;
  }
  edges_[count_++] = {left_W, right_W, now};
}

void RefusedEdges::forget(double now, double memory) {
  std::size_t old = 0;
  while (old < count_ && now - edges_[old].found > memory) ++old;
  if (old == 0) return;
  std::rotate(edges_.begin(), edges_.begin() + static_cast<std::ptrdiff_t>(old), edges_.end());
  count_ -= old;
}

double RefusedEdges::ahead(const Pose2& pose_W, double half_width) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count_; ++k) {
    Vec2 a = to_child(pose_W, edges_[k].a_W);
    Vec2 b = to_child(pose_W, edges_[k].b_W);
    if (a.y() > b.y()) std::swap(a, b);
    if (a.y() > half_width || b.y() < -half_width) continue;
    // The part within the strip.
    const auto at = [&](double y) -> Vec2 {
      const double part = b.y() > a.y() ? (y - a.y()) / (b.y() - a.y()) : 0;
      return a + std::clamp(part, 0.0, 1.0) * (b - a);
    };
    for (const Vec2& p : {at(-half_width), at(half_width)}) {
      if (p.x() > 0) least = std::min(least, p.x());
    }
  }
  return least;
}

void RefusedEdges::enter(const Pose2& pose_W, LaserScan& scan) const {
  const Pose2 sensor_W = compose(pose_W, scan.mount_R);
  for (std::size_t k = 0; k < count_; ++k) {
    const Vec2 a = to_child(sensor_W, edges_[k].a_W);
    const Vec2 b = to_child(sensor_W, edges_[k].b_W);
    double from = std::atan2(a.y(), a.x());
    double to = from + wrap_angle(std::atan2(b.y(), b.x()) - from);
    if (to < from) std::swap(from, to);
    // One beam more on either side, for the rounding of the bearings.
    const double slack = scan.angle_increment;
    const BeamSpan beams = beams_between(scan, from - slack, to + slack);
    for (std::size_t i = beams.begin; i < beams.end; ++i) {
      const double range = distance_along(direction(scan.angle(i)), a, b);
      if (!(range < scan.range_max)) continue;
      if (scan.status[i] == Beam::Ok && scan.ranges[i] <= range) continue;
      scan.set_ok(i, range);
    }
  }
}

void RefusedEdges::show(Layer& layer) const {
  for (std::size_t k = 0; k < count_; ++k) {
    if (!layer.values.empty()) {
      constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
      put(layer, kBreak, kBreak);
    }
    put(layer, edges_[k].a_W, edges_[k].b_W);
  }
}

}  // namespace algo
