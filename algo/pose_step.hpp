// algo/pose_step.hpp: the way from one pose to another, as the robot at the first sees it.
#pragma once

#include "algo/types.hpp"

namespace algo {

/// The pose `to_W` in the frame of `from_W`: compose(from_W, pose_step(from_W, to_W)) is `to_W`.
inline Pose2 pose_step(const Pose2& from_W, const Pose2& to_W) {
  const Vec2 ahead = direction(from_W.heading);
  const Vec2 way = to_W.position() - from_W.position();
  return {ahead.dot(way),
          ahead.x() * way.y() - ahead.y() * way.x(),
          wrap_angle(to_W.heading - from_W.heading)};
}

}  // namespace algo
