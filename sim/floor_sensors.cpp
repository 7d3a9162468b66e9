// sim/floor_sensors.cpp: rays over a light spot, a voltage, a converter.
#include "sim/floor_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "algo/terrain/psd_curve.hpp"

namespace sim {
namespace {

constexpr std::uint64_t kFloorPurpose = 0x50534431;  // of the noise: unlike any other sensor's
constexpr std::uint64_t kFloorGlitchPurpose = 0x50534447;
constexpr int kFloorRays = 5;                          // over the light spot
constexpr double kSight = 3.0;                         // [m] farther surfaces give no voltage
constexpr double kGlitch = 0.10;                       // [m] largest
constexpr double kCosine45 = std::numbers::sqrt2 / 2;  // cos 45 degrees
constexpr double kMostGrazing = 0.05;                  // cosine of the incidence, at least

}  // namespace

std::optional<std::string> defect(const FloorSensorConfig& config) {
  if (!within(config.x, -5, 5)) return "x must be -5 to 5 m";
  if (!within(config.height, 0.01, 2)) return "height must be 0.01 to 2 m";
  if (!within(config.half_spacing, 0.001, 2)) return "half_spacing must be 0.001 to 2 m";
  if (!within(config.angle, 0.1, 1.5)) return "angle must be 6 to 85 degrees";
  if (!within(config.separation, 0.001, 1)) return "separation must be 0.001 to 1 m";
  if (!within(config.noise, 0, 1)) return "noise must be 0 to 1 V";
  if (!within(config.spot, 0, 0.1)) return "spot must be 0 to 0.1 m";
  if (!within(config.glitches, 0, 1)) return "glitches must be 0 to 1";
  if (!within(config.period, 0.001, 1)) return "period must be 0.001 to 1 s";
  const double near = config.height / std::sin(config.angle);
  const double far = near + config.separation / std::tan(config.angle);
  if (!(near >= algo::kPsdNearest && far <= algo::kPsdFarthest)) {
    return "height, angle and separation put the floor outside the sensor's 0.1 to 0.8 m";
  }
  return std::nullopt;
}

FloorSensorModel::FloorSensorModel(const FloorSensorConfig& config, std::uint64_t seed)
    : config_(checked(config, "Floor sensors")),
      every_(config.period),
      noise_(seed, kFloorPurpose),
      glitches_(Random(seed, kFloorGlitchPurpose), config.glitches) {}

void FloorSensorModel::sense(const Surroundings& around, algo::Observation& observation) {
  if (!every_.due(around.stamp)) return;
  const VehicleState& vehicle = around.vehicle;
  observation.floor = read(around.stamp, vehicle.pose_W, vehicle.tilt());
}

algo::FloorRanges FloorSensorModel::read(double stamp,
                                         const algo::Pose2& pose_W,
                                         const algo::Tilt& tilt) {
  const auto beams = floor_beams(geometry_of(config_), space_pose(pose_W, tilt));
  algo::FloorRanges out{.stamp = stamp};
  out.far_left = range_along(beams[0]);
  out.far_right = range_along(beams[1]);
  out.near_left = range_along(beams[2]);
  out.near_right = range_along(beams[3]);
  return out;
}

/// The light spot ends at several distances; the sensor sees the middle of its light, which is a
/// mean of voltages.
double FloorSensorModel::range_along(const FloorBeam& beam) {
  double voltage = 0;
  double least_cosine = 1;
  for (int k = 0; k < kFloorRays; ++k) {
    const double off = config_.spot * (static_cast<double>(k) / (kFloorRays - 1) - 0.5);
    const auto hit = solids_.cast(beam.from_W + off * beam.across_W, beam.way_W, kSight);
    if (!hit) continue;
    voltage += algo::psd_voltage(hit->range) / kFloorRays;
    least_cosine = std::min(least_cosine, -hit->normal_W.dot(beam.way_W));
  }
  double spread = config_.noise;
  if (config_.grazing) {
    const double growth = kCosine45 / std::max(least_cosine, kMostGrazing);
    spread *= growth * growth;
  }
  double draw = 0;
  noise_.fill_normal(std::span(&draw, 1));
  double range =
      algo::psd_distance(algo::psd_voltage_of(algo::psd_counts(voltage + spread * draw)));
  glitches_.draw(1, [&](std::size_t) { range += glitches_.random().uniform(-kGlitch, kGlitch); });
  return range;
}

}  // namespace sim
