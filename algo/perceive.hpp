// algo/perceive.hpp: the block "local localization" of the thesis (Fig. 22): finds the nearest
// obstacle point on either side in the filtered scan.
#pragma once

#include "algo/telemetry.hpp"
#include "algo/types.hpp"

namespace algo {

/// Fills scene.left and scene.right from scene.scan, which was taken with the robot at `pose_W`. A
/// side without a return below range_max is empty (equations.md C).
void perceive(const Pose2& pose_W, Scene& scene);

/// Enters the new `readings` of a robot at `pose_W` into `ring`, which has an echo for each sonar.
void hear(const Pose2& pose_W, const Recycled<RangeReading>& readings, Recycled<Echo>& ring);

/// The same as the scan's from a sonar ring: hears the new `readings`, then finds the nearest echo
/// of the used field on either side.
void perceive(const Pose2& pose_W, const Recycled<RangeReading>& readings, Scene& scene);

/// This tick's scan of a scanner that looks ahead; null if there is no new one. A scanner that
/// looks back says nothing about the way ahead.
const LaserScan* front_scan(const Observation& observation);

/// True if a scan is too blind to drive by: fewer than half of the beams within 45 degrees of
/// straight ahead are Ok or Free. The sun or another scanner causes this.
bool blinded(const LaserScan& scan);

}  // namespace algo
