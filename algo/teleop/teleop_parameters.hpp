// algo/teleop/teleop_parameters.hpp: the parameters of the laws for driving by hand, and the
// constraints between them.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "algo/teleop/reflected_force.hpp"
#include "algo/teleop/sonar_ring.hpp"
#include "algo/teleop/speed_limit.hpp"
#include "algo/teleop/wall_following.hpp"
#include "algo/teleop/wall_model.hpp"

namespace algo {

// The fastest that full stick asks for, within the robot's own limits.
inline constexpr ParameterInfo kStickSpeed{.name = "teleop.v_max",
                                           .label = "Stick speed",
                                           .unit = "m/s",
                                           .min = 0.05,
                                           .max = 2.0,
                                           .step = 0.05,
                                           .initial = 2.0,
                                           .help = "Speed at full stick, if the robot can."};
inline constexpr ParameterInfo kStickTurnRate{.name = "teleop.w_max",
                                              .label = "Stick turn rate",
                                              .unit = "rad/s",
                                              .min = 0.1,
                                              .max = 6.0,
                                              .step = 0.1,
                                              .initial = 6.0,
                                              .help = "Turn rate at full stick, if the robot can."};

inline constexpr auto kTeleopParameters = std::to_array<const ParameterInfo*>({&kStickSpeed,
                                                                               &kStickTurnRate,
                                                                               &kRingReach,
                                                                               &kStopDistance,
                                                                               &kSparsenessFactor,
                                                                               &kLeastSparseness,
                                                                               &kSlowingGain,
                                                                               &kWallSector,
                                                                               &kWallDistance,
                                                                               &kWallLaw,
                                                                               &kForwardForce,
                                                                               &kForceRamp});

/// Why these values do not go together for a robot of `radius` [m, of the hull's circle about R],
/// as a sentence. D_n counts from the centre, so a D_min within the hull would let the robot drive
/// until it touches (equations.md G).
std::optional<std::string> teleop_refusal(const Parameters& parameters, double radius);

}  // namespace algo
