// algo/full_strip/full_strip_parameters.hpp: the parameters of the full strip alone.
#pragma once

#include <string_view>

#include "algo/parameters.hpp"

namespace algo {

/// The measure of a robot with a limit of its jerk: 1 where a command exceeds it, to keep clear of
/// something or to give way.
inline constexpr std::string_view kHardCommand = "strip.hard";

inline constexpr ParameterInfo kNearestGoal{
    .name = "full_strip.nearest_goal",
    .label = "Goal taken: go near",
    .unit = "",
    .min = 0.0,
    .max = 1.0,
    .step = 1.0,
    .initial = 1.0,
    .help =
        "What the full strip does when something stands on its goal: 1 drives to the nearest "
        "free place, 0 stops where it finds out.",
    .alias = "nearest_goal"};
inline constexpr ParameterInfo kBreakRoom{
    .name = "full_strip.break_room",
    .label = "Break room",
    .unit = "m",
    .min = 0.0,
    .max = 0.05,
    .step = 0.005,
    .initial = 0.02,
    .help = "How much narrower the strip may become than what was planned before it breaks."};
inline constexpr ParameterInfo kPlanPeriod{
    .name = "full_strip.plan_period",
    .label = "Planning period",
    .unit = "s",
    .min = 0.1,
    .max = 5.0,
    .step = 0.05,
    .initial = 0.25,
    .help = "Time between two searches for a way over the map."};

}  // namespace algo
