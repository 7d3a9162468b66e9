// algo/pipeline/driver_link.hpp: what a slow link between a driver and the robot takes from the
// stick.
//
// Ours: the paper's operator sat on a link of a known, short delay. A driver sees the robot as it
// was, and the answer of the driver's hand comes, one round trip later at the soonest.
#pragma once

#include <optional>
#include <string>

#include "algo/request.hpp"
#include "algo/types.hpp"

namespace algo {

inline constexpr double kMostRoundTrip = 0.5;  // [s] over a slower link only Stop counts
inline constexpr double kReaction = 0.1;       // [s] of a driver who waits for it, and of the page

/// [s] From a motion of the robot to the driver's answer; 0 for a driver beside the robot.
inline double driver_delay(const Joystick& stick) {
  return stick.round_trip > 0 ? stick.round_trip + kReaction : 0;
}

/// Why this stick is not obeyed over its link, as a sentence. A centred one always is.
std::optional<std::string> link_refusal(const Joystick& stick);

/// `wanted` for a driver who has no guard: slower in both by the same share, so that the robot
/// covers at most 0.3 m and 0.5 rad before an answer can come.
Twist2 capped_for_link(const Twist2& wanted, const Joystick& stick);

}  // namespace algo
