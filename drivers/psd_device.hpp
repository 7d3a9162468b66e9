// drivers/psd_device.hpp: the floor sensors' adapter behind a serial line: its machine and thread.
#pragma once

#include <string>

#include "drivers/line_thread.hpp"
#include "drivers/psd_machine.hpp"

namespace drivers::psd {

/// Its name in reports.
constexpr const char* kDeviceName = "floor sensors";

class PsdDevice final : public FloorSense {
 public:
  PsdDevice(const std::string& port, const PsdSetup& setup);

  bool take(algo::FloorRanges& ranges) override;
  FloorState state() override;
  algo::DeviceReport report() override;
  /// Lines that came whole since the start.
  std::uint64_t readings();

 private:
  PsdMachine machine_;
  LineThread line_;  // declared last: ends first
};

}  // namespace drivers::psd
