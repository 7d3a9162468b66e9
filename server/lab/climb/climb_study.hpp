// server/lab/climb/climb_study.hpp: the ground that a robot masters, found by driving over it.
#pragma once

#include "algo/ground_sense.hpp"
#include "sim/robot_model.hpp"

namespace server::climb {

/// A kind of ground that a robot meets head-on.
enum class Ground { StepUp, StepDown, Trench, SlopeUp, SlopeDown };

/// True if `robot` gets over ground of `size` ([m], or [rad] for a slope), slowly and at full
/// speed, without its hull touching anything.
bool masters(const sim::RobotModel& robot, Ground ground, double size);

/// The largest sizes up to which the robot masters all, in steps of 1 mm and 1 degree.
algo::ClimbLimits measure(const sim::RobotModel& robot);

}  // namespace server::climb
