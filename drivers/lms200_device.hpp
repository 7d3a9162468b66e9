// drivers/lms200_device.hpp: an LMS2xx behind a serial line: its machine, and the thread that
// serves it.
#pragma once

#include <functional>
#include <string>

#include "drivers/line_thread.hpp"
#include "drivers/lms200_machine.hpp"
#include "drivers/scanner.hpp"

namespace drivers::lms200 {

class Lms200Device final : public Scanner {
 public:
  Lms200Device(std::string name, const std::string& port, const LaserSetup& setup);

  bool take(algo::LaserScan& scan) override;
  ScannerState state() override;
  algo::DeviceReport report() override;
  /// The full report of the machine.
  LaserReport details();
  /// Waits until the scanner runs: `patience` [s] for finding it, then as long as its set-up takes.
  /// False when it does not run then, or once `interrupted` returns true.
  bool comes_to_run(double patience, const std::function<bool()>& interrupted = {});

 private:
  std::string name_;
  LaserMachine machine_;
  LineThread line_;  // declared last: ends first
};

/// The report for users.
algo::DeviceReport describe(const LaserReport& report, double now);

}  // namespace drivers::lms200
