// algo/driving.hpp: what all controllers share: from a direction to a twist, the turn at the end,
// and whether the numbers they read are numbers.
#pragma once

#include "algo/controller.hpp"

namespace algo {

/// The twist along `bearing_W` [rad]: Dth = wrap(bearing - th), w = clamp(gain Dth, +-w_max),
/// v = speed max(0, cos Dth).
Twist2 drive_along(const Pose2& pose_W,
                   double bearing_W,
                   double speed,
                   const Parameters& parameters);

/// The twist towards `pass_W`: e = pass - p, along e at v = min(v_max, |e| v_max / S); zero for
/// e = 0 (equations.md D).
Twist2 drive_to(const Pose2& pose_W, const Vec2& pass_W, const Parameters& parameters);

/// Turns in place to a wanted heading; at rest when there is none or it is reached.
Twist2 turn_to(const Pose2& pose_W, const SetGoal& goal, const Parameters& parameters);

/// Whether every number a controller may read is finite; the ranges of Ok beams only, since those
/// of the others are not distances.
bool all_finite(const ControlInput& in, const Parameters& parameters);

}  // namespace algo
