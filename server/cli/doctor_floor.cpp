// server/cli/doctor_floor.cpp: readings, faults, and what a level floor should give.
#include "server/cli/doctor_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "algo/terrain/ground_class.hpp"
#include "drivers/psd_device.hpp"

namespace server::doctor {

void look_at_distances(const algo::DeviceReport& report,
                       const algo::FloorRanges& seen,
                       const algo::FloorSensors& sensors,
                       Notes& notes) {
  constexpr double kAgree = 0.02;  // [m] by which a usual sensor may be off
  const algo::FlatRanges flat = algo::flat_ranges(sensors);
  const std::array<double, drivers::psd::kSensors> metres{
      seen.far_left, seen.far_right, seen.near_left, seen.near_right};
  const std::array<double, drivers::psd::kSensors> level{flat.far, flat.far, flat.near, flat.near};
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const std::string name = drivers::psd::kSensorNames[i];
    const auto fact = std::ranges::find(report.facts, name, [](const auto& f) { return f.first; });
    if (fact == report.facts.end()) continue;
    if (std::isnan(metres[i])) {
      notes.note(fmt::format("The {} sensor sees {}.", name, fact->second),
                 "On a flat floor each sensor sees it; nearer than 0.1 m it sees nothing.");
    } else if (std::abs(metres[i] - level[i]) > kAgree) {
      notes.note(
          fmt::format("The {} sensor sees something at {}; a level floor would be at {:.3f} m.",
                      name,
                      fact->second,
                      level[i]),
          "If the robot stands on a level floor: measure the sensor's table, and look at "
          "x, height and angle_deg of [psd].");
    } else {
      notes.well(fmt::format("The {} sensor sees the floor at {}.", name, fact->second));
    }
  }
}

bool look_at_floor_sensors(const drivers::RobotFile& file,
                           const DoctorOptions& options,
                           const Found& found) {
  const drivers::FloorEntry& entry = *file.floor;
  Notes notes(drivers::psd::kDeviceName, found);
  if (!look_at_port(entry.port, entry.setup.baud, notes)) return false;
  drivers::psd::PsdDevice device(entry.port, entry.setup);
  const double until = drivers::steady_now() + options.patience;
  while (!device.state().running && drivers::steady_now() < until) pause(options);
  if (!device.state().running) {
    notes.bad(device.report().sentence,
              "docs/hardware.md describes the line that the adapter must send.");
    return false;
  }
  const std::uint64_t before = device.readings();
  const double begun = drivers::steady_now();
  // At least as long as a stuck count takes to be found.
  const double measuring = std::max(
      options.measuring, 1.5 * drivers::psd::StuckWatch::kReadings * drivers::psd::kPeriod);
  algo::FloorRanges seen;
  while (drivers::steady_now() < begun + measuring) {
    pause(options);
    device.take(seen);
  }
  const double rate =
      static_cast<double>(device.readings() - before) / (drivers::steady_now() - begun);
  const double wanted = 1 / drivers::psd::kPeriod;
  const algo::DeviceReport report = device.report();
  if (rate < 0.9 * wanted) {
    notes.bad(fmt::format("{:.1f} readings a second arrive instead of {:.1f}.", rate, wanted),
              "Look at the adapter, its cable and the shield.");
  } else {
    notes.well(fmt::format("{:.1f} readings a second arrive.", rate));
  }
  if (report.well) {
    look_at_distances(report, seen, *file.spec.floor, notes);
  } else {
    notes.bad(report.sentence, "Clear its cause, then look again.");
  }
  return notes.all_well();
}

}  // namespace server::doctor
