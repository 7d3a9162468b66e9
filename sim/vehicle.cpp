// sim/vehicle.cpp: the table of robots and the arithmetic all vehicles share.
#include "sim/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

// physics.md 3. For a box hull the circle is the one about its corners.
constexpr double kRightAngle = 90 * std::numbers::pi / 180;
const std::array<VehicleParameters, 4> kVehicles{{
    {.name = "silvermate",
     .radius = 0.35,
     .round = true,
     .hull_length = 0.70,
     .hull_width = 0.70,
     .hull_low = 0.06,
     .hull_high = 0.46,
     .mass = 60,
     .half_track = 0.25,
     .wheel_radius = 0.10,
     .support_x = {0, 0},
     .supports = 1,
     .casters = {{{0.27, 0, 0.04, 0.001}, {-0.27, 0, 0.04, 0.001}}},
     .caster_count = 2,
     .mass_height = 0.25,
     .max_v = 0.5,
     .max_omega = 1.0,
     .max_acceleration = 0.5,
     .max_angular_acceleration = 4},
    {.name = "masuda",
     .radius = std::hypot(0.14, 0.11),
     .hull_length = 0.28,
     .hull_width = 0.22,
     .hull_low = 0.03,
     .hull_high = 0.13,
     .mass = 5,
     .half_track = 0.12,
     .wheel_radius = 0.04,
     .support_x = {-0.09, 0},
     .supports = 1,
     .casters = {{{0.10, 0.08, 0.02, 0}, {0.10, -0.08, 0.02, 0}}},
     .caster_count = 2,
     .mass_height = 0.06,
     .max_v = 0.3,
     .max_omega = 1.5,
     .max_acceleration = 0.5,
     .max_angular_acceleration = 6},
    {.name = "jackal",
     // With its wheels, which reach beyond the chassis box of 0.42 x 0.31 m.
     .radius = std::hypot(0.254, 0.215),
     .hull_length = 0.508,
     .hull_width = 0.43,
     .hull_low = 0.065,
     .hull_high = 0.25,
     .mass = 17,
     .half_track = 0.188,
     .wheel_radius = 0.098,
     .support_x = {0.131, -0.131},
     .supports = 2,
     .mass_height = 0.10,
     .max_v = 2.0,
     .max_omega = 2.5,
     .max_acceleration = 3.0,
     .max_angular_acceleration = 8},
    {.name = "robhaz",
     .radius = std::hypot(0.33, 0.20),
     .hull_length = 0.66,
     .hull_width = 0.40,
     .hull_low = 0.10,
     .hull_high = 0.40,
     .mass = 40,
     .half_track = 0.24,
     .wheel_radius = 0.09,
     .support_x = {0.30, -0.30},
     .supports = 2,
     .mass_height = 0.25,
     .max_v = 0.86,
     .max_omega = kRightAngle,
     .max_acceleration = 1,
     .max_angular_acceleration = 6},
}};

double finite(double value) {
  return std::isfinite(value) ? value : 0;
}

double towards(double now, double wanted, double most) {
  return now + std::clamp(wanted - now, -most, most);
}

}  // namespace

std::span<const VehicleParameters> vehicle_table() {
  return kVehicles;
}

const VehicleParameters* find_vehicle(std::string_view name) {
  for (const VehicleParameters& vehicle : kVehicles) {
    if (vehicle.name == name) return &vehicle;
  }
  return nullptr;
}

const VehicleParameters& vehicle_named(std::string_view name) {
  if (const VehicleParameters* found = find_vehicle(name)) return *found;
  std::string known;
  for (const VehicleParameters& vehicle : vehicle_table()) {
    known += (known.empty() ? "" : ", ") + std::string(vehicle.name);
  }
  throw std::invalid_argument("There is no robot named \"" + std::string(name) + "\"; there are " +
                              known + ".");
}

Hull hull_of(const VehicleParameters& vehicle) {
  if (vehicle.round) return {.radius = vehicle.radius};
  return {vehicle.radius, vehicle.hull_length / 2, vehicle.hull_width / 2};
}

Substeps::Substeps(double period) {
  constexpr double kRate = 240;       // [Hz]
  constexpr double kRounding = 1e-9;  // 25 ms are six steps, not seven
  count = static_cast<std::size_t>(std::max(1.0, std::ceil(kRate * period - kRounding)));
  length = period / static_cast<double>(count);
}

algo::Twist2 within_limits(const algo::Twist2& command, const VehicleParameters& vehicle) {
  const algo::Twist2 wanted{finite(command.v), finite(command.omega)};
  double scale = 1;
  if (std::abs(wanted.v) > vehicle.max_v) scale = vehicle.max_v / std::abs(wanted.v);
  if (std::abs(wanted.omega) > vehicle.max_omega) {
    scale = std::min(scale, vehicle.max_omega / std::abs(wanted.omega));
  }
  return {scale * wanted.v, scale * wanted.omega};
}

algo::Twist2 ramped(const algo::Twist2& now,
                    const algo::Twist2& wanted,
                    const VehicleParameters& vehicle,
                    double dt) {
  return {towards(now.v, wanted.v, vehicle.max_acceleration * dt),
          towards(now.omega, wanted.omega, vehicle.max_angular_acceleration * dt)};
}

}  // namespace sim
