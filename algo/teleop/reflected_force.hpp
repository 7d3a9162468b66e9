// algo/teleop/reflected_force.hpp: the force that pushes the operator's hand back to what the robot
// may do.
//
// Source: Park et al. 2005, section 2.3, Eq. 28, 29; equations.md G. The force follows from the
// stick's position alone. Positions and forces keep the paper's unit, which is that of
// force-feedback sticks: 10000 is full deflection or full force. Axes: Y forward, X to the left;
// both positive for a positive v and omega.
#pragma once

#include <cstdint>
#include <span>

#include "algo/parameters.hpp"

namespace algo {

constexpr double kFullStick = 10000;  // full deflection q, and full force F

inline constexpr ParameterInfo kForceRamp{
    .name = "teleop.force_ramp",
    .label = "Force ramp",
    .max = 1.0,
    .step = 0.05,
    .initial = 0.2,
    .help =
        "Share of the stick's travel over which the force rises to its full strength. 0: at once, "
        "as published, which makes a hand tremble."};

/// The band of one axis in which no force acts, in stick units.
struct ForceBand {
  double offset = 0;               // q_offset in [-10000, 10000]
  double half_width = kFullStick;  // W_DB in [0, 10000]
};

/// Full forces beyond the band, >= 0 and at most 10000.
struct ForceLevels {
  double above = kFullStick;  // F_P: pushes back with -F_P
  double below = kFullStick;  // F_N: pushes back with +F_N
};
/// About Y nothing pushes the operator to drive faster.
inline constexpr ForceLevels kForwardLevels{.above = kFullStick, .below = 0};

/// Eq. 28, 29: q_offset = 10000 (w_lb + w_ub) / 2 / w_max, W_DB = 10000 (w_ub - w_lb) / 2 / w_max,
/// clamped to the ranges of ForceBand. Bounds and `w_max` [rad/s]. If one is not finite, or w_max
/// not above 0, no force acts: ForceBand{}.
ForceBand band_between(double w_lb, double w_ub, double w_max);

/// Which speed the force about Y pushes back to. The paper contradicts itself.
enum class ForwardForce : std::uint8_t {
  FullStick,   // ours: Eq. 4's speed at full stick. Section 3's force, with a limit that does not
               // move with the hand.
  Sparseness,  // section 2.3: the limit v_sprs
  Executed,    // section 3, "whenever v_cmd was greater than v": Eq. 4's speed for the hand's own
               // command. As Eq. 4 scales any command, it pushes until the stick is at rest.
};

// The order of the values is that of ForwardForce's enumerators.
inline constexpr ParameterInfo kForwardForce{
    .name = "teleop.forward_force",
    .label = "Forward force",
    .max = 2,
    .step = 1,
    .initial = 0,
    .help =
        "The speed above which the stick is pushed back: 0 that of full stick, 1 v_sprs (Park "
        "et al., section 2.3), 2 that of the stick itself (section 3)."};
ForwardForce forward_force(const Parameters& parameters);

/// [m/s] The speed for `reading`; the arguments are those of slowed_speed().
double forward_limit(double v_cmd,
                     double v_sprs,
                     std::span<const double> distances,
                     double v_max,
                     const Parameters& parameters,
                     ForwardForce reading = ForwardForce::FullStick);

/// The band of axis Y: q_offset = 10000 v / v_max for the limit v [m/s], W_DB = 100. ForceBand{} if
/// an argument is not finite or v_max is not above 0. Use with kForwardLevels.
ForceBand forward_band(double v_limit, double v_max);

/// The band of axis X while the robot follows a wall: q_offset = 10000 w_d / w_max, W_DB = 100.
/// Otherwise no force acts: ForceBand{}. `w_d`, `w_max` [rad/s]; not finite as above.
ForceBand wall_band(double w_d, double w_max);

/// The force for a stick at `q`: -F_P above the band, +F_N below it, 0 inside and on its limits.
/// @param ramp  share of the stick's travel over which the force rises (ours); 0: bang-bang, as
///              printed
/// Zero if q is not finite.
double reflected_force(double q, const ForceBand& band, const ForceLevels& levels, double ramp);

}  // namespace algo
