// algo/pipeline/rear_watch.hpp: tells whether any sensor looks at the area behind the robot.
#pragma once

#include <array>
#include <cstddef>

#include "algo/observation.hpp"

namespace algo {

/// The quarter turn behind the robot, in sectors. A sector counts as watched for kMemory after a
/// scanner, an infrared beam or a sonar measured in it, even if it found nothing. A scanner that is
/// silent or dazzled watches nothing.
class RearWatch {
 public:
  static constexpr double kMemory = 1.0;  // [s] longer than one round of a sonar ring

  RearWatch() { reset(); }
  void reset();
  /// Takes this tick's readings.
  void take(const Observation& observation);
  /// True if every sector is watched at `now` [s, run clock].
  bool looks(double now) const;

 private:
  static constexpr std::size_t kSectors = 6;
  void look(double from, double to, double stamp);

  std::array<double, kSectors> looked_at_{};  // [s] run clock
};

}  // namespace algo
