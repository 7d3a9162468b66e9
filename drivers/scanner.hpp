// drivers/scanner.hpp: the interface between a robot and a free-running laser scanner.
#pragma once

#include <algorithm>

#include "algo/health.hpp"
#include "algo/laser_scan.hpp"

namespace drivers {

struct ScannerState {
  bool running = false;   // found and set up
  double last_scan = 0;   // [s] steady clock, arrival of the newest usable scan; 0: none yet
  double period = 0;      // [s] between two scans
  bool bad_line = false;  // more than half of the telegrams are damaged
  bool faulty = false;    // the scanner reports its values unreliable
  bool blinded = false;   // most beams of the newest scan measured nothing
};

/// [s] How long a robot may drive on after the last scan, for a scanner with `period` [s].
constexpr double blind_time(double period) {
  constexpr double kAtMost = 0.3;  // [s]
  constexpr double kPeriods = 2;   // for a slow scanner, whose next scan takes one period
  return std::max(kAtMost, kPeriods * period);
}

class Scanner {
 public:
  Scanner() = default;
  virtual ~Scanner() = default;
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;

  /// Swaps `scan` with the newest scan; false when it was taken already. The stamp is of the steady
  /// clock; `scan` keeps its mount. Never waits for the device.
  virtual bool take(algo::LaserScan& scan) = 0;
  virtual ScannerState state() = 0;
  virtual algo::DeviceReport report() = 0;
};

}  // namespace drivers
