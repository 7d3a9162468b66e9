// drivers/robot_file_ground.hpp: the tables of a robot's file that concern the ground.
#pragma once

#include "drivers/robot_file.hpp"
#include "drivers/robot_section.hpp"

namespace drivers {

/// Reads [psd], [climbs] and [stance], and what a process beside the robot publishes, as far as the
/// file has them. Needs the track of `robot`. Throws RobotFileError.
void read_ground(Section& top, RobotFile& robot);

}  // namespace drivers
