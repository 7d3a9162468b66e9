// algo/teleop/wall_model.hpp: the wall that the readings in front suggest, by votes.
//
// Source: Park et al. 2005, Eq. 5, section 2.1 and Fig. 2; equations.md G.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>

#include "algo/parameters.hpp"
#include "algo/teleop/sonar_ring.hpp"
#include "algo/types.hpp"
#include "algo/units.hpp"

namespace algo {

inline constexpr ParameterInfo kWallSector{
    .name = "teleop.theta_sr",
    .label = "Wall sector",
    .unit = "rad",
    .min = 0.1,
    .max = std::numbers::pi / 2,
    .step = 0.01,
    .initial = 53 * units::kRadiansPerDegree,  // of the paper's course: two sonars on either side
    .help = "Sonars up to this far aside of the nearest one vote for its wall."};

/// The line x cos(theta) + y sin(theta) = rho in R: its foot lies at distance rho and bearing
/// theta. theta < 0: a wall on the right.
struct WallModel {
  double rho = 0;        // [m] >= 0
  double theta = 0;      // [rad] in [-pi, pi)
  int votes = 0;         // of its cell
  std::size_t ties = 0;  // cells with as many votes, itself included
};

/// sign(theta'), with sign(0) = +1 (equations.md G).
inline double side_of(const WallModel& wall) {
  return wall.theta < 0 ? -1.0 : 1.0;
}

/// A point in R and the votes zeta of the sensor that it is from.
struct VotingPoint {
  Vec2 point_R{0, 0};
  int votes = 0;
};

/// Eq. 5: zeta_n = 2 for the smallest distance (of equals, the lowest n), 1 if its axis lies within
/// theta_sr of that sensor's axis, 0 otherwise.
/// @param bearings   N axes theta_n [rad]
/// @param distances  N readings D_n [m], as heard()
/// @param zeta       N votes, written
/// Throws std::invalid_argument when the three differ in number.
void count_votes(std::span<const double> bearings,
                 std::span<const double> distances,
                 const Parameters& parameters,
                 std::span<int> zeta);

/// The modified Hough transform over cells of 5 degrees and 10 cm: theta from -180 to 180 degrees,
/// rho >= 0. Each point gives its votes once to every cell that its curve
/// rho = X cos(theta) + Y sin(theta) crosses. The winner is reported at its cell's centre.
///
/// Sampling the curve at the centres of theta, or rounding rho, does not give Fig. 2 of the paper:
/// 95 cm, -62.5 degrees, 5 votes (equations.md G). Of cells with equal votes wins the one with the
/// smallest sum of zeta_n |X_n cos(theta_c) + Y_n sin(theta_c) - rho_c|, then the smaller rho, then
/// the smaller theta.
///
/// Nothing if no point votes. Points that are not finite, and walls beyond kWallReach, are ignored.
std::optional<WallModel> find_wall(std::span<const VotingPoint> points);

constexpr double kWallReach = 12.8;  // [m] farther than any reading

/// find_wall() for one sample of the ring. A reading without an echo does not vote (ours): its
/// point at D_max would be a wall that nobody saw. With the true bearings of a laser's returns the
/// model does not lean (ours): a sonar puts the near edge of its cone on its axis, so that a wall
/// beside the robot seems to come nearer, by 10.7 degrees between the last two of eight cones.
std::optional<WallModel> wall_of_ring(const Ring& ring, const Parameters& parameters);
/// The same with each point on its sonar's axis, as published.
inline std::optional<WallModel> wall_of_ring(const RingReadings& distances,
                                             const Parameters& parameters) {
  return wall_of_ring(Ring{.distances = distances}, parameters);
}

}  // namespace algo
