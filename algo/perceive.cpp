// algo/perceive.cpp: nearest return on either side.
#include "algo/perceive.hpp"

#include "algo/geometry.hpp"

namespace algo {
namespace {

std::optional<Nearest> nearest(const Pose2& pose_W, const LaserScan& scan, BeamSpan beams) {
  const auto hit = nearest_beam(scan, beams);
  if (!hit) return std::nullopt;
  const std::size_t i = hit->beam;
  const Vec2 point_W = beam_point_W(pose_W, scan.mount_R, scan.angle(i), scan.ranges[i]);
  return Nearest{static_cast<std::uint32_t>(i), point_W, hit->distance};
}

}  // namespace

void perceive(const Pose2& pose_W, Scene& scene) {
  scene.right = nearest(pose_W, scene.scan, right_beams(scene.scan));
  scene.left = nearest(pose_W, scene.scan, left_beams(scene.scan));
}

}  // namespace algo
