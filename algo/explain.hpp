// algo/explain.hpp: explains the ticks that no controller explains (holds, arrivals, waiting), and
// provides the phrases that controllers share.
#pragma once

#include <string>

#include "algo/controller.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// Explains what the robot does in the tick `t` and why. `controller` writes the words while it
/// drives to a goal. Overwrites `words` but keeps its buffers.
void explain(const Telemetry& t, const Controller& controller, Explanation& words);
/// Explains why real hardware holds its wheels still; needs no tick.
Explanation explain(Halt halt);

/// Appends the numbers formatted by the printf `pattern`.
[[gnu::format(printf, 2, 3)]] void say(std::string& text, const char* pattern, ...);
/// Appends "The nearest return is 1.25 m from the robot's centre."
void say_surroundings(const Telemetry& t, std::string& text);
/// Writes "Driving to the goal", for a controller with nothing to add.
void say_driving(const Telemetry& t, Explanation& words);

/// [m] Distance from the robot to its goal; 0 without one.
double to_goal(const Telemetry& t);
/// [degrees] Angle between the directions to the pass point and to the goal; 0 without either.
double off_goal(const Telemetry& t);

}  // namespace algo
