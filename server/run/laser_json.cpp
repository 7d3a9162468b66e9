// server/run/laser_json.cpp: one reader and one writer.
#include "server/run/laser_json.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/pose_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kFewestBeams = 2;  // one at each end of the field
constexpr std::uint64_t kMostBeams = 4096;

using Laser = sim::LaserConfig;
constexpr Field<Laser> kLaser[] = {
    {"resolution_deg"},
    {"field_of_view_deg"},
    {"beams"},
    {"ideal"},
    {"mount"},
    {"height", &Laser::height, {0, 5}},
    {"rolling", &Laser::rolling},
    {"unit"},
    {"range_max", &Laser::range_max, {0.1, 81.91}},
    {"bias", &Laser::bias, {0, 1}},
    {"noise", &Laser::noise, {0, 1}},
    {"noise_shape"},
    {"mixed_pixels", &Laser::mixed_pixels},
    {"reflectivity", &Laser::reflectivity},
    {"dropout", &Laser::dropout, {0, 1}},
    {"salt", &Laser::salt, {0, 1}},
    {"pepper", &Laser::pepper, {0, 1}},
};

using algo::units::kRadiansPerDegree;

/// The resolution [deg] of the LMS200 that has the beams and the mirror of `laser`.
std::optional<double> lms200_mode(const Laser& laser) {
  for (const double degrees : {0.25, 0.5, 1.0}) {
    const Laser mode = Laser::with_resolution(degrees);
    if (laser.field_of_view == mode.field_of_view &&
        laser.angle_increment == mode.angle_increment && laser.turns == mode.turns) {
      return degrees;
    }
  }
  return std::nullopt;
}

/// The degrees that are read back as exactly `radians`; the shorter number if there are several.
double degrees_of(double radians) {
  const double degrees = radians / kRadiansPerDegree;
  for (const double each : {std::round(degrees * 1e9) / 1e9,
                            degrees,
                            std::nextafter(degrees, 0.0),
                            std::nextafter(degrees, 1e3)}) {
    if (each * kRadiansPerDegree == radians) return each;
  }
  return degrees;
}

}  // namespace

sim::LaserConfig laser_from_json(const JsonReader& in) {
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
    const std::uint64_t beams = in.whole("beams", kMostBeams);
    if (beams < kFewestBeams) {
      in.fail("beams", fmt::format("is {}, must be at least {}", beams, kFewestBeams));
    }
    laser = sim::LaserConfig::flat(in.number("field_of_view_deg", {1.0, 360.0}) * kRadiansPerDegree,
                                   static_cast<std::uint32_t>(beams),
                                   30.0);
  }
  if (in.has("mount")) laser.mount_R = mount_from_json(in.object("mount"));
  const std::string unit = in.text_or("unit", "mm");
  if (unit != "mm" && unit != "cm") in.fail("unit", "must be \"mm\" or \"cm\"");
  if (unit == "cm") {
    laser.unit = sim::LaserUnit::Centimetre;
    laser.range_max = 81.91;
  }
  read_only_fields(in, kLaser, laser);
  const std::string shape = in.text_or("noise_shape", "gaussian");
  if (shape != "gaussian" && shape != "uniform") {
    in.fail("noise_shape", "must be \"gaussian\" or \"uniform\"");
  }
  laser.noise_shape = shape == "uniform" ? sim::NoiseShape::Uniform : sim::NoiseShape::Gaussian;
  return laser;
}

json to_json(const sim::LaserConfig& laser) {
  json out = written(kLaser, laser);
  out["mount"] = to_json(laser.mount_R);
  out["unit"] = laser.unit == sim::LaserUnit::Millimetre ? "mm" : "cm";
  out["noise_shape"] = laser.noise_shape == sim::NoiseShape::Uniform ? "uniform" : "gaussian";
  if (const auto degrees = lms200_mode(laser)) {
    out["resolution_deg"] = *degrees;
  } else {
    out["field_of_view_deg"] = degrees_of(laser.field_of_view);
    out["beams"] = std::lround(laser.field_of_view / laser.angle_increment) + 1;
  }
  return out;
}

}  // namespace server
