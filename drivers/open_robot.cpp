// drivers/open_robot.cpp: makes the devices that a robot's file names, each with its port.
#include "drivers/open_robot.hpp"

#include <utility>
#include <variant>
#include <vector>

#include "drivers/lms200_device.hpp"
#include "drivers/psd_device.hpp"
#include "drivers/serial_base.hpp"

namespace drivers {

std::unique_ptr<Base> open_base(const BaseEntry& entry) {
  if (const auto* analog = std::get_if<AnalogEntry>(&entry.setup)) {
    const auto open = [port = entry.port, card = analog->card] {
      return open_comedi_card(port, card);
    };
    return std::make_unique<AnalogBase>(entry.port, analog->base, open);
  }
  std::unique_ptr<BaseMachine> machine;
  if (const auto* pioneer = std::get_if<p2os::PioneerSetup>(&entry.setup)) {
    machine = std::make_unique<p2os::PioneerMachine>(*pioneer);
  } else {
    machine =
        std::make_unique<roboteq::RoboteqMachine>(std::get<roboteq::RoboteqSetup>(entry.setup));
  }
  return std::make_unique<SerialBase>(entry.port, std::move(machine));
}

std::shared_ptr<SerialRobot> open_robot(const RobotFile& file) {
  std::vector<std::unique_ptr<Scanner>> scanners;
  scanners.reserve(file.lasers.size());
  for (const LaserEntry& laser : file.lasers) {
    scanners.push_back(std::make_unique<lms200::Lms200Device>(laser.name, laser.port, laser.setup));
  }
  std::unique_ptr<FloorSense> floor;
  if (file.floor) floor = std::make_unique<psd::PsdDevice>(file.floor->port, file.floor->setup);
  return std::make_shared<SerialRobot>(file,
                                       std::move(scanners),
                                       open_base(file.base),
                                       std::make_unique<SteadyClock>(),
                                       std::move(floor));
}

}  // namespace drivers
