// algo/full_strip/strip_senses.cpp: scans into map and tracks.
#include "algo/full_strip/strip_senses.hpp"

#include <algorithm>

#include "algo/full_strip/mixed_beam.hpp"
#include "algo/full_strip/step_cost.hpp"

namespace algo {
namespace {

constexpr double kTrace = 0.25;      // [m] around an obstacle found moving: its traces in the map
constexpr double kRemembered = 100;  // [m] of way, after which a wall not seen again is old
constexpr double kClose = 0.15;      // [m] from the circle about the hull
constexpr int kSurveyed = 8;         // tiles of the map a tick, for planning

}  // namespace

StripSenses::StripSenses() {
  close_W_.reserve(LocalMap::kMostBeams);
  map_.remember_for(static_cast<std::uint16_t>(kRemembered / LocalMap::kWayUnit));
}

void StripSenses::reset(const Pose2& start_W) {
  map_.reset(start_W.position());
  memory_.reset();
  tracker_.reset();
  points_.reset();
  close_W_.clear();
  placed_ = false;
}

void StripSenses::move(const MapMove& move, const Pose2& here_W, const HullCheck& hull) {
  memory_.draw(move);
  const StepCost cost = StepCost::of_hull(hull.half_width(), hull.is_round());
  for (const Vec2& middle_W : LocalMap::windows_over(memory_)) {
    map_.draw(middle_W, move.walls_W);
    map_.survey(LocalMap::kInner * LocalMap::kInner, cost.least, hull.is_round(), memory_);
  }
  map_.draw(here_W.position(), move.walls_W);
  map_.seen().move(move);
  tracker_.reset();
  points_.reset();
  close_W_.clear();
}

void StripSenses::update(const ControlInput& in, const HullCheck& hull, bool track) {
  const Pose2& here = in.odometry.pose;
  points_.follow(here, in.stamp);
  map_.follow(here.position(), &memory_);
  memory_.drive(here.position());
  if (!placed_) hull.take_place(map_.seen(), here);
  placed_ = true;
  hull.stand_on(map_.seen(), here);
  const LaserScan& scan = in.scene->scan;
  if (in.scene->fresh && scan.size() > 0) {
    const Pose2 sensor_W = points_.map(scan);
    if (track) tracker_.update(scan, sensor_W, points_.points_W());
    map_.insert(scan, sensor_W, points_.points_W(), tracker_);
    memory_.look(scan, sensor_W);
    find_close(scan, in);
    forget_traces(in, hull);
  }
  const double least = StepCost::of_hull(hull.half_width(), hull.is_round()).least;
  map_.survey(kSurveyed, least, hull.is_round(), memory_);
  tracker_.predict(in.stamp);
}

void StripSenses::find_close(const LaserScan& scan, const ControlInput& in) {
  const Vec2 here_W = in.odometry.pose.position();
  const double reach = in.spec->radius + kClose;
  close_W_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec2& end_W = points_.points_W()[i];
    if (scan.status[i] != Beam::Ok || (end_W - here_W).squaredNorm() >= reach * reach) continue;
    if (beam_end(scan, i) == BeamEnd::Surface) close_W_.push_back(end_W);
  }
}

/// Frees impossible obstacles from the map: on the way of an obstacle found moving, and inside the
/// robot's own hull, which no sensor looks at.
void StripSenses::forget_traces(const ControlInput& in, const HullCheck& hull) {
  for (const Track& track : tracker_.just_found()) {
    const Vec2 way_W = track.velocity_W * track.age;
    const double length = way_W.norm();
    const double reach = track.radius + kTrace;
    map_.erase_near(track.position_W, reach + length, [&](const Vec2& point_W) {
      const Vec2 d = point_W - track.position_W;
      const double back = length > 0 ? std::clamp(-d.dot(way_W) / (length * length), 0.0, 1.0) : 0;
      return (d + back * way_W).squaredNorm() < reach * reach;
    });
  }
  const Pose2& here = in.odometry.pose;
  map_.erase_near(here.position(), in.spec->radius, [&](const Vec2& point_W) {
    return hull.covers(here, point_W);
  });
}

}  // namespace algo
