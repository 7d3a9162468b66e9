// algo/health.hpp: the state of a robot of real devices, as shown to people.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "algo/observation.hpp"

namespace algo {

struct DeviceReport {
  std::string name{};  // "front laser", "base"
  std::string port{};
  bool well = false;
  std::string sentence{};              // its state, or the fault and the remedy
  std::vector<std::string> remarks{};  // settings that differ from those requested
  std::vector<std::pair<std::string, std::string>> facts{};  // "rate", "500000 bit/s"
};

/// Histogram of how late a loop woke for its ticks. One thread writes it; other threads get copies.
class LatenessHistogram {
 public:
  static constexpr std::array<double, 8> kLimits{
      1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 5e-2};  // [s] upper ends; one open bucket more
  static constexpr std::size_t kBuckets = kLimits.size() + 1;

  void add(double late) {  // [s]
    const auto* const limit = std::ranges::upper_bound(kLimits, late);
    ++counts_[static_cast<std::size_t>(limit - kLimits.begin())];
    worst_ = std::max(worst_, late);
    ++ticks_;
  }
  const std::array<std::uint64_t, kBuckets>& counts() const { return counts_; }
  double worst() const { return worst_; }  // [s]
  std::uint64_t ticks() const { return ticks_; }

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
  double worst_ = 0;
  std::uint64_t ticks_ = 0;
};

/// The health of a robot of real devices.
struct HealthReport {
  bool armed = false;
  Halt halt = Halt::None;
  std::string trouble{};  // why the wheels are held still, a sentence; empty when they may turn
  std::vector<DeviceReport> devices{};
  std::vector<std::string> warnings{};  // weak points of the configuration or the system
  bool real_time = false;               // the loop runs at its real-time priority
  bool memory_locked = false;
  LatenessHistogram lateness{};
  std::uint64_t missed_periods = 0;  // periods lost because a tick came too late
};

}  // namespace algo
