// algo/pipeline/sensing.hpp: the front scan as a controller reads it: filtered, with sonar and
// infrared returns entered.
#pragma once

#include "algo/filter/filter.hpp"
#include "algo/sensor_merge.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// Given the recorded observations of a run in order, it reproduces the scans of the run's
/// controller beam for beam.
class Sensing {
 public:
  explicit Sensing(FilterKind kind) : kind_(kind) {}

  void reset() { merge_.reset(); }

  /// Takes the observation of every tick, since echoes are remembered. Writes a new front scan,
  /// prepared for the controller, to `scan` and returns the scan as measured. Returns null and
  /// leaves `scan` unchanged if there is no new one.
  const LaserScan* take(const Observation& observation,
                        const Parameters& parameters,
                        LaserScan& scan);

  /// Recent sonar and infrared returns.
  const SensorMerge& merge() const { return merge_; }

 private:
  FilterKind kind_{};
  ScanFilter filter_{};
  SensorMerge merge_{};
};

}  // namespace algo
