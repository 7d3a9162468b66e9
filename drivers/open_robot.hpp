// drivers/open_robot.hpp: the devices of a robot's file, opened.
#pragma once

#include <memory>

#include "drivers/base.hpp"
#include "drivers/robot_file.hpp"
#include "drivers/serial_robot.hpp"

namespace drivers {

/// The base of a file, running; it keeps waiting for a missing device.
std::unique_ptr<Base> open_base(const BaseEntry& entry);
/// Opens every device of `file`; each keeps waiting while it is missing.
std::shared_ptr<SerialRobot> open_robot(const RobotFile& file);

}  // namespace drivers
