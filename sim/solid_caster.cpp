// sim/solid_caster.cpp: a ray against convex outlines below planes.
#include "sim/solid_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {
namespace {

constexpr double kAlong = 1e-12;  // of a unit vector's part: below it a ray is upright or level

bool inside(const std::vector<algo::Vec2>& outline, const algo::Vec2& p) {
  const algo::Vec2* a = &outline.back();
  for (const algo::Vec2& b : outline) {
    if (algo::cross(b - *a, p - *a) < 0) return false;
    a = &b;
  }
  return true;
}

}  // namespace

void SolidCaster::measure(Solid& solid) {
  const algo::Obstacle& o = solid.obstacle;
  solid.centre_W = o.pose_W.position();
  solid.top = o.height;
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&o.shape)) {
    solid.bound = cylinder->radius;
    return;
  }
  solid.outline_W = algo::outline_W(o);
  solid.bound = 0;
  solid.outward_W.clear();
  const algo::Vec2* a = &solid.outline_W.back();
  for (const algo::Vec2& b : solid.outline_W) {
    solid.bound = std::max(solid.bound, (b - solid.centre_W).norm());
    const algo::Vec2 edge = b - *a;
    solid.outward_W.push_back(algo::Vec2(edge.y(), -edge.x()).normalized());
    a = &b;
  }
  if (const auto* ramp = std::get_if<algo::Ramp>(&o.shape)) {
    solid.slope_W = (o.height - ramp->low) / ramp->length * algo::direction(o.pose_W.heading);
    solid.top = (o.height + ramp->low) / 2 - solid.slope_W.dot(solid.centre_W);
  }
}

void SolidCaster::add(const algo::Obstacle& obstacle) {
  solids_.push_back({.obstacle = obstacle});
  measure(solids_.back());
  if (algo::is_ground(obstacle)) ++ground_;
}

void SolidCaster::move(std::uint32_t id, const algo::Pose2& pose_W) {
  const std::size_t index = find(id);
  if (index == solids_.size()) return;
  solids_[index].obstacle.pose_W = pose_W;
  measure(solids_[index]);
}

void SolidCaster::remove(std::uint32_t id) {
  const std::size_t index = find(id);
  if (index == solids_.size()) return;
  if (algo::is_ground(solids_[index].obstacle)) --ground_;
  solids_.erase(solids_.begin() + static_cast<std::ptrdiff_t>(index));
}

std::size_t SolidCaster::find(std::uint32_t id) const {
  const auto found =
      std::ranges::find_if(solids_, [id](const Solid& s) { return s.obstacle.id == id; });
  return static_cast<std::size_t>(found - solids_.begin());
}

std::optional<SolidHit> SolidCaster::cast(const algo::Vec3& from,
                                          const algo::Vec3& way,
                                          double range_max) const {
  SolidHit hit{.range = range_max};
  meet_floor(from, way, hit);
  for (const Solid& solid : solids_) meet(solid, from, way, hit);
  if (hit.range >= range_max) return std::nullopt;
  return hit;
}

std::optional<SolidCaster::Span> SolidCaster::over(const Solid& solid,
                                                   const algo::Vec3& from,
                                                   const algo::Vec3& way) {
  Span span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const algo::Vec2 origin = from.head<2>();
  const algo::Vec2 along = way.head<2>();
  if (solid.outline_W.empty()) {
    const algo::Vec2 to_centre = solid.centre_W - origin;
    const double square = along.squaredNorm();
    if (square < kAlong * kAlong) {
      if (to_centre.norm() > solid.bound) return std::nullopt;
      return span;
    }
    const double middle = to_centre.dot(along) / square;
    const double off = (to_centre - middle * along).squaredNorm();
    const double chord = (solid.bound * solid.bound - off) / square;
    if (chord < 0) return std::nullopt;
    span.from = middle - std::sqrt(chord);
    span.to = middle + std::sqrt(chord);
    span.normal_W = (span.from * along - to_centre).normalized();
    return span;
  }
  for (std::size_t k = 0; k < solid.outline_W.size(); ++k) {
    const algo::Vec2& outward = solid.outward_W[k];
    const double distance = outward.dot(origin - solid.outline_W[k]);  // outside above 0
    const double rate = outward.dot(along);
    if (std::abs(rate) < kAlong) {
      if (distance > 0) return std::nullopt;
    } else if (rate < 0) {
      if (-distance / rate > span.from) {
        span.from = -distance / rate;
        span.normal_W = outward;
      }
    } else {
      span.to = std::min(span.to, -distance / rate);
    }
  }
  if (span.from >= span.to) return std::nullopt;
  return span;
}

