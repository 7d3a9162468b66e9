// sim/arm_model.cpp: the checks of an arm's numbers.
#include "sim/arm_model.hpp"

#include <cmath>
#include <numeric>

namespace sim {

double ArmModel::mass() const {
  return std::accumulate(masses.begin(), masses.end(), payload);
}

std::optional<std::string> defect(const ArmModel& arm) {
  for (std::size_t k = 0; k < algo::kArmJoints; ++k) {
    if (std::abs(arm.rest[k]) > arm.limits[k]) {
      return "rest_deg: joint " + std::to_string(k + 1) + " is beyond its limit";
    }
    if (arm.start && !(std::abs((*arm.start)[k]) <= arm.limits[k])) {
      return "joints: joint " + std::to_string(k + 1) + " is beyond its limit";
    }
  }
  return std::nullopt;
}

algo::MobileArm body_of(const ArmModel& arm, double radius, double height) {
  algo::MobileArm body = algo::mobile_arm(arm, radius);
  body.base_height = height;
  return body;
}

}  // namespace sim
