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

inline constexpr auto kTeleopParameters = std::to_array<const ParameterInfo*>({&kRingReach,
                                                                               &kStopDistance,
                                                                               &kSparsenessFactor,
                                                                               &kLeastSparseness,
                                                                               &kSlowingGain,
                                                                               &kWallSector,
                                                                               &kWallDistance,
                                                                               &kForceRamp});

/// Why these values do not go together for a robot of `radius` [m, of the hull's circle about R],
/// as a sentence. D_n counts from the centre, so a D_min within the hull would let the robot drive
/// until it touches (equations.md G).
std::optional<std::string> teleop_refusal(const Parameters& parameters, double radius);

}  // namespace algo
