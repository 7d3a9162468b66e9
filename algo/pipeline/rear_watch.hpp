// algo/pipeline/rear_watch.hpp: whether any sensor looks at where a robot backs to.
#pragma once

#include <array>
#include <cstddef>

#include "algo/observation.hpp"

namespace algo {

/// The quarter turn behind the robot, in sectors. A sector is looked at for kMemory after a
/// scanner, an infrared beam or a sonar measured anything in it, be it that nothing is there. A
/// scanner that fell silent, or is dazzled, looks at nothing.
class RearWatch {
 public:
  static constexpr double kMemory = 1.0;  // [s] longer than a ring of sonars needs for a round

  RearWatch() { reset(); }
  void reset();
  /// Takes this tick's readings.
  void take(const Observation& observation);
  /// Whether every sector was looked at, at `now` [s, run clock].
  bool looks(double now) const;

 private:
  static constexpr std::size_t kSectors = 6;
  void look(double from, double to, double stamp);

  std::array<double, kSectors> looked_at_{};  // [s] run clock
};

}  // namespace algo
