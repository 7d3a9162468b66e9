// algo/teleop/sonar_ring.hpp: the eight readings in front that the laws for driving by hand read,
// and their stand-in made of a laser scan.
//
// A reading D_n [m] is the distance from the robot's centre, not from the sensor, to the nearest
// obstacle in the cone of sonar n (Park et al. 2005, section 2.1).
#pragma once

#include <array>
#include <span>

#include "algo/laser_scan.hpp"
#include "algo/parameters.hpp"
#include "algo/ring_axes.hpp"

namespace algo {

// The paper gives neither value. D_min must exceed the distance of the hull's farthest corner from
// the centre (teleop_refusal()).
inline constexpr ParameterInfo kRingReach{
    .name = "teleop.d_max",
    .label = "Reach D_max",
    .unit = "m",
    .min = 1.0,
    .max = 8.0,
    .step = 0.1,
    .initial = 3.0,
    .help = "Farther obstacles do not count. A sonar without an echo reads this."};
inline constexpr ParameterInfo kStopDistance{
    .name = "teleop.d_min",
    .label = "Stop distance D_min",
    .unit = "m",
    .min = 0.1,
    .max = 2.0,
    .step = 0.05,
    .initial = 0.5,
    .help = "No speed ahead is left when an obstacle is this near to the robot's centre."};

/// Readings D_n [m], from right to left.
using RingReadings = std::array<double, kRingSonars>;

/// The distance that the laws take for a reading `d` [m]: within [0, D_max]; D_min for NaN, since a
/// sensor that fails must not open the way (equations.md G).
double heard(double d, const Parameters& parameters);

/// The smallest of `distances` as heard(); D_min if there are none.
double nearest_heard(std::span<const double> distances, const Parameters& parameters);

/// The readings with the bearing [rad, in R] of each nearest return: a sonar knows only its axis, a
/// laser the true one.
struct Ring {
  RingReadings distances{};
  RingReadings bearings = ring_bearings();
};

/// The ring out of a laser scan, for a robot without sonars (ours).
///
/// Reading n is the distance from the robot's centre to the nearest Ok return whose bearing from
/// the centre lies within kRingHalfCone of the ring's axis n, and D_max if there is none or it is
/// farther. The cones overlap, so no return between the axes is lost. NaN if most beams in the cone
/// are Invalid or not finite, and no return is there: nothing is known about it. A cone outside the
/// scanner's field of view reads D_max, like a sonar that the robot lacks.
Ring virtual_sonars(const LaserScan& scan, const Parameters& parameters);

}  // namespace algo
