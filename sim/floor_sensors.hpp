// sim/floor_sensors.hpp: the model of four infrared distance sensors that look at the floor ahead.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "algo/observation.hpp"
#include "sim/floor_beams.hpp"
#include "sim/random.hpp"
#include "sim/sensor.hpp"
#include "sim/solid_caster.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const FloorSensorConfig& config);

/// Each reading is the true distance through the sensor's curve (algo/terrain/psd_curve.hpp), with
/// noise on the voltage and a 12 bit converter. The error so grows with the square of the distance.
class FloorSensorModel final : public Sensor {
 public:
  /// Throws std::invalid_argument with the defect.
  FloorSensorModel(const FloorSensorConfig& config, std::uint64_t seed);

  void add(const algo::Obstacle& obstacle) override { solids_.add(obstacle); }
  void move(std::uint32_t id, const algo::Pose2& pose_W) override { solids_.move(id, pose_W); }
  void remove(std::uint32_t id) override { solids_.remove(id); }
  /// A new reading each period; none in between.
  void sense(const Surroundings& around, algo::Observation& observation) override;

  /// One reading now, for a robot whose R is at `pose_W`, `tilt`.
  algo::FloorRanges read(double stamp, const algo::Pose2& pose_W, const algo::Tilt& tilt);

 private:
  double range_along(const FloorBeam& beam);

  FloorSensorConfig config_{};
  SolidCaster solids_{};
  Every every_;
  Random noise_;
  RareEvents glitches_;
};

}  // namespace sim
