// server/run/laser_json.cpp: one reader and one writer.
#include "server/run/laser_json.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "algo/units.hpp"
#include "server/run/pose_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kMaxBeams = 4096;

/// Whether `degrees` is an angular resolution of the LMS200.
bool lms200_mode(double degrees) {
  const auto is = [&](double mode) { return std::abs(degrees - mode) < 1e-9; };
  return is(0.25) || is(0.5) || is(1.0);
}

}  // namespace

sim::LaserConfig laser_from_json(const JsonReader& in) {
  in.only({"resolution_deg",
           "field_of_view_deg",
           "beams",
           "ideal",
           "mount",
           "height",
           "rolling",
           "unit",
           "range_max",
           "bias",
           "noise",
           "noise_shape",
           "mixed_pixels",
           "reflectivity",
           "dropout",
           "salt",
           "pepper"});
  const double resolution = in.number_or("resolution_deg", 0.5);
  sim::LaserConfig laser;
  try {
    laser = in.flag_or("ideal", false) ? sim::LaserConfig::ideal(resolution)
                                       : sim::LaserConfig::with_resolution(resolution);
  } catch (const std::invalid_argument& e) {
    in.fail("resolution_deg", e.what());
  }
  if (in.has("field_of_view_deg") || in.has("beams")) {
    if (in.has("resolution_deg")) in.fail("resolution_deg", "cannot stand beside beams");
    laser = sim::LaserConfig::flat(
        in.number("field_of_view_deg", {1.0, 360.0}) * algo::units::kRadiansPerDegree,
        static_cast<std::uint32_t>(in.whole("beams", kMaxBeams)),
        30.0);
  }
  if (in.has("mount")) laser.mount_R = pose_from_json(in.object("mount"), 0);
  laser.height = in.number_or("height", laser.height, {0.0, 5.0});
  laser.rolling = in.flag_or("rolling", laser.rolling);
  const std::string unit = in.text_or("unit", "mm");
  if (unit != "mm" && unit != "cm") in.fail("unit", "must be \"mm\" or \"cm\"");
  if (unit == "cm") {
    laser.unit = sim::LaserUnit::Centimetre;
    laser.range_max = 81.91;
  }
  laser.range_max = in.number_or("range_max", laser.range_max, {0.1, 81.91});
  laser.bias = in.number_or("bias", laser.bias, {0.0, 1.0});
  laser.noise = in.number_or("noise", laser.noise, {0.0, 1.0});
  const std::string shape = in.text_or("noise_shape", "gaussian");
  if (shape != "gaussian" && shape != "uniform") {
    in.fail("noise_shape", "must be \"gaussian\" or \"uniform\"");
  }
  laser.noise_shape = shape == "uniform" ? sim::NoiseShape::Uniform : sim::NoiseShape::Gaussian;
  laser.mixed_pixels = in.flag_or("mixed_pixels", laser.mixed_pixels);
  laser.reflectivity = in.flag_or("reflectivity", laser.reflectivity);
  laser.dropout = in.number_or("dropout", laser.dropout, {0.0, 1.0});
  laser.salt = in.number_or("salt", laser.salt, {0.0, 1.0});
  laser.pepper = in.number_or("pepper", laser.pepper, {0.0, 1.0});
  return laser;
}

json to_json(const sim::LaserConfig& laser) {
  json out = {
      {"mount", to_json(laser.mount_R)},
      {"height", laser.height},
      {"rolling", laser.rolling},
      {"unit", laser.unit == sim::LaserUnit::Millimetre ? "mm" : "cm"},
      {"range_max", laser.range_max},
      {"bias", laser.bias},
      {"noise", laser.noise},
      {"noise_shape", laser.noise_shape == sim::NoiseShape::Uniform ? "uniform" : "gaussian"},
      {"mixed_pixels", laser.mixed_pixels},
      {"reflectivity", laser.reflectivity},
      {"dropout", laser.dropout},
      {"salt", laser.salt},
      {"pepper", laser.pepper}};
  const double degrees = laser.angle_increment / algo::units::kRadiansPerDegree;
  if (lms200_mode(degrees)) {
    out["resolution_deg"] = std::round(degrees * 100) / 100;
  } else {
    out["field_of_view_deg"] = laser.field_of_view / algo::units::kRadiansPerDegree;
    out["beams"] = std::lround(laser.field_of_view / laser.angle_increment) + 1;
  }
  return out;
}

}  // namespace server
