// algo/pipeline/sensing.hpp: the front scan as a controller sees it: filtered, and with what sonar
// and infrared returned entered into it.
#pragma once

#include "algo/filter/filter.hpp"
#include "algo/sensor_merge.hpp"
#include "algo/telemetry.hpp"

namespace algo {

/// Fed the observations of a run one after another, which a record keeps, it gives the scans that
/// the run's controller saw, beam for beam.
class Sensing {
 public:
  explicit Sensing(FilterKind kind) : kind_(kind) {}

  void reset() { merge_.reset(); }

  /// Takes an observation; every tick's, as echoes are remembered. A new front scan goes to `scan`,
  /// as the controller is to see it. Returns it as the scanner measured it; null when none has
  /// come, and `scan` stays as it is.
  const LaserScan* take(const Observation& observation,
                        const Parameters& parameters,
                        LaserScan& scan);

  /// What sonar and infrared returned of late.
  const SensorMerge& merge() const { return merge_; }

 private:
  FilterKind kind_{};
  ScanFilter filter_{};
  SensorMerge merge_{};
};

}  // namespace algo
