// algo/driving.hpp: code that all controllers share: steering in a direction, the final turn, and
// the check for finite inputs.
#pragma once

#include <array>

#include "algo/controller.hpp"

namespace algo {

// ---- Parameters that most controllers read ----

inline constexpr ParameterInfo kMaxSpeed{.name = "drive.v_max",
                                         .label = "Top speed",
                                         .unit = "m/s",
                                         .min = 0.01,
                                         .max = 2.0,
                                         .step = 0.01,
                                         .initial = 0.3,
                                         .help = "Fastest the robot may drive.",
                                         .alias = "v_max"};
inline constexpr ParameterInfo kMaxTurnRate{.name = "drive.w_max",
                                            .label = "Top turn rate",
                                            .unit = "rad/s",
                                            .min = 0.1,
                                            .max = 3.0,
                                            .step = 0.1,
                                            .initial = 1.0,
                                            .help = "Fastest the robot may turn.",
                                            .alias = "w_max"};
inline constexpr ParameterInfo kHeadingGain{.name = "drive.heading_gain",
                                            .label = "Heading gain",
                                            .unit = "1/s",
                                            .min = 0.5,
                                            .max = 5.0,
                                            .step = 0.1,
                                            .initial = 2.0,
                                            .help = "Turn rate per radian of heading error.",
                                            .alias = "heading_gain"};
inline constexpr ParameterInfo kGoalReach{
    .name = "drive.goal_reach",
    .label = "Goal reach",
    .unit = "m",
    .min = 0.02,
    .max = 1.0,
    .step = 0.01,
    .initial = 0.1,
    .help = "The goal counts as reached within this distance.",
    .alias = "goal_reach"};
inline constexpr ParameterInfo kSafetyDistance{
    .name = "drive.safety_distance",
    .label = "Safety distance",
    .unit = "m",
    .min = 0.1,
    .max = 3.0,
    .step = 0.05,
    .initial = 1.0,
    .help = "Obstacles nearer to the robot's centre than this plus its radius push linearly.",
    .alias = "safety_distance"};
/// The parameters for steering towards a point and turning at the goal.
inline constexpr auto kDrivingParameters =
    std::to_array<const ParameterInfo*>({&kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});

// ---- The law ----

/// The twist along `bearing_W` [rad]: Dth = wrap(bearing - th), w = clamp(gain Dth, +-w_max),
/// v = speed max(0, cos Dth).
Twist2 drive_along(const Pose2& pose_W,
                   double bearing_W,
                   double speed,
                   const Parameters& parameters);

/// [rad] Tolerance of a wanted heading, for turning as for arriving.
inline constexpr double kHeadingReach = 0.05;

/// Turns in place to the goal's heading. Zero twist if there is none or it is reached.
Twist2 turn_to(const Pose2& pose_W, const SetGoal& goal, const Parameters& parameters);

/// True if every number that a controller may read is finite. Ranges are checked for Ok beams only,
/// since those of other beams are not distances.
bool all_finite(const ControlInput& in, const Parameters& parameters);

}  // namespace algo
