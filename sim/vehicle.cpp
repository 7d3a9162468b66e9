// sim/vehicle.cpp: arithmetic shared by all vehicles.
#include "sim/vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

double finite(double value) {
  return std::isfinite(value) ? value : 0;
}

}  // namespace

Substeps::Substeps(double period, double rate) {
  constexpr double kRounding = 1e-9;  // 25 ms are six steps, not seven
  count = static_cast<std::size_t>(std::max(1.0, std::ceil(rate * period - kRounding)));
  length = period / static_cast<double>(count);
}

algo::Twist2 within_limits(const algo::Twist2& command, const RobotModel& vehicle) {
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
                    const RobotModel& vehicle,
                    double dt) {
  return {algo::towards(now.v, wanted.v, vehicle.max_acceleration * dt),
          algo::towards(now.omega, wanted.omega, vehicle.max_angular_acceleration * dt)};
}

}  // namespace sim
