// algo/teleop/speed_limit.hpp: slower in a crowded place, and slower before an obstacle.
//
// Source: Park et al. 2005, Eq. 1-4; equations.md G. The paper samples every 100 ms. The sparseness
// changes by one factor a sample, so sampling faster would change how fast the robot slows down.
#pragma once

#include <span>

#include "algo/parameters.hpp"
#include "algo/teleop/sonar_ring.hpp"

namespace algo {

/// [s] The paper's T_s: between two samples of its laws.
constexpr double kTeleopPeriod = 0.1;

// The paper gives none of these values.
inline constexpr ParameterInfo kSparsenessFactor{
    .name = "teleop.gamma",
    .label = "Sparseness factor",
    .min = 0.5,
    .max = 0.99,
    .step = 0.01,
    .initial = 0.9,
    .help = "The speed limit shrinks by this factor a sample while something is near."};
inline constexpr ParameterInfo kLeastSparseness{
    .name = "teleop.sprs_min",
    .label = "Least sparseness",
    .min = 0.01,
    .max = 1.0,
    .step = 0.01,
    .initial = 0.1,
    .help = "The speed limit never shrinks below this share of the top speed."};
inline constexpr ParameterInfo kSlowingGain{
    .name = "teleop.eta",
    .label = "Slowing gain",
    .unit = "1/m",
    .min = 0.5,
    .max = 10.0,
    .step = 0.1,
    .initial = 3.0,
    .help = "How late the robot slows down before an obstacle. Larger is later."};

/// One sample of Eq. 1-3.
struct SparsenessStep {
  double range = 0;  // [m] A = sprs D_max: nearer obstacles make the place crowded
  double speed = 0;  // [m/s] v_sprs = sprs v_max, the limit of this sample
  double next = 1;   // sprs for the next sample, in [sprs_min, 1]
};

/// The sample that follows from `sparseness`, the state sprs; it starts at 1. sprs grows to
/// sprs / gamma if all D_n >= A, and shrinks to gamma sprs otherwise. The printed "D_n >= A" has no
/// quantifier; "all" is equations.md's. Without readings it shrinks.
/// @param distances  N readings D_n [m]; NaN counts as an obstacle at D_min
/// @param v_max      [m/s], >= 0
SparsenessStep sparseness_step(double sparseness,
                               std::span<const double> distances,
                               double v_max,
                               const Parameters& parameters);

/// Eq. 4: v = min(v_cmd, v_sprs) (1 - exp(-eta (max(min_n D_n, D_min) - D_min))) [m/s]. The printed
/// "max(min(D_1, A, D_8), D_min)" means an ellipsis by "A". For v_cmd <= 0 it is max(v_cmd,
/// -v_max), unscaled: the ring looks ahead. Never above v_max. Zero if v_cmd is not finite; without
/// readings, or if v_sprs is not above 0, zero ahead.
/// @param v_cmd      [m/s] the operator's speed
/// @param v_sprs     [m/s] SparsenessStep::speed
/// @param distances  as above
/// @param v_max      [m/s], >= 0
double slowed_speed(double v_cmd,
                    double v_sprs,
                    std::span<const double> distances,
                    double v_max,
                    const Parameters& parameters);

}  // namespace algo
