// algo/terrain/ground_verdict.hpp: whether the robot can drive over what it found.
//
// Source: Masuda et al. 2008, Fig. 8: the value against the robot's limit less a margin. The
// paper's robot stops at steps of 13 mm and measures to 2 mm, so it climbs what it finds at most 11
// mm high.
#pragma once

#include <array>
#include <string>

#include "algo/ground_sense.hpp"
#include "algo/parameters.hpp"
#include "algo/terrain/ground_trials.hpp"

namespace algo {

inline constexpr ParameterInfo kStepMargin{
    .name = "ground.step_margin",
    .label = "Margin of steps",
    .unit = "m",
    .max = 0.02,
    .step = 0.001,
    .initial = 0.002,
    .help = "A step may be at most this much lower than the robot's limit."};
inline constexpr ParameterInfo kUphillMargin{
    .name = "ground.uphill_margin",
    .label = "Margin uphill",
    .unit = "rad",
    .max = 0.2,
    .step = 0.001,
    .initial = 0.0436,
    .help = "A slope up must be gentler than the robot's limit by this: 2.5 degrees."};
inline constexpr ParameterInfo kDownhillMargin{
    .name = "ground.downhill_margin",
    .label = "Margin downhill",
    .unit = "rad",
    .max = 0.2,
    .step = 0.001,
    .initial = 0.0698,
    .help = "A slope down must be gentler than the robot's limit by this: 4 degrees."};
inline constexpr ParameterInfo kTrenchRatio{
    .name = "ground.trench_ratio",
    .label = "Share of the trench limit",
    .max = 1,
    .step = 0.05,
    .initial = 0.9,
    .help = "A trench may be as wide as this share of the widest that the robot can cross."};

/// True if a robot with `limits` can drive over it. `pitch` [rad], nose down positive, is the
/// robot's own: a slope counts against the level. Unknown ground is never passable.
bool passable(const GroundFinding& finding,
              const ClimbLimits& limits,
              double pitch,
              const Parameters& parameters);

/// Which of two findings matters more: the one that is not flat; of two, the higher, steeper or
/// wider one.
const GroundFinding& worse(const GroundFinding& a, const GroundFinding& b);

/// Appends "step up 1.3 cm".
void say_ground(const GroundFinding& finding, std::string& text);

}  // namespace algo
