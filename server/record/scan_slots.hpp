// server/record/scan_slots.hpp: tells the scanners of a run apart by their scans.
#pragma once

#include <cstddef>
#include <vector>

#include "algo/observation.hpp"

namespace server {

/// A frame does not number its scanners. Scans with another mount or other beams are of another
/// scanner. Scanners alike at one place, as one above the other, are told apart in their order
/// within a tick, to which each adds one scan at most; in a tick without all of them, by the phase
/// of their mirrors.
class ScanSlots {
 public:
  /// Learns from the scans of one tick.
  void learn(const algo::Observation& observation);
  std::size_t size() const { return slots_.size(); }
  /// The scan of scanner `slot`, in the order of their first scans; nullptr if there is none.
  const algo::LaserScan* find(const algo::Observation& observation, std::size_t slot) const;

 private:
  struct Slot {
    algo::LaserScan shape{};  // without ranges
    std::size_t beams = 0;
    std::size_t nth = 0;  // of those alike
    double phase = 0;     // [s]
  };
  static bool alike(const Slot& slot, const algo::LaserScan& scan);
  std::size_t count_alike(const algo::LaserScan& scan) const;
  std::size_t nearest(const algo::LaserScan& scan) const;

  std::vector<Slot> slots_{};
};

}  // namespace server
