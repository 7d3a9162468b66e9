// algo/ground_sense.hpp: the geometry of the sensors that look at the ground ahead, and the limits
// of a robot on ground that is not level.
#pragma once

#include <cmath>

namespace algo {

/// A laser that draws a line across the ground ahead, and the camera that sees it (Park et al.
/// 2005, Eq. 11, 12). The camera is the origin of frame C, which looks ahead and down by `pitch`.
/// The laser is `baseline` above it, along C's z axis, from which its plane leans by `angle`:
/// th_lp.
struct LineCamera {
  double x = 0;         // [m] of the camera in R; not in the paper
  double height = 0;    // [m] of the camera above the floor
  double pitch = 0;     // [rad] down positive
  double baseline = 0;  // [m]
  double angle = 0;     // [rad] from C's z axis, in (0, pi/2)
  double focal = 0;     // [pixels]
  int columns = 0;      // [pixels] of the image; u is positive to the left,
  int rows = 0;         // [pixels] v towards the laser; both count from the middle
  bool operator==(const LineCamera&) const = default;
};

/// Four distance sensors that look down at the floor ahead (Masuda et al. 2008): a far and a near
/// one on each side, with parallel beams.
struct FloorSensors {
  double x = 0;             // [m] in R, of the near sensors
  double height = 0;        // [m] above the floor, of the near sensors
  double half_spacing = 0;  // [m] from R's x axis to either side
  double angle = 0;         // [rad] of the beams, down from R's x axis: the paper's alpha
  double separation = 0;    // [m] between the two beams of a side, at right angles: the paper's L
  bool operator==(const FloorSensors&) const = default;
};

/// What the robot stands on (Park et al. 2005, Eq. 20-25).
struct Stance {
  double mass_height = 0;  // [m] of the centre of mass above the ground: the paper's h
  double width = 0;        // [m] between the middles of the tracks: the paper's W
  double length = 0;       // [m] of the ground contact: L_tr
  bool operator==(const Stance&) const = default;
};

/// The highest or steepest ground that the robot masters, measured in simulation.
struct ClimbLimits {
  double step_up = 0;     // [m]
  double step_down = 0;   // [m] positive
  double trench = 0;      // [m] wide
  double slope_up = 0;    // [rad]
  double slope_down = 0;  // [rad] positive
  bool operator==(const ClimbLimits&) const = default;
};

/// True if a robot with this roll and pitch [rad] leans by more than 60 degrees: it lies on its
/// side or its back.
inline bool is_overturned(double roll, double pitch) {
  return std::cos(roll) * std::cos(pitch) < 0.5;
}

}  // namespace algo
