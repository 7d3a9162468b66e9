// algo/terrain/ground_reader.cpp: medians, and differences from a level floor.
#include "algo/terrain/ground_reader.hpp"

#include <cmath>
#include <limits>

namespace algo {

GroundReader::GroundReader(const FloorSensors& sensors, std::size_t window, MedianRank rank)
    : flat_(flat_ranges(sensors)),
      window_(window),
      streams_{
          Stream(window, rank), Stream(window, rank), Stream(window, rank), Stream(window, rank)} {
  reset();
}

void GroundReader::reset() {
  for (Stream& stream : streams_) {
    stream.median.reset();
    stream.missing = 0;
    stream.last = std::numeric_limits<double>::quiet_NaN();
  }
  taken_ = 0;
  wait(left_);
  wait(right_);
}

/// Nothing is known yet: something may be ahead.
void GroundReader::wait(GroundLook& side) const {
  side = {.far = flat_.far, .near = flat_.near, .kind = GroundClass::Pending, .far_off = true};
}

double GroundReader::Stream::take(double range) {
  if (const auto middle = median.push(range)) {
    missing = 0;
    return last = *middle;
  }
  // Of a window with few gaps the median still tells; beyond them it is old.
  if (++missing > most_missing) last = std::numeric_limits<double>::quiet_NaN();
  return last;
}

void GroundReader::take(const FloorRanges& ranges) {
  const double far_left = streams_[0].take(ranges.far_left);
  const double far_right = streams_[1].take(ranges.far_right);
  const double near_left = streams_[2].take(ranges.near_left);
  const double near_right = streams_[3].take(ranges.near_right);
  if (taken_ < window_) ++taken_;
  if (taken_ < window_) return;
  look(far_left, near_left, left_);
  look(far_right, near_right, right_);
}

void GroundReader::look(double far, double near, GroundLook& side) const {
  constexpr GroundThresholds kLimits;
  side.far = far;
  side.near = near;
  side.kind = classify_ranges(far, near, flat_);
  side.far_off = !(std::abs(far - flat_.far) <= kLimits.far);  // true for NaN
  side.near_off = !(std::abs(near - flat_.near) <= kLimits.near);
}

}  // namespace algo
