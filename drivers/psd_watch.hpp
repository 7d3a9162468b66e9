// drivers/psd_watch.hpp: signs that the floor sensors' adapter sends lines whose content is false.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/psd_protocol.hpp"

namespace drivers::psd {

/// Finds counts that stand still. A GP2D12 has some millivolts of noise and a count is 0.6 mV, so
/// that a live count hardly ever comes twice. All that stand still are a converter that does; one
/// that does while another lives is a broken plug, or a sensor without power.
class StuckWatch {
 public:
  static constexpr std::size_t kReadings = 20;  // 0.8 s

  void see(const Reading& reading);
  void restart() { *this = {}; }
  /// The first sensor whose count stood still for kReadings while that of another changed in half
  /// of them at least.
  std::optional<std::size_t> stuck() const;
  /// No count has changed for kReadings.
  bool frozen() const { return seen_ > kReadings && liveliest() == 0; }

 private:
  unsigned liveliest() const;

  Reading before_{};
  std::size_t seen_ = 0;
  std::array<std::uint8_t, kReadings> changed_{};  // a bit for each sensor, of the newest readings
  std::array<unsigned, kSensors> changes_{};       // among them
};

/// Compares the adapter's clock with that of this computer.
class ClockWatch {
 public:
  /// [s] Above what this computer may hold bytes back: LineThread discards older ones.
  static constexpr double kTolerance = 0.35;
  /// [s] How long after a jump the readings are not trusted.
  static constexpr double kDistrust = 1.0;

  void see(double now, std::uint32_t clock_ms);
  void restart() { *this = {}; }
  /// [s] The adapter's step less this computer's, after a jump within the last kDistrust.
  std::optional<double> jump(double now) const;
  std::uint64_t jumps() const { return jumps_; }

 private:
  bool known_ = false;
  double last_ = 0;  // [s]
  std::uint32_t clock_ms_ = 0;
  double jump_ = 0;    // [s]
  double jumped_ = 0;  // [s] when
  std::uint64_t jumps_ = 0;
};

}  // namespace drivers::psd
