#include "algo/arm/arm_geometry.hpp"

#include <array>
#include <numbers>

namespace algo {

std::optional<std::string> objection(const ArmGeometry& geometry) {
  struct Length {
    const char* name;
    double value;
  };
  for (const auto& [name, value] : {Length{"upper_arm", geometry.upper_arm},
                                    Length{"forearm", geometry.forearm},
                                    Length{"hand", geometry.hand}}) {
    if (!(std::isfinite(value) && value > 0)) {
      return "The arm's " + std::string(name) + " must be a length above 0 m.";
    }
  }
  for (const auto& [name, value] : {Length{"shoulder_offset", geometry.shoulder_offset},
                                    Length{"elbow_offset", geometry.elbow_offset}}) {
    if (!std::isfinite(value)) return "The arm's " + std::string(name) + " must be a number.";
  }
  for (Eigen::Index i = 0; i < geometry.limits.size(); ++i) {
    if (!(geometry.limits[i] > 0 && geometry.limits[i] <= std::numbers::pi)) {
      return "The limit of the arm's joint " + std::to_string(i + 1) +
             " must lie above 0 and at most at 180 degrees.";
    }
  }
  return std::nullopt;
}

double limit_margin(const ArmGeometry& geometry, const ArmJoints& q) {
  return (geometry.limits - q.cwiseAbs()).minCoeff();
}

}  // namespace algo
