// algo/terrain/tilt_trend.cpp: the line through the newest readings.
#include "algo/terrain/tilt_trend.hpp"

#include <algorithm>

namespace algo {
namespace {

constexpr double kTrendWindow = 0.25;  // [s]
constexpr std::size_t kFewestReadings = 4;

}  // namespace

void TiltTrend::take(double stamp, const Attitude& attitude) {
  readings_[next_] = {stamp, attitude};
  next_ = (next_ + 1) % kReadings;
  count_ = std::min(count_ + 1, kReadings);
}

Attitude TiltTrend::after(double lead) const {
  if (count_ == 0) return {};
  const auto at = [this](std::size_t age) -> const Reading& {
    return readings_[(next_ + kReadings - 1 - age) % kReadings];
  };
  const Reading& newest = at(0);
  std::size_t n = 0;
  double times = 0;  // sums, from the newest reading on
  double rolls = 0;
  double pitches = 0;
  for (; n < count_ && newest.stamp - at(n).stamp <= kTrendWindow; ++n) {
    times += at(n).stamp - newest.stamp;
    rolls += at(n).attitude.roll;
    pitches += at(n).attitude.pitch;
  }
  if (n < kFewestReadings) return newest.attitude;
  const auto readings = static_cast<double>(n);
  const double middle = times / readings;
  double spread = 0;
  double roll_rate = 0;
  double pitch_rate = 0;
  for (std::size_t age = 0; age < n; ++age) {
    const double t = at(age).stamp - newest.stamp - middle;
    spread += t * t;
    roll_rate += t * at(age).attitude.roll;
    pitch_rate += t * at(age).attitude.pitch;
  }
  if (!(spread > 0)) return newest.attitude;
  const double ahead = (lead - middle) / spread;
  return {rolls / readings + ahead * roll_rate, pitches / readings + ahead * pitch_rate};
}

}  // namespace algo
