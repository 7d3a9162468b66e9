// algo/arm_spec.hpp: the arm of a robot as plain numbers: where it is mounted, how long its links
// are and how far and fast its joints turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "algo/types.hpp"
#include "algo/units.hpp"

namespace algo {

inline constexpr std::size_t kArmJoints = 7;
static_assert(kArmJoints <= kMostJoints);

/// One value for each of the arm's joints, the shoulder's first.
using JointValues = std::array<double, kArmJoints>;

constexpr JointValues in_radians(JointValues degrees) {
  for (double& value : degrees) value *= units::kRadiansPerDegree;
  return degrees;
}

/// An arm of three joints at the shoulder, one at the elbow and three at the wrist, on a mast on
/// the base. The defaults are the Silvermate's, which are chosen: the source's table is damaged.
struct ArmSpec {
  Vec3 shoulder_R{0, -0.22, 0.95};  // [m]
  double heading = 0;               // [rad] of the shoulder's frame in R, about z
  double upper_arm = 0.30;          // [m] shoulder to elbow
  double elbow_offset = 0;          // [m]
  double forearm = 0.28;            // [m] elbow to wrist
  double hand = 0.15;               // [m] wrist to hand
  double link_radius = 0.04;        // [m]
  double mast_radius = 0.05;        // [m] of the post from the base to the shoulder
  double base_height = 0.46;        // [m] of the hull's top
  JointValues limits = in_radians({170, 120, 170, 140, 170, 110, 175});  // [rad] to either side
  JointValues rates = in_radians({90, 90, 90, 90, 120, 120, 120});       // [rad/s]
  JointValues rest{-0.38, 1.57, -0.40, -1.39, 0, 0, 0};  // [rad] folded over the base, for driving
  double scan_height = 0.30;  // [m] above the floor of the plane that the robot's scanners see
  bool operator==(const ArmSpec&) const = default;
};

/// Straight parts that something may touch, in the order of the chain.
enum class BodyLink : std::uint8_t { Base, Mast, UpperArm, Forearm, Hand };
inline constexpr std::size_t kBodyLinks = 5;
/// "upper_arm", as REST and CSV spell it.
std::string_view name(BodyLink link);
/// "upper arm", for a sentence.
std::string_view words(BodyLink link);

}  // namespace algo
