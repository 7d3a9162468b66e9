// algo/terrain/laser_line.cpp: Eq. 11 and 12, and the points under the tracks.
#include "algo/terrain/laser_line.hpp"

#include <cmath>

namespace algo {
namespace {

constexpr double kLeastDenominator = 1e-9;  // [pixels]
constexpr double kTrackHalf = 0.05;         // [m] to either side of the middle of a track
constexpr int kFewestPoints = 3;

/// The mean of the points under one track.
std::optional<Vec3> under_track(std::span<const Vec3> line_R, double y) {
  Vec3 sum(0, 0, 0);
  int count = 0;
  for (const Vec3& p : line_R) {
    if (std::abs(p.y() - y) > kTrackHalf) continue;
    sum += p;
    ++count;
  }
  if (count < kFewestPoints) return std::nullopt;
  return Vec3(sum / count);
}

}  // namespace

std::optional<Vec3> triangulated(const LineCamera& camera, double u, double v) {
  const double denominator = camera.focal / std::tan(camera.angle) + v;
  // Written so that NaN gives no point.
  if (!(denominator > kLeastDenominator) || !std::isfinite(denominator) || !std::isfinite(u)) {
    return std::nullopt;
  }
  return camera.baseline / denominator * Vec3(camera.focal, u, v);
}

Vec3 to_robot(const LineCamera& camera, const Vec3& p_C) {
  const double c = std::cos(camera.pitch);
  const double s = std::sin(camera.pitch);
  return {
      c * p_C.x() + s * p_C.z() + camera.x, p_C.y(), -s * p_C.x() + c * p_C.z() + camera.height};
}

std::optional<TrackPoints> under_tracks(std::span<const Vec3> line_R, double track) {
  const auto left = under_track(line_R, track / 2);
  const auto right = under_track(line_R, -track / 2);
  if (!left || !right) return std::nullopt;
  return TrackPoints{*left, *right};
}

}  // namespace algo
