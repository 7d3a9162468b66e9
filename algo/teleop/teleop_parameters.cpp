// algo/teleop/teleop_parameters.cpp: distances that must come one after the other.
#include "algo/teleop/teleop_parameters.hpp"

namespace algo {

std::optional<std::string> teleop_refusal(const Parameters& parameters, double radius) {
  const double stop = parameters[kStopDistance];
  const double reach = parameters[kRingReach];
  if (!(stop > radius)) {
    return "teleop.d_min " + with_unit(stop, "m") + " must be above the hull's radius of " +
           with_unit(radius, "m") + ", or the robot could drive into an obstacle";
  }
  if (!(reach > stop)) {
    return "teleop.d_max " + with_unit(reach, "m") + " must be above teleop.d_min " +
           with_unit(stop, "m") + ", or the robot could never drive ahead";
  }
  return std::nullopt;
}

}  // namespace algo