/// False if the ray passes the solid's circle, or ends before it.
bool SolidCaster::may_meet(const Solid& solid,
                           const algo::Vec3& from,
                           const algo::Vec3& way,
                           double within) {
  const algo::Vec2 to_centre = solid.centre_W - from.head<2>();
  const double reach = solid.bound + within;
  const double aside = algo::cross(algo::Vec2(way.head<2>()), to_centre);
  const double run = way.head<2>().squaredNorm();
  return to_centre.squaredNorm() <= reach * reach &&
         aside * aside <= solid.bound * solid.bound * run + kAlong;
}

/// Lowers `hit` to the ray's entry into `solid`, if that is nearer.
void SolidCaster::meet(const Solid& solid,
                       const algo::Vec3& from,
                       const algo::Vec3& way,
                       SolidHit& hit) const {
  if (std::holds_alternative<algo::Trench>(solid.obstacle.shape)) return;  // part of the floor
  if (!may_meet(solid, from, way, hit.range)) return;
  const auto span = over(solid, from, way);
  if (!span || span->to <= 0 || span->from >= hit.range) return;
  if (solid.obstacle.bottom > 0) return meet_raised(solid, *span, from, way, hit);
  // Height above the top, along the ray.
  const double start = from.z() - solid.top - solid.slope_W.dot(from.head<2>());
  const double rate = way.z() - solid.slope_W.dot(way.head<2>());
  const double entry = std::max(0.0, span->from);
  if (start + entry * rate < 0) {
    if (from.z() + entry * way.z() < 0) return;  // below the floor
    hit.range = entry;
    hit.normal_W = {span->normal_W.x(), span->normal_W.y(), 0};
  } else {
    if (rate >= 0) return;
    const double met = -start / rate;
    if (met > span->to || met >= hit.range) return;
    hit.range = met;
    hit.normal_W = algo::Vec3(-solid.slope_W.x(), -solid.slope_W.y(), 1).normalized();
  }
  hit.of = &solid.obstacle;
  hit.number = static_cast<std::uint32_t>(&solid - solids_.data());
}

/// The same for a solid that does not stand on the floor: between two level planes.
void SolidCaster::meet_raised(const Solid& solid,
                              const Span& span,
                              const algo::Vec3& from,
                              const algo::Vec3& way,
                              SolidHit& hit) const {
  double enters = span.from;
  double leaves = span.to;
  algo::Vec3 normal(span.normal_W.x(), span.normal_W.y(), 0);
  if (std::abs(way.z()) < kAlong) {
    if (from.z() < solid.obstacle.bottom || from.z() > solid.top) return;
  } else {
    const double low = (solid.obstacle.bottom - from.z()) / way.z();
    const double high = (solid.top - from.z()) / way.z();
    if (std::min(low, high) > enters) {
      enters = std::min(low, high);
      normal = {0, 0, way.z() > 0 ? -1.0 : 1.0};
    }
    leaves = std::min(leaves, std::max(low, high));
  }
  enters = std::max(enters, 0.0);
  if (enters >= leaves || enters >= hit.range) return;
  hit.range = enters;
  hit.normal_W = normal;
  hit.of = &solid.obstacle;
  hit.number = static_cast<std::uint32_t>(&solid - solids_.data());
}

void SolidCaster::meet_floor(const algo::Vec3& from, const algo::Vec3& way, SolidHit& hit) const {
  if (from.z() < 0 || way.z() > -kAlong) return;
  const double met = -from.z() / way.z();
  if (met >= hit.range) return;
  const algo::Vec2 there = (from + met * way).head<2>();
  for (const Solid& solid : solids_) {
    const auto* trench = std::get_if<algo::Trench>(&solid.obstacle.shape);
    if (trench == nullptr || !inside(solid.outline_W, there)) continue;
    const auto span = over(solid, from, way);
    const double bottom = (-trench->depth - from.z()) / way.z();
    const bool at_side = span && span->to < bottom;
    const double found = at_side ? span->to : bottom;
    if (found >= hit.range) return;
    hit.range = found;
    hit.of = &solid.obstacle;
    hit.number = static_cast<std::uint32_t>(&solid - solids_.data());
    if (at_side) {
      // The side is met from within: its normal looks back along the ray.
      const algo::Vec2 p = (from + found * way).head<2>() - solid.centre_W;
      const algo::Vec2 q = algo::to_child({0, 0, solid.obstacle.pose_W.heading}, p);
      const bool end = std::abs(q.x()) / trench->length > std::abs(q.y()) / trench->width;
      const algo::Vec2 back = end ? algo::Vec2(-q.x(), 0) : algo::Vec2(0, -q.y());
      const algo::Vec2 normal =
          algo::to_parent({0, 0, solid.obstacle.pose_W.heading}, back).normalized();
      hit.normal_W = {normal.x(), normal.y(), 0};
    }
    return;
  }
  hit.range = met;
}

}  // namespace sim
