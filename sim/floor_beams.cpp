// sim/floor_beams.cpp: two parallel beams on each side.
#include "sim/floor_beams.hpp"

#include <cmath>

namespace sim {

std::array<FloorBeam, 4> floor_beams(const algo::FloorSensors& sensors, const SpacePose& robot) {
  const double sine = std::sin(sensors.angle);
  const double cosine = std::cos(sensors.angle);
  const algo::Vec3 across_R(sine, 0, cosine);  // from a near sensor to its far one
  const auto beam = [&](double y, double raised) {
    const algo::Vec3 from_R = algo::Vec3(sensors.x, y, sensors.height) + raised * across_R;
    return FloorBeam{.from_W = robot.origin_W + robot.axes_W * from_R,
                     .way_W = robot.axes_W * algo::Vec3(cosine, 0, -sine),
                     .across_W = robot.axes_W * across_R};
  };
  const double left = sensors.half_spacing;
  return {beam(left, sensors.separation),
          beam(-left, sensors.separation),
          beam(left, 0),
          beam(-left, 0)};
}

algo::FloorSensors geometry_of(const FloorSensorConfig& config) {
  return {config.x, config.height, config.half_spacing, config.angle, config.separation};
}

}  // namespace sim
