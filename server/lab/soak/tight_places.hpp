// server/lab/soak/tight_places.hpp: places in which a guard must not hold a robot: doors and walls.
#pragma once

#include "sim/scenario.hpp"

namespace server::soak {

inline constexpr double kDoor = 0.9;    // [m] wide
inline constexpr int kDoorPoses = 10;   // before the door, up to 2 cm off its middle
inline constexpr int kWallPoses = 100;  // at a wall to which it drove, up to 69 degrees aslant

struct TightPlaces {
  int doors_passed = 0;  // of kDoorPoses, with full stick ahead in mode guarded
  int walls_left = 0;    // of kWallPoses, by backing, turning and driving ahead
};

/// `scenario` gives robot, physics and controller.
TightPlaces drive_tight_places(const sim::Scenario& scenario);

}  // namespace server::soak
