// algo/terrain/attitude.hpp: roll and pitch of the robot, and the level frame.
#pragma once

#include <cmath>

#include "algo/types.hpp"

namespace algo {

/// The signs of the whole program: see Tilt and Inclinometer.
struct Attitude {
  double roll = 0;   // [rad] left side up positive
  double pitch = 0;  // [rad] nose down positive
  bool operator==(const Attitude&) const = default;
};

/// `p` from the robot's frame in the level frame: the same origin and heading, without roll and
/// pitch. Turned by the roll about x first, then by the pitch about y.
inline Vec3 to_level(const Attitude& attitude, const Vec3& p) {
  const double y = std::cos(attitude.roll) * p.y() - std::sin(attitude.roll) * p.z();
  const double z = std::sin(attitude.roll) * p.y() + std::cos(attitude.roll) * p.z();
  return {std::cos(attitude.pitch) * p.x() + std::sin(attitude.pitch) * z,
          y,
          -std::sin(attitude.pitch) * p.x() + std::cos(attitude.pitch) * z};
}

/// The inverse of to_level().
inline Vec3 from_level(const Attitude& attitude, const Vec3& p) {
  const double x = std::cos(attitude.pitch) * p.x() - std::sin(attitude.pitch) * p.z();
  const double z = std::sin(attitude.pitch) * p.x() + std::cos(attitude.pitch) * p.z();
  return {x,
          std::cos(attitude.roll) * p.y() + std::sin(attitude.roll) * z,
          -std::sin(attitude.roll) * p.y() + std::cos(attitude.roll) * z};
}

}  // namespace algo
