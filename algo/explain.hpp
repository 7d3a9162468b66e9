// algo/explain.hpp: the words of a tick that are not a controller's own: holds, arrivals, waiting;
// and the pieces that controllers make theirs of.
#pragma once

#include <string>

#include "algo/controller.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// What the robot does in the tick `t` and why; `controller` has the word while it drives to a
/// goal. Overwrites `words`, whose buffers stay.
void explain(const Telemetry& t, const Controller& controller, Explanation& words);
/// The same for what keeps real hardware still, which is known without a tick too.
Explanation explain(Halt halt);

/// Appends what `pattern` of printf makes of the numbers.
[[gnu::format(printf, 2, 3)]] void say(std::string& text, const char* pattern, ...);
/// "The nearest return is 1.25 m from the robot's centre."
void say_surroundings(const Telemetry& t, std::string& text);
/// "Driving to the goal": of any controller about which there is nothing more to say.
void say_driving(const Telemetry& t, Explanation& words);

/// [m] From the robot to its goal; 0 without one.
double to_goal(const Telemetry& t);
/// [degrees] between the way to the pass point and the way to the goal; 0 without either.
double off_goal(const Telemetry& t);

}  // namespace algo
