// db/range_map.hpp: what a scanner has seen so far, by bearing, from which its next scan is
// foretold.
//
// One scan is as noisy as the next, so their difference is noisier than either. The map is an
// average instead. It keeps still while the scanner turns: a scan lies in it where its beams
// pointed when they were fired, of the even and of the odd beams each along a broken line, since a
// scanner with two interlaced mirror turns fires them half a sweep apart. When the scanner has been
// displaced, the map is moved. All of it is integers, or doubles under + - * / alone: the same on
// every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace db::detail {

constexpr int kFine = 16;          // steps in a millimetre, and in a beam
constexpr std::size_t kKnots = 3;  // of each broken line: its first, middle and last sample

/// Where a scan lies in the map, and how the scanner has been displaced since the last one.
struct Motion {
  std::array<std::array<std::int32_t, kKnots>, 2> turns{};  // [1/16 beam] of even and odd samples
  std::array<std::int32_t, 2> shift{};                      // [mm] ahead and to the left
  bool operator==(const Motion&) const = default;
};
constexpr std::int32_t kMostTurn = 1 << 20;  // [1/16 beam]
constexpr std::int32_t kMostShift = 1000;    // [mm]

/// False when a part of it is beyond the most there may be.
bool is_sane(const Motion& motion);

/// Where a sample is looked up in the map, and what it is expected to be.
struct Place {
  std::size_t left = 0;  // cells
  std::size_t right = 0;
  std::size_t nearer = 0;
  std::int32_t part = 0;   // [1/16] of the way between them
  std::int32_t range = 0;  // [1/16 mm] foretold
  bool known = false;      // the nearer cell has been seen
  bool settled = false;    // often enough to be an average
  bool joined = false;     // both cells lie on one surface
  std::uint16_t expected() const { return static_cast<std::uint16_t>((range + kFine / 2) >> 4); }
};

/// A scan that lies in the map, while its samples are gone through: bare pointers, as the loops
/// over them are what reading a record spends its time on.
class MappedScan {
 public:
  MappedScan(std::int32_t* ranges,
             std::uint8_t* seen,
             std::uint32_t mask,
             const std::int32_t* places)
      : ranges_(ranges), seen_(seen), mask_(mask), places_(places) {}
  Place look_up(std::size_t sample) const;
  void learn(const Place& place, std::uint16_t sample) const;

 private:
  static constexpr std::uint8_t kSettled = 3;
  static constexpr std::int32_t kSurprise = 60 * kFine;  // [1/16 mm] beyond noise: seen anew
  void learn_cell(std::size_t cell, std::int32_t error, std::int32_t weight) const;

  std::int32_t* ranges_;
  std::uint8_t* seen_;
  std::uint32_t mask_;
  const std::int32_t* places_;
};

constexpr std::int32_t kEdge = 400 * kFine;  // [1/16 mm] between two surfaces

/// Foretells scans of one shape. Keeps its buffers.
class RangeMap {
 public:
  static constexpr std::size_t kMostSamples = 4096;  // longer windows are not mapped

  /// Forgets everything but this scan. `per_half_turn`: its samples in 180 degrees, 0 unknown.
  void restart(std::span<const std::byte> samples, std::size_t per_half_turn);
  /// True when the map is of scans of this shape.
  bool is_of(std::size_t count, std::size_t per_half_turn) const {
    return count == count_ && per_half_turn == per_half_turn_;
  }
  void forget() { count_ = 0; }

  /// Of the last scan.
  const Motion& motion() const { return motion_; }
  /// The next scan lies so. Then all its samples are looked up and learnt in their order.
  MappedScan move(const Motion& motion);

