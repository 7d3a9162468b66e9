// algo/perceive.cpp: nearest return on either side.
#include "algo/perceive.hpp"

#include <cmath>
#include <numbers>

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

/// The entry of the sonar at `mount_R` in the ring; a new one at its first report.
Echo& echo_of(Recycled<Echo>& ring, const Pose2& mount_R) {
  for (Echo& echo : ring) {
    if (echo.mount_R == mount_R) return echo;
  }
  Echo& echo = ring.append();
  echo = {};
  echo.mount_R = mount_R;
  return echo;
}

}  // namespace

void hear(const Pose2& pose_W, const Recycled<RangeReading>& readings, Recycled<Echo>& ring) {
  for (const RangeReading& reading : readings) {
    if (reading.status == Beam::Invalid) continue;
    Echo& echo = echo_of(ring, reading.mount_R);
    echo.stamp = reading.stamp;
    echo.hit = reading.status == Beam::Ok;
    if (echo.hit) echo.point_W = beam_point_W(pose_W, reading.mount_R, 0, reading.range);
  }
}

void perceive(const Pose2& pose_W, const Recycled<RangeReading>& readings, Scene& scene) {
  hear(pose_W, readings, scene.echoes);
  scene.left.reset();
  scene.right.reset();
  for (std::size_t k = 0; k < scene.echoes.size(); ++k) {
    const Echo& echo = scene.echoes[k];
    const Vec2 way = echo.point_W - pose_W.position();
    const double bearing = wrap_angle(std::atan2(way.y(), way.x()) - pose_W.heading);
    if (!echo.hit || std::abs(bearing) > kUsedHalfField) continue;
    std::optional<Nearest>& side = bearing >= 0 ? scene.left : scene.right;
    if (side && side->distance <= way.norm()) continue;
    side = Nearest{static_cast<std::uint32_t>(k), echo.point_W, way.norm()};
  }
}

void perceive(const Pose2& pose_W, Scene& scene) {
  scene.right = nearest(pose_W, scene.scan, right_beams(scene.scan));
  scene.left = nearest(pose_W, scene.scan, left_beams(scene.scan));
}

const LaserScan* front_scan(const Observation& observation) {
  for (const LaserScan& scan : observation.scans) {
    if (std::abs(scan.mount_R.heading) <= std::numbers::pi / 2) return &scan;
  }
  return nullptr;
}

bool blinded(const LaserScan& scan) {
  constexpr double kAhead = std::numbers::pi / 4;  // [rad] either side
  const auto ahead = [&scan](std::size_t i) {
    return std::abs(wrap_angle(scan.mount_R.heading + scan.angle(i))) <= kAhead;
  };
  std::size_t silent = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == Beam::Invalid && ahead(i)) ++silent;
  }
  // Invalid beams are rare: stop counting once the forward beams are twice as many. Most of these
  // are near the middle, so start there.
  std::size_t looking = 0;
  for (std::size_t k = 0; k < scan.size() && looking < 2 * silent; ++k) {
    if (ahead((scan.size() / 2 + k) % scan.size())) ++looking;
  }
  return looking < 2 * silent;
}

}  // namespace algo
