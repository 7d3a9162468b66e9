// drivers/emulators/psd_emulator.cpp: voltages, counts and lines of the floor sensors' adapter.
#include "drivers/emulators/psd_emulator.hpp"

#include <cmath>
#include <limits>

namespace drivers::psd {

Emulator::Emulator(const EmulatorOptions& options)
    : Device(options.baud, options.seed), options_(options), random_(options.seed) {
  metres_.fill(std::numeric_limits<double>::infinity());
}

void Emulator::restart(double now, double boot_time) {
  line().cut(now);
  next_ = started_ = now + boot_time;
  options_.first_ms = 0;
  clock_offset_ = 0;
}

std::uint16_t Emulator::count_of(double metres) {
  // Not std::normal_distribution, whose draws differ between libraries.
  double noise = -6;
  for (int i = 0; i < 12; ++i) noise += static_cast<double>(random_() >> 11U) * 0x1p-53;
  return algo::psd_counts(algo::psd_voltage(metres) + options_.noise * noise);
}

void Emulator::work(double now) {
  if (next_ == -emulators::kNever) next_ = started_ = now;
  for (; next_ <= now; next_ += period_) {
    const double clock = next_ - started_ + clock_offset_;
    reading_.clock_ms = options_.first_ms + static_cast<std::uint32_t>(std::llround(1000 * clock));
    for (std::size_t i = 0; i < kSensors; ++i) {
      const std::uint16_t count = count_of(metres_[i]);
      if (!stuck_[i]) reading_.counts[i] = count;
    }
    line().say(line_of(reading_).view(), next_);
    ++lines_;
  }
}

}  // namespace drivers::psd
