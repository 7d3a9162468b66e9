// sim/floor_beams.hpp: where the beams of the floor sensors begin, and which way they go.
#pragma once

#include <array>

#include "algo/ground_sense.hpp"
#include "algo/types.hpp"
#include "sim/sensor_configs.hpp"
#include "sim/space_pose.hpp"

namespace sim {

struct FloorBeam {
  algo::Vec3 from_W{0, 0, 0};
  algo::Vec3 way_W{0, 0, 0};     // of length 1
  algo::Vec3 across_W{0, 0, 0};  // in the upright plane of the beam, at right angles to it
};

/// Far left, far right, near left, near right: the order of algo::FloorRanges.
std::array<FloorBeam, 4> floor_beams(const algo::FloorSensors& sensors, const SpacePose& robot);

/// Where the sensors of `config` sit.
algo::FloorSensors geometry_of(const FloorSensorConfig& config);

}  // namespace sim
