// algo/terrain/ground_reader.hpp: the four distances to the floor, smoothed, as one look at each
// side.
//
// Source: Masuda et al. 2008, sections 3 and 4, Appendix I.
#pragma once

#include <array>
#include <cstddef>

#include "algo/filter/causal_median.hpp"
#include "algo/observation.hpp"
#include "algo/terrain/ground_class.hpp"

namespace algo {

/// One side, after the median of its new readings.
struct GroundLook {
  double far = 0;   // [m] X1; NaN if the sensor sees nothing
  double near = 0;  // [m] X2
  GroundClass kind = GroundClass::Flat;
  bool far_off = false;   // the far beam does not end on the floor: the paper's NON-F of PSD1
  bool near_off = false;  // of PSD2
};

class GroundReader {
 public:
  /// The paper's N1 = 5.
  explicit GroundReader(const FloorSensors& sensors,
                        std::size_t window = 5,
                        MedianRank rank = MedianRank::Corrected);

  void reset();
  /// Takes a new reading; one that is held over must not be given twice. Until the window is full
  /// the looks are Pending: the first reading fills it alone, and may be wrong. Does not allocate.
  void take(const FloorRanges& ranges);

  /// False until the window is full.
  bool ready() const { return taken_ == window_; }
  const GroundLook& left() const { return left_; }
  const GroundLook& right() const { return right_; }
  const FlatRanges& flat() const { return flat_; }

 private:
  /// The median of one sensor. NaN once most of the window is empty.
  struct Stream {
    Stream(std::size_t window, MedianRank rank) : median(window, rank), most_missing(window / 2) {}
    double take(double range);
    CausalMedian median;
    std::size_t most_missing = 0;
    std::size_t missing = 0;  // readings in a row without a distance
    double last = 0;
  };
  void look(double far, double near, GroundLook& side) const;
  void wait(GroundLook& side) const;

  FlatRanges flat_{};
  std::size_t window_ = 0;
  std::size_t taken_ = 0;          // readings, up to the window
  std::array<Stream, 4> streams_;  // far left, far right, near left, near right
  GroundLook left_{};
  GroundLook right_{};
};

}  // namespace algo
