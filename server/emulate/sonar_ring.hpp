// server/emulate/sonar_ring.hpp: the sixteen sonars of a Pioneer 3-DX in a simulated world.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/types.hpp"
#include "drivers/emulators/base.hpp"
#include "sim/range_caster.hpp"
#include "sim/scenario.hpp"

namespace server::emulate {

/// One sonar of the front array and one of the rear ping every 40 ms, in turn.
class SonarRing {
 public:
  explicit SonarRing(const sim::Scenario& scenario);

  /// Appends the echoes of the pings due by `now` [s, run clock].
  void sense(double now,
             const algo::Pose2& robot_W,
             std::vector<drivers::emulators::SonarEcho>& echoes);

 private:
  double range(std::uint8_t index, const algo::Pose2& robot_W);

  std::vector<algo::Obstacle> moving_{};
  std::vector<algo::Pose2> mounts_R_;
  sim::RangeCaster caster_;
  std::vector<double> ranges_{};  // one per ray of a cone
  std::uint64_t pings_ = 0;
};

}  // namespace server::emulate
