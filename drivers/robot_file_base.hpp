// drivers/robot_file_base.hpp: the [base] table of a robot's file.
#pragma once

#include "drivers/robot_file.hpp"
#include "drivers/robot_section.hpp"

namespace drivers {

/// Fills `robot.base` and the track. Needs the hull and limits of `robot`.
/// Throws RobotFileError.
void read_base(Section& in, RobotFile& robot);

}  // namespace drivers
