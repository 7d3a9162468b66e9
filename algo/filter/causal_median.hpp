// algo/filter/causal_median.hpp: median of the last N samples of a stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace algo {

/// Which of the values D[1] >= D[2] >= .. >= D[N] counts as the middle one.
enum class MedianRank : std::uint8_t {
  Corrected,  // D[ceil(N/2)]: the median of an odd N, the upper middle one of an even N
  /// D[N/2] as printed, with N/2 truncated: of five values the second largest, biased high.
  /// D[0] of a single value does not exist; the value itself stands for it.
  Literal,
};

/// `values` is sorted in place, descending. Throws std::invalid_argument when it is empty.
/// Source: Masuda 2008, Appendix I.
double descending_median(std::span<double> values, MedianRank rank);

/// Window = the last N samples, filled with the first one at the start. A step comes out (N-1)/2
/// samples late.
class CausalMedian {
 public:
  /// Throws std::invalid_argument when `window` is 0.
  explicit CausalMedian(std::size_t window, MedianRank rank = MedianRank::Corrected);

  /// The median with `sample` as the newest one; nothing when it is not a finite number, which
  /// then does not enter the window.
  std::optional<double> push(double sample);
  void reset() { started_ = false; }

 private:
  std::vector<double> recent_{};  // a ring
  std::vector<double> sorted_{};
  std::size_t next_ = 0;
  bool started_ = false;
  MedianRank rank_ = MedianRank::Corrected;
};

}  // namespace algo
