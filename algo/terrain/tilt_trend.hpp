// algo/terrain/tilt_trend.hpp: how fast the robot's roll and pitch change.
#pragma once

#include <array>
#include <cstddef>

#include "algo/terrain/attitude.hpp"

namespace algo {

/// A line through the readings of the last quarter second, by least squares: one difference of two
/// readings is mostly noise. Allocates nothing.
class TiltTrend {
 public:
  void reset() { count_ = 0; }
  /// Adds the attitude measured at `stamp` [s].
  void take(double stamp, const Attitude& attitude);
  /// The attitude `lead` [s] after the newest reading if the trend goes on. The newest reading's
  /// while there are too few.
  Attitude after(double lead) const;

 private:
  static constexpr std::size_t kReadings = 16;
  struct Reading {
    double stamp = 0;  // [s]
    Attitude attitude{};
  };
  std::array<Reading, kReadings> readings_{};  // a ring
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace algo
