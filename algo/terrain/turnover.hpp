// algo/terrain/turnover.hpp: how fast a robot may turn, brake and accelerate on a slope before it
// turns over.
//
// Source: Park et al. 2005, Eq. 20-26; equations.md G. The paper has no rule along the track: that
// one is ours. Eq. 20 prints f_Z, which does not exist: it is the normal force N.
#pragma once

#include <limits>

#include "algo/ground_sense.hpp"
#include "algo/terrain/attitude.hpp"

namespace algo {

constexpr double kGravity = 9.80665;  // [m/s2]

/// The direction of gravity in R, as shares of g, with the paper's signs: k_X = -sin(pitch),
/// k_Y = sin(roll) cos(pitch), k_Z = cos(roll) cos(pitch).
struct GravityShares {
  double x = 0, y = 0, z = 1;
};
GravityShares gravity_shares(const Attitude& attitude);

/// Bounds of the acceleration v w [m/s2] towards the left within which both tracks carry load.
struct SidewaysRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
/// Eq. 25: -g (k_Y + k_Z W/(2h)) <= v w <= -g (k_Y - k_Z W/(2h)), before any truncation.
SidewaysRange sideways_range(const Attitude& attitude, const Stance& stance);

/// Eq. 26: the change of speed after `distance` [m] with the acceleration `a` [m/s2]:
/// -v + sqrt(max(0, v^2 + 2 a D)). `v` [m/s].
double speed_change(double v, double a, double distance);

/// Bounds of the turn rate [rad/s].
struct TurnRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool must_turn = false;  // standing still would turn it over: neither bound allows w = 0
};
/// Eq. 26: `sideways` cut to +-v_max w_max, divided by the speed `v` [m/s] (the paper's v + Dv) and
/// clamped to +-w_max, which the cut product exceeds at small speeds. +-w_max where |v| < 1e-6; the
/// bounds swap where v is negative.
TurnRange turn_range(const SidewaysRange& sideways, double v, double v_max, double w_max);

/// [m/s2] Ours: how much the robot may accelerate or brake, both ways, before it tips over its
/// front or its back: share g (k_Z L_tr/(2h) - |k_X|). Negative past its standing limit.
double along_limit(const Attitude& attitude, const Stance& stance, double share);

/// [rad] Angle that is left until the robot tips over while it stands: the smaller one of that to
/// its side, atan(W/(2h)) - atan(|k_Y|/k_Z), and that along its tracks. Negative past the limit.
double standing_margin(const Attitude& attitude, const Stance& stance);

}  // namespace algo
