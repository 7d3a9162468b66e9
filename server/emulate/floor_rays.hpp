// server/emulate/floor_rays.hpp: what the emulated floor sensors see of the world's ground.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "algo/ground_sense.hpp"
#include "algo/robot.hpp"
#include "drivers/psd_protocol.hpp"
#include "sim/scenario.hpp"
#include "sim/solid_caster.hpp"

namespace server::emulate {

/// Sensors that see a flat floor at 20 and 28 cm, on the front of a hull of `half_length` [m].
algo::FloorSensors usual_floor_sensors(double half_length);

class FloorRays {
 public:
  FloorRays(const sim::Scenario& scenario, const algo::FloorSensors& sensors);

  /// [m] along each beam, in the order of FloorRanges; infinity: nothing. `now` [s, run clock].
  std::array<double, drivers::psd::kSensors> sense(double now,
                                                   const algo::Pose2& robot_W,
                                                   const algo::Tilt& tilt);

 private:
  algo::FloorSensors sensors_;
  std::vector<algo::Obstacle> moving_{};
  sim::SolidCaster caster_{};
};

}  // namespace server::emulate
