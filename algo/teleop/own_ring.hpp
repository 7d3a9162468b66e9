// algo/teleop/own_ring.hpp: the readings of a robot's own sonars for the laws for driving by hand.
#pragma once

#include "algo/observation.hpp"
#include "algo/telemetry.hpp"
#include "algo/teleop/sonar_ring.hpp"

namespace algo {

/// Keeps the newest echo of each sonar. An echo stays where it was heard while the robot moves on.
class OwnRing {
 public:
  void reset() { echoes_.clear(); }
  /// Takes the readings of every tick. Allocates only while new sonars appear.
  void take(const Observation& observation);
  /// The readings for a robot at `pose_W` at `now` [s, run clock]: the nearest echo of the sonars
  /// whose axes lie in each cone, D_max without one, and NaN for a sonar that has been silent for
  /// longer than kOldestEcho. A cone without a sonar reads D_max.
  Ring read(const Pose2& pose_W, double now, const Parameters& parameters) const;

 private:
  Recycled<Echo> echoes_{};
};

}  // namespace algo
