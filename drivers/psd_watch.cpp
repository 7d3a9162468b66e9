// drivers/psd_watch.cpp: counts changes within a window, and compares two clocks.
#include "drivers/psd_watch.hpp"

#include <algorithm>
#include <cmath>

namespace drivers::psd {

void StuckWatch::see(const Reading& reading) {
  std::uint8_t changed = 0;
  for (std::size_t i = 0; i < kSensors; ++i) {
    if (reading.counts[i] != before_.counts[i]) changed |= static_cast<std::uint8_t>(1U << i);
  }
  before_ = reading;
  if (seen_++ == 0) return;  // nothing to compare with
  std::uint8_t& slot = changed_[seen_ % kReadings];
  for (std::size_t i = 0; i < kSensors; ++i) {
    changes_[i] += (changed >> i) & 1U;
    changes_[i] -= (slot >> i) & 1U;
  }
  slot = changed;
}

unsigned StuckWatch::liveliest() const {
  return *std::ranges::max_element(changes_);
}

std::optional<std::size_t> StuckWatch::stuck() const {
  if (seen_ <= kReadings || liveliest() < kReadings / 2) return std::nullopt;
  const auto* const still = std::ranges::find(changes_, 0U);
  if (still == changes_.end()) return std::nullopt;
  return static_cast<std::size_t>(still - changes_.begin());
}

void ClockWatch::see(double now, std::uint32_t clock_ms) {
  // As signed: a clock that goes back is no wrap.
  const double step = static_cast<std::int32_t>(clock_ms - clock_ms_) / 1000.0;
  const double off = step - (now - last_);
  if (known_ && (step <= 0 || std::abs(off) > kTolerance)) {
    jump_ = off;
    jumped_ = now;
    ++jumps_;
  }
  known_ = true;
  last_ = now;
  clock_ms_ = clock_ms;
}

std::optional<double> ClockWatch::jump(double now) const {
  if (jumps_ == 0 || now - jumped_ > kDistrust) return std::nullopt;
  return jump_;
}

}  // namespace drivers::psd
