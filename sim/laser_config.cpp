// sim/laser_config.cpp: the scanner's angular modes and the check of a configuration.
#include <cmath>
#include <stdexcept>
#include <string>

#include "algo/units.hpp"
#include "sim/laser_model.hpp"
#include "sim/sensor_configs.hpp"

namespace sim {

using namespace algo::units;

LaserConfig LaserConfig::with_resolution(double degrees) {
  LaserConfig config;
  if (degrees != 1 && degrees != 0.5 && degrees != 0.25) {
    throw std::invalid_argument("The scanner's resolution must be 1, 0.5 or 0.25 degree, not " +
                                std::to_string(degrees) + ".");
  }
  config.turns = static_cast<std::uint32_t>(1 / degrees);
  config.field_of_view = config.turns == 4 ? 100_deg : 180_deg;
  config.angle_increment = degrees * kRadiansPerDegree;
  return config;
}

LaserConfig LaserConfig::ideal(double degrees) {
  LaserConfig config = with_resolution(degrees);
  config.rolling = false;
  config.bias = 0;
  config.noise = 0;
  config.mixed_pixels = false;
  config.reflectivity = false;
  config.dropout = 0;
  return config;
}

LaserConfig LaserConfig::flat(double field_of_view, std::uint32_t beams, double range_max) {
  LaserConfig config = ideal(1);
  config.field_of_view = field_of_view;
  config.angle_increment = beams > 1 ? field_of_view / (beams - 1) : field_of_view;
  config.range_max = range_max;
  return config;
}

std::optional<std::string> defect(const LaserConfig& config) {
  const auto finite_from = [](double value, double low) {
    return std::isfinite(value) && value >= low;
  };
  const auto probability = [](double value) { return value >= 0 && value <= 1; };
  if (!finite_from(config.angle_increment, 1e-5)) return "angle_increment must be above 0";
  // The housing of an LMS200 leaves half a turn open, and each of its beams has its own time. Half
  // a degree more allows for rounding in a file.
  const double widest = config.rolling ? 180.5_deg : 360_deg;
  if (!finite_from(config.field_of_view, 0) || config.field_of_view > widest) {
    return config.rolling ? "field_of_view must be 0 to 180 degrees unless rolling is off"
                          : "field_of_view must be 0 to 360 degrees";
  }
  if (config.turns < 1 || config.turns > 64) return "turns must be 1 to 64";
  if (!finite_from(config.mirror_period, 1e-4)) return "mirror_period must be above 0";
  if (!finite_from(config.range_max, 0.001)) return "range_max must be above 0";
  if (!finite_from(config.height, 0)) return "height must be 0 or more";
  if (!finite_from(config.bias, 0)) return "bias must be 0 or more";
  if (!finite_from(config.noise, 0)) return "noise must be 0 or more";
  if (!probability(config.dropout)) return "dropout must be 0 to 1";
  if (!probability(config.salt)) return "salt must be 0 to 1";
  if (!probability(config.pepper)) return "pepper must be 0 to 1";
  if (!finite(config.mount_R)) return "mount must be finite numbers";
  return std::nullopt;
}

}  // namespace sim