  // For finding a motion: cells by number, which may be any.
  std::size_t count() const { return count_; }
  std::int32_t range(std::int32_t cell) const { return ranges_[wrapped(cell)]; }
  /// On one surface with the next one.
  bool is_joined(std::int32_t cell) const {
    const std::size_t left = wrapped(cell);
    const std::size_t right = wrapped(cell + 1);
    return seen_[left] != 0 && seen_[right] != 0 &&
           std::abs(ranges_[left] - ranges_[right]) <= kEdge;
  }
  /// Cosine and sine of the bearing of `beam`, at most kMargin outside the scan; zeros where
  /// bearings are unknown.
  std::array<double, 2> direction(std::int32_t beam) const {
    const std::int32_t place = beam + kMargin;
    return {cosines_[static_cast<std::size_t>(place)], sines_[static_cast<std::size_t>(place)]};
  }
  static constexpr std::int32_t kMargin = 40;  // [beams] of the map beside the scan
  /// Cells by which a shift of 1 mm across moves what is `mm` away.
  double parallax(double mm) const { return cells_per_radian_ / (mm > kNearest ? mm : kNearest); }
  /// The cell straight ahead.
  static std::int32_t middle(const Motion& motion);

 private:
  static constexpr double kNearest = 100;  // [mm]

  std::size_t wrapped(std::int32_t cell) const { return static_cast<std::uint32_t>(cell) & mask_; }
  void aim(const Motion& motion);
  void shift(const std::array<std::int32_t, 2>& by, std::int32_t middle);
  void set_directions();

  std::size_t count_ = 0;  // 0: nothing seen
  std::size_t per_half_turn_ = 0;
  std::uint32_t mask_ = 0;
  Motion motion_{};
  double cells_per_radian_ = 0;
  std::vector<std::int32_t> ranges_{};  // [1/16 mm] a ring of cells, one a beam
  std::vector<std::uint8_t> seen_{};    // how often, up to a limit; 0 never
  std::vector<std::int32_t> places_{};  // [1/16 cell] of the scan's samples
  std::vector<std::int32_t> moved_ranges_{};
  std::vector<std::uint8_t> moved_seen_{};
  std::vector<float> cosines_{};  // of the bearings from kMargin before the first sample on
  std::vector<float> sines_{};
  std::vector<std::int32_t> across_{};   // [1/16 cell] while the map is moved
  std::vector<std::int32_t> nearing_{};  // [1/16 mm]
};

inline Place MappedScan::look_up(std::size_t sample) const {
  const std::int32_t at = places_[sample];
  Place place{};
  place.left = static_cast<std::uint32_t>(at >> 4) & mask_;
  place.right = static_cast<std::uint32_t>((at >> 4) + 1) & mask_;
  place.part = at & (kFine - 1);
  place.nearer = place.part < kFine / 2 ? place.left : place.right;
  const std::int32_t a = ranges_[place.left];
  const std::int32_t step = ranges_[place.right] - a;
  place.known = seen_[place.nearer] != 0;
  place.settled = seen_[place.nearer] >= kSettled;
  place.joined =
      step <= kEdge && step >= -kEdge && seen_[place.left] != 0 && seen_[place.right] != 0;
  place.range = place.joined ? a + ((step * place.part) >> 4) : ranges_[place.nearer];
  return place;
}

inline void MappedScan::learn_cell(std::size_t cell,
                                   std::int32_t error,
                                   std::int32_t weight) const {
  // Of the n-th sight a new average takes 1/n, in 1/256.
  static constexpr std::array<std::int32_t, 6> kShares{256, 256, 128, 85, 64, 51};
  if (seen_[cell] + 1U < kShares.size()) ++seen_[cell];
  ranges_[cell] += (((error * kShares[seen_[cell]]) >> 8) * weight) >> 8;
}

inline void MappedScan::learn(const Place& place, std::uint16_t sample) const {
  // What of an error at part p falls to the left cell: (1-p) / ((1-p)^2 + p^2), in 1/256; so that
  // the line between the cells takes all of it.
  static constexpr std::array<std::int32_t, kFine + 1> kWeights{
      256, 272, 287, 299, 307, 309, 301, 284, 256, 221, 181, 140, 102, 69, 41, 18, 0};
  const std::int32_t error = sample * kFine - place.range;
  if (!place.known || error > kSurprise || error < -kSurprise) {
    ranges_[place.nearer] = sample * kFine;
    seen_[place.nearer] = 1;
  } else if (place.joined) {
    learn_cell(place.left, error, kWeights[static_cast<std::size_t>(place.part)]);
    learn_cell(place.right, error, kWeights[static_cast<std::size_t>(kFine - place.part)]);
  } else {
    learn_cell(place.nearer, error, 256);
  }
}

}  // namespace db::detail
