// sim/rolling_cast.cpp: the cast for beams fired one by one from a moving sensor.
//
// The interval of beams that can hit a primitive, seen from the reference pose, is widened by the
// deviation of the rays from the pattern. Each ray in it is then tested exactly, with its own
// origin.
#include <algorithm>
#include <cmath>

#include "sim/beam_span.hpp"
#include "sim/bearing.hpp"
#include "sim/range_caster.hpp"

namespace sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// [rad] Bound of the change in bearing of a point `distance` away when the eye moves by `shift`.
/// It exceeds asin(shift / distance), for which the quotient must stay under 1/4.
double parallax(double shift, double distance) {
  return 1.1 * shift / distance;
}
constexpr double kParallaxLimit = 4;

}  // namespace

void RangeCaster::cast_rolling(const algo::Pose2& reference_W,
                               const BeamPattern& pattern,
                               const Rays& rays,
                               const RaySpread& spread,
                               double range_max,
                               std::span<double> ranges,
                               std::span<std::uint32_t> hits) {
  use_pattern(pattern);
  gather(reference_W, range_max, spread);
  primitives_.clear();
  enclosing_.clear();
  for (const std::uint32_t index : near_) {
    if (vertex_count_[index] == 0) {
      rolling_circle(index, spread);
    } else {
      rolling_outline(index, spread);
    }
  }
  start(rays.size(), range_max, !hits.empty());
  trace(rays, {});
  finish(range_max, ranges, hits);
}

void RangeCaster::cast_more(const Rays& rays,
                            std::span<const std::uint32_t> first,
                            double range_max,
                            std::span<double> ranges,
                            std::span<std::uint32_t> hits) {
  start(rays.size(), range_max, !hits.empty());
  trace(rays, first);
  finish(range_max, ranges, hits);
}

void RangeCaster::add_primitive(const Primitive& primitive, double from, double to) {
  beam_spans(from, to, full_turn_, pattern_.beams, [&](std::uint32_t begin, std::uint32_t end) {
    primitives_.push_back(primitive);
    primitives_.back().begin = begin;
    primitives_.back().end = end;
  });
}

void RangeCaster::rolling_circle(std::uint32_t index, const RaySpread& spread) {
  const algo::Vec2 c = centre_in_frame(index);
  const double radius = bound_[index];
  const double distance = c.norm();
  const double closest = distance - spread.shift;
  const Primitive circle{.px = c.x(), .py = c.y(), .radius = radius, .obstacle = index};
  if (closest <= radius || distance < kParallaxLimit * spread.shift) {
    return add_primitive(circle, 0, full_turn_);
  }
  const double half = quick_bearing(std::sqrt(closest * closest - radius * radius), radius) +
                      spread.turn + parallax(spread.shift, distance);
  const double middle = bearing(c.x(), c.y());
  const double reach = half * per_radian_ + 2 * slack_;
  add_primitive(circle, middle - reach, middle + reach);
}

void RangeCaster::rolling_outline(std::uint32_t index, const RaySpread& spread) {
  enter_frame(index);
  const std::size_t count = vertex_count_[index];
  bool outside = false;
  for (std::size_t j = 0; j < count; ++j) {
    Corner& q = outline_[j];
    Corner& p = outline_[j + 1 == count ? 0 : j + 1];
    const double area = cross(p.x, p.y, q.x, q.y);
    // Moving the eye by `shift` changes the area by at most this.
    const double doubt = spread.shift * (std::abs(q.x - p.x) + std::abs(q.y - p.y));
    outside = outside || area > doubt;
    if (area + doubt <= 0) continue;  // turned away from all rays
    const Primitive face{.px = p.x, .py = p.y, .qx = q.x, .qy = q.y, .obstacle = index};
    const double p_distance = std::sqrt(p.x * p.x + p.y * p.y);
    const double q_distance = std::sqrt(q.x * q.x + q.y * q.y);
    const bool at_the_face = area <= doubt && p.x * q.x + p.y * q.y < 0;
    if (at_the_face || std::min(p_distance, q_distance) < kParallaxLimit * spread.shift) {
      add_primitive(face, 0, full_turn_);
      continue;
    }
    double from = bearing(p);
    double width = bearing(q) - from;
    if (width > full_turn_ / 2) width -= full_turn_;
    if (width < -full_turn_ / 2) width += full_turn_;
    if (width < 0) {  // edge-on: visible to some rays, but not from the reference
      from += width;
      width = -width;
    }
    const double nearest = std::min(p_distance, q_distance);
    const double widening =
        (spread.turn + parallax(spread.shift, nearest)) * per_radian_ + 2 * slack_;
    add_primitive(face, from - widening, from + width + widening);
  }
  if (!outside) enclosing_.push_back(index);
}

/// Enters all primitives into the depth buffer of `rays`. `first` is as in cast_more(), empty for
/// one ray per beam.
void RangeCaster::trace(const Rays& rays, std::span<const std::uint32_t> first) {
  const RayArrays arrays{rays.x.data(), rays.y.data(), rays.ux.data(), rays.uy.data()};
  for (const Primitive& p : primitives_) {
    const BeamRange which =
        first.empty() ? BeamRange{p.begin, p.end} : BeamRange{first[p.begin], first[p.end]};
    if (which.begin >= which.end) continue;
    if (p.radius > 0) {
      trace_circle(arrays, p.px, p.py, p.radius, which, p.obstacle, depth_);
    } else {
      trace_segment(arrays, p.px, p.py, p.qx, p.qy, which, p.obstacle, depth_);
    }
  }
  trace_enclosing(rays);
}

/// Rays that start inside an outline read 0. Needed only for a sensor at or in a wall.
void RangeCaster::trace_enclosing(const Rays& rays) {
  for (const std::uint32_t index : enclosing_) {
    enter_frame(index);
    const std::size_t count = vertex_count_[index];
    for (std::size_t i = 0; i < rays.size(); ++i) {
      bool inside = true;
      for (std::size_t j = 0; j < count; ++j) {
        const Corner& a = outline_[j];
        const Corner& b = outline_[j + 1 == count ? 0 : j + 1];
        inside = inside &&
                 cross(a.x - rays.x[i], a.y - rays.y[i], b.x - rays.x[i], b.y - rays.y[i]) >= 0;
      }
      if (!inside) continue;
      depth_.inverse[i] = kInfinity;
      if (depth_.tag != nullptr) depth_.tag[i] = index;
    }
  }
}

}  // namespace sim
