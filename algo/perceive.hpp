// algo/perceive.hpp: the block "local localization" of the thesis (Fig. 22): from the filtered scan
// to the nearest obstacle point on either side.
#pragma once

#include "algo/telemetry.hpp"
#include "algo/types.hpp"

namespace algo {

/// Fills scene.left and scene.right from scene.scan, taken with the robot at `pose_W`; a side
/// without a return below range_max is empty (equations.md C).
void perceive(const Pose2& pose_W, Scene& scene);

/// The same from a sonar ring: takes the new `readings` into scene.echoes, then the nearest echoes
/// of the used field either side.
void perceive(const Pose2& pose_W, const Recycled<RangeReading>& readings, Scene& scene);

/// The scan of this tick that looks ahead, null without a new one: a scanner that looks back says
/// nothing about the way ahead.
const LaserScan* front_scan(const Observation& observation);

/// Whether a scan is too blind to drive by: fewer than half of its beams within 45 degrees of
/// straight ahead measured anything, be it that nothing is there. Sun or another scanner does that.
bool blinded(const LaserScan& scan);

}  // namespace algo
