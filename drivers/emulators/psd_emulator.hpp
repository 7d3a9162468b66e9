// drivers/emulators/psd_emulator.hpp: the adapter of four GP2D12 that look at the floor, seen from
// its line.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "drivers/emulators/device.hpp"
#include "drivers/psd_protocol.hpp"

namespace drivers::psd {

struct EmulatorOptions {
  unsigned baud = 115'200;
  double noise = 0.006;        // [V]
  std::uint32_t first_ms = 0;  // its clock at the start
  std::uint64_t seed = 1;
};

/// Sends a line every kPeriod, unless it is slow, and listens to nothing.
class Emulator final : public emulators::Device {
 public:
  explicit Emulator(const EmulatorOptions& options = {});

  /// [m] along each beam, in the line's order; infinity: nothing.
  void sense(const std::array<double, kSensors>& metres) { metres_ = metres; }
  /// Its power fails at `now` and is back after `boot_time` [s]: its clock starts again.
  void restart(double now, double boot_time);
  /// The count of `sensor` stands still until stick() is called with false.
  void stick(std::size_t sensor, bool stuck) { stuck_[sensor] = stuck; }
  /// A line comes `times` as seldom.
  void slow(double times) { period_ = times * kPeriod; }
  /// Moves its clock by `seconds`.
  void jump(double seconds) { clock_offset_ += seconds; }
  std::uint64_t lines() const { return lines_; }

 protected:
  void on_byte(std::uint8_t /*byte*/, double /*at*/) override {}
  void on_quiet(double /*silence*/) override {}
  void work(double now) override;
  double next_duty() const override { return next_; }

 private:
  std::uint16_t count_of(double metres);

  EmulatorOptions options_;
  std::mt19937_64 random_;
  std::array<double, kSensors> metres_{};
  std::array<bool, kSensors> stuck_{};
  Reading reading_{};
  double next_ = -emulators::kNever;  // [s] of the next line
  double started_ = 0;                // [s] when its clock was first_ms
  double clock_offset_ = 0;           // [s]
  double period_ = kPeriod;           // [s] from one line to the next
  std::uint64_t lines_ = 0;
};

}  // namespace drivers::psd
