// server/record/scan_slots.cpp: matches scans with scanners.
#include "server/record/scan_slots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace server {
namespace {

bool alike(const algo::LaserScan& a, const algo::LaserScan& b) {
  return a.mount_R == b.mount_R && a.angle_min == b.angle_min &&
         a.angle_increment == b.angle_increment && a.range_max == b.range_max &&
         a.turns == b.turns && a.turn_period == b.turn_period;
}

/// [s] Of the end of a sweep, 0 to the sweep's time.
double phase_of(const algo::LaserScan& scan) {
  const double sweep = scan.sweep_time();
  return sweep > 0 ? scan.stamp - std::floor(scan.stamp / sweep) * sweep : 0;
}

/// Scans of `observation` like `scan` before it.
std::size_t place(const algo::Observation& observation, const algo::LaserScan& scan) {
  std::size_t before = 0;
  for (const algo::LaserScan& each : observation.scans) {
    if (&each == &scan) break;
    if (each.size() == scan.size() && alike(each, scan)) ++before;
  }
  return before;
}

std::size_t count(const algo::Observation& observation, const algo::LaserScan& scan) {
  std::size_t all = 0;
  for (const algo::LaserScan& each : observation.scans) {
    if (each.size() == scan.size() && alike(each, scan)) ++all;
  }
  return all;
}

}  // namespace

bool ScanSlots::alike(const Slot& slot, const algo::LaserScan& scan) {
  return slot.beams == scan.size() && server::alike(slot.shape, scan);
}

std::size_t ScanSlots::count_alike(const algo::LaserScan& scan) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(slots_, [&](const Slot& slot) { return alike(slot, scan); }));
}

/// Of the slots like `scan`, the one whose mirror has the nearest phase.
std::size_t ScanSlots::nearest(const algo::LaserScan& scan) const {
  std::size_t best = slots_.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!alike(slots_[i], scan)) continue;
    const double apart = std::abs(phase_of(scan) - slots_[i].phase);
    const double either_way = std::min(apart, std::abs(scan.sweep_time() - apart));
    if (either_way >= least) continue;
    least = either_way;
    best = i;
  }
  return best;
}

void ScanSlots::learn(const algo::Observation& observation) {
  for (const algo::LaserScan& scan : observation.scans) {
    const std::size_t known = count_alike(scan);
    const std::size_t nth = place(observation, scan);
    if (nth < known) continue;
    Slot slot{.beams = scan.size(), .nth = nth, .phase = phase_of(scan)};
    slot.shape.mount_R = scan.mount_R;
    slot.shape.angle_min = scan.angle_min;
    slot.shape.angle_increment = scan.angle_increment;
    slot.shape.range_max = scan.range_max;
    slot.shape.turns = scan.turns;
    slot.shape.turn_period = scan.turn_period;
    slots_.push_back(std::move(slot));
    // Only now is it known which of them scanned: the first may have been taken for another.
    for (const algo::LaserScan& each : observation.scans) {
      for (Slot& other : slots_) {
        if (alike(other, each) && other.nth == place(observation, each)) {
          other.phase = phase_of(each);
        }
      }
    }
  }
}

const algo::LaserScan* ScanSlots::find(const algo::Observation& observation,
                                       std::size_t slot) const {
  const Slot& wanted = slots_[slot];
  const algo::LaserScan* found = nullptr;
  for (const algo::LaserScan& scan : observation.scans) {
    if (!alike(wanted, scan)) continue;
    const bool all = count(observation, scan) == count_alike(scan);
    if (all ? place(observation, scan) == wanted.nth : nearest(scan) == slot) found = &scan;
  }
  return found;
}

}  // namespace server
