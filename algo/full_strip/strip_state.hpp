// algo/full_strip/strip_state.hpp: the states of the full strip.
#pragma once

#include <cstdint>

#include "algo/types.hpp"

namespace algo {

namespace strip_state {

/// The state that the strip's words explain: ControlOutput::state.
// NOLINTBEGIN(readability-identifier-naming): its users read them as constants of the controller.
enum State : std::uint8_t {
  kNone,
  kFollowing,    // along the strip
  kTurning,      // on the spot, towards the strip
  kManeuvering,  // to and fro in a narrow place
  kGivingWay,    // to moving obstacles
  kCornered,     // every motion would meet a moving obstacle
  kEscaping,     // out of a place that is too narrow
  kBackingOff,   // after a long blockage
  kNoWay,        // the map has no path to the goal
  kBlocked,      // no motion is free at present
  kGoalTaken,    // an obstacle stands on the goal; drives no farther
  kPlanning,     // stands until the planner has found a way
};
// NOLINTEND(readability-identifier-naming)

}  // namespace strip_state

/// A command with the state in which it was found.
struct StripCommand {
  Twist2 twist{};
  strip_state::State state = strip_state::kNone;
  bool urgent = false;  // gives way to somebody who moves: the robot's jerk does not matter
};

}  // namespace algo
