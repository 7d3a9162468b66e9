// server/cli/doctor_floor.hpp: checks the sensors that look at the floor ahead.
#pragma once

#include "algo/ground_sense.hpp"
#include "algo/health.hpp"
#include "algo/observation.hpp"
#include "server/cli/doctor_notes.hpp"

namespace server::doctor {

/// Compares each distance with that of a level floor. `report` is the device's, with the voltages.
void look_at_distances(const algo::DeviceReport& report,
                       const algo::FloorRanges& seen,
                       const algo::FloorSensors& sensors,
                       Notes& notes);

/// `file` has floor sensors. True when no finding is bad.
bool look_at_floor_sensors(const drivers::RobotFile& file,
                           const DoctorOptions& options,
                           const Found& found);

}  // namespace server::doctor
