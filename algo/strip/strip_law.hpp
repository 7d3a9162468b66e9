// algo/strip/strip_law.hpp: the parameters of the elastic strips, the constraints between them, and
// the driving law of the three-point strip.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "algo/driving.hpp"
#include "algo/parameters.hpp"

namespace algo {

inline constexpr ParameterInfo kContractionGain{
    .name = "strip.k_c",
    .label = "Contraction K_c",
    .max = 1.0,
    .step = 0.05,
    .initial = 0.8,
    .help =
        "How strongly the strip pulls a via point onto the straight line. A strip of three "
        "points moves by it only where its via point is kept, which needs it below 1.",
    .alias = "k_c"};
inline constexpr ParameterInfo kRepulsionGain{
    .name = "strip.k_r",
    .label = "Repulsion K_r",
    .min = 0.05,
    .max = 1.0,
    .step = 0.05,
    .initial = 0.6,
    .help = "How strongly obstacles push the strip away. Larger keeps more distance.",
    .alias = "k_r"};
inline constexpr ParameterInfo kStripStep{
    .name = "strip.step",
    .label = "Strip step S",
    .unit = "m",
    .min = 0.05,
    .max = 0.6,
    .step = 0.01,
    .initial = 0.2,
    .help =
        "How far ahead the strip's end is set towards the goal. Must stay below K_r times the "
        "safety distance, or the goal's pull can win over an obstacle's push.",
    .alias = "strip_step"};

inline constexpr ParameterInfo kViaBuffer{
    .name = "strip.via_buffer",
    .label = "Drive by the via buffer",
    .max = 2,
    .step = 1,
    .initial = 0,
    .help =
        "The sibling thesis' sequencing: the robot drives to the next of stored via points, and a "
        "new one is taken 0.5 m from the last reached. 1: in x or y, 2: in x and y, as printed. "
        "It collides: for comparison only. 0: to the pass point of each tick."};

inline constexpr ParameterInfo kDamping{
    .name = "strip.damping",
    .label = "Damping",
    .unit = "s",
    .max = 1,
    .step = 0.05,
    .initial = 0,
    .help =
        "Ours: the elastic force follows the published one with this time constant, which damps "
        "the swinging from side to side. It also sees an obstacle that much later. 0: as "
        "published."};

/// The parameters of the three-point strips. K_c has no effect on one that does not keep its via
/// point (equations.md D).
inline constexpr auto kStripParameters = std::to_array<const ParameterInfo*>({&kRepulsionGain,
                                                                              &kSafetyDistance,
                                                                              &kStripStep,
                                                                              &kViaBuffer,
                                                                              &kDamping,
                                                                              &kMaxSpeed,
                                                                              &kMaxTurnRate,
                                                                              &kHeadingGain,
                                                                              &kGoalReach});
inline constexpr auto kKeptViaParameters = std::to_array<const ParameterInfo*>({&kRepulsionGain,
                                                                                &kContractionGain,
                                                                                &kSafetyDistance,
                                                                                &kStripStep,
                                                                                &kViaBuffer,
                                                                                &kDamping,
                                                                                &kMaxSpeed,
                                                                                &kMaxTurnRate,
                                                                                &kHeadingGain,
                                                                                &kGoalReach});

/// Why these values do not go together, as a sentence: with S >= K_r d_safe the strip can be pushed
/// into an obstacle. Head-on it balances at a body clearance of d_safe - S / K_r (equations.md D,
/// consequence 2).
std::optional<std::string> strip_refusal(const Parameters& parameters);

/// The twist towards `pass_W`: with e = pass - p, along e at v = min(v_max, |e| v_max / S); zero if
/// e = 0 (equations.md D).
Twist2 drive_to(const Pose2& pose_W, const Vec2& pass_W, const Parameters& parameters);

}  // namespace algo
