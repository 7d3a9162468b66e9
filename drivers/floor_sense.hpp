// drivers/floor_sense.hpp: the interface between a robot and the sensors that look at the floor
// ahead.
#pragma once

#include "algo/health.hpp"
#include "algo/observation.hpp"

namespace drivers {

struct FloorState {
  bool running = false;     // readings have come, and the line is open
  double last_reading = 0;  // [s] steady clock, arrival of the newest; 0: none yet
  double period = 0;        // [s] between two readings
  bool faulty = false;      // the readings are not to be trusted; the report says why
};

class FloorSense {
 public:
  FloorSense() = default;
  virtual ~FloorSense() = default;
  FloorSense(const FloorSense&) = delete;
  FloorSense& operator=(const FloorSense&) = delete;

  /// Gives the newest distances; false when they were taken already. The stamp is of the steady
  /// clock. Never waits for the device.
  virtual bool take(algo::FloorRanges& ranges) = 0;
  virtual FloorState state() = 0;
  virtual algo::DeviceReport report() = 0;
};

}  // namespace drivers
