// server/emulate/mirror.hpp: the scans of an emulated LMS200 in a simulated world.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/emulators/lms200_emulator.hpp"
#include "sim/laser_model.hpp"
#include "sim/pose_trail.hpp"
#include "sim/scenario.hpp"

namespace server::emulate {

/// The sim's laser model in the present variant of the device. The same seed gives the noise of a
/// pure simulation.
class Mirror {
 public:
  /// For scanner `index` of `scenario`.
  Mirror(const sim::Scenario& scenario, std::uint64_t seed, std::uint32_t index);

  /// Calls `on_scan(scan, part)` for each sweep that ended since the last call. `now` [s, run
  /// clock].
  template <class OnScan>
  void sense(const drivers::lms200::Sweep& sweep,
             double now,
             const sim::PoseTrail& trail,
             OnScan&& on_scan) {
    follow(sweep, now);
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (!models_[i].sense(now, trail, scan_)) continue;
      if (sweep_.parts.empty()) {
        on_scan(scan_, std::optional<std::uint8_t>{});
      } else if (turn_of(scan_) % models_.size() == i) {
        scan_.angle_min += offset(sweep_.parts[i]);
        on_scan(scan_, std::optional(sweep_.parts[i]));
      }
    }
  }
  /// [s] The age of the oldest pose that a sweep needs.
  static double memory();

 private:
  void follow(const drivers::lms200::Sweep& sweep, double now);
  sim::LaserConfig config_for(const drivers::lms200::Variant& variant,
                              std::optional<std::uint8_t> part) const;
  static double offset(std::uint8_t part);
  std::uint64_t turn_of(const algo::LaserScan& scan) const;

  const sim::Scenario& scenario_;
  std::uint64_t seed_ = 0;
  std::uint32_t index_ = 0;
  drivers::lms200::Sweep sweep_{};
  std::vector<sim::LaserModel> models_{};  // one, or one per part
  algo::LaserScan scan_{};
};

}  // namespace server::emulate
