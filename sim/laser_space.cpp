// sim/laser_space.cpp: the sweep of a scanner on ground that is not level.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sim/laser_model.hpp"

namespace sim {
namespace {

/// `a` moved towards `b` by `share` of the way. The two are one physics step apart, so that the
/// axes stay at right angles for all purposes.
SpacePose between(const SpacePose& a, const SpacePose& b, double share) {
  return {a.origin_W + share * (b.origin_W - a.origin_W), a.axes_W + share * (b.axes_W - a.axes_W)};
}

}  // namespace

/// Casts the beams in space, each from the scanner's own pose at its instant, and writes ranges and
/// hits as the planar caster does.
void LaserModel::cast_in_space(double end, const PoseTrail& trail, const SolidCaster& solids) {
  const auto pose_at = [&](const algo::Pose2& robot_W, const algo::Tilt& tilt) {
    return mounted(space_pose(robot_W, tilt), config_.mount_R, config_.height);
  };
  work_->space.resize(pattern_.beams);
  if (!config_.rolling) {
    const SpacePose still = pose_at(trail.at(end), trail.tilt_at(end));
    for (std::size_t i = 0; i < pattern_.beams; ++i) {
      work_->space[i] = {still.origin_W, still.axes_W * algo::Vec3(ux_[i], uy_[i], 0)};
    }
    up_W_ = still.axes_W.col(2);
  } else {
    const double begin = end - config_.turns * config_.mirror_period;
    const double step = trail.step();
    // The poses at the physics steps within the sweep and on either side of it.
    std::vector<SpacePose>& poses = work_->space_poses;
    poses.clear();
    const double first = std::floor((begin - trail.newest()) / step);
    for (double k = first; trail.newest() + (k - 1) * step < end; ++k) {
      const double time = std::min(trail.newest() + k * step, trail.newest());
      poses.push_back(pose_at(trail.at(time), trail.tilt_at(time)));
    }
    up_W_ = poses[poses.size() / 2].axes_W.col(2);
    std::size_t shot = 0;
    for (std::size_t turn = 0; turn < config_.turns; ++turn) {
      for (std::size_t i = turn; i < pattern_.beams; i += config_.turns, ++shot) {
        const double steps = (begin + fired_[shot] - trail.newest()) / step - first;
        const auto k = std::min(static_cast<std::size_t>(steps), poses.size() - 2);
        const SpacePose at = between(poses[k], poses[k + 1], steps - static_cast<double>(k));
        const algo::Vec3 way = at.axes_W * algo::Vec3(ux_[i], uy_[i], 0);
        work_->space[i] = {at.origin_W, way.normalized()};
      }
    }
  }
  for (std::size_t i = 0; i < pattern_.beams; ++i) {
    cast_one(work_->space[i], solids, work_->ranges[i], work_->hits[i]);
  }
  if (!config_.mixed_pixels) return;
  mark_edges();
  cast_spots(solids);
}

/// One ray, with the effect of the surface that it meets.
void LaserModel::cast_one(const SpaceRay& ray,
                          const SolidCaster& solids,
                          double& range,
                          std::uint32_t& number) const {
  range = config_.range_max;
  number = RangeCaster::kNothing;
  const auto hit = solids.cast(ray.from_W, ray.way_W, config_.range_max);
  if (!hit) return;
  number = hit->of == nullptr ? kFloor : hit->number;
  range = hit->range;
  if (!config_.reflectivity || hit->of == nullptr) return;
  const Echo echo = echo_of(*hit->of, hit->range, -ray.way_W.dot(hit->normal_W));
  if (echo == Echo::Returned) return;
  number = echo == Echo::Dark ? kNoEcho : RangeCaster::kNothing;
  range = config_.range_max;
}

/// Casts the further rays of the spots on edges, side by side in the scan plane.
void LaserModel::cast_spots(const SolidCaster& solids) {
  if (spots_ == 0) return;
  const auto across = spot_rays();
  work_->more_ranges.resize(spots_ * across.size());
  work_->more_hits.resize(work_->more_ranges.size());
  std::size_t ray = 0;
  for (const std::uint32_t edge : std::span(work_->edges).first(spots_)) {
    const SpaceRay& beam = work_->space[edge];
    const algo::Vec3 left_W = up_W_.cross(beam.way_W).normalized();
    for (const SpotRay& each : across) {
      const SpaceRay part{beam.from_W + each.aside * left_W,
                          each.way.x() * beam.way_W + each.way.y() * left_W};
      cast_one(part, solids, work_->more_ranges[ray], work_->more_hits[ray]);
      ++ray;
    }
  }
  judge();
}

}  // namespace sim
