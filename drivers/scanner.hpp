// drivers/scanner.hpp: a laser scanner that measures by itself, as a robot sees it.
#pragma once

#include <algorithm>

#include "algo/health.hpp"
#include "algo/laser_scan.hpp"

namespace drivers {

struct ScannerState {
  bool running = false;   // found and set up
  double last_scan = 0;   // [s] steady clock, when the newest usable scan arrived; 0: none yet
  double period = 0;      // [s] between two scans
  bool bad_line = false;  // more telegrams come damaged than whole
  bool faulty = false;    // it says itself that its values must not be relied on
  bool blinded = false;   // most beams of the newest scan measured nothing
};

/// [s] For how long a robot may drive on after the last scan of a scanner with `period` [s].
constexpr double blind_time(double period) {
  constexpr double kAtMost = 0.3;  // [s]
  constexpr double kPeriods = 2;   // of a slow scanner, which needs one for each of its scans
  return std::max(kAtMost, kPeriods * period);
}

class Scanner {
 public:
  Scanner() = default;
  virtual ~Scanner() = default;
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;

  /// Exchanges `scan` for the newest one that has not been taken; false when there is none. Its
  /// stamp is of the steady clock; `scan` keeps its mount. Never waits for the device.
  virtual bool take(algo::LaserScan& scan) = 0;
  virtual ScannerState state() = 0;
  virtual algo::DeviceReport report() = 0;
};

}  // namespace drivers
