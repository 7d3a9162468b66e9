// algo/filter/causal_median.hpp: the median of the last N samples of a stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace algo {

/// Which of the sorted values D[1] >= D[2] >= .. >= D[N] counts as the middle one.
enum class MedianRank : std::uint8_t {
  Corrected,  // D[ceil(N/2)]: the median of an odd N, the upper middle one of an even N
  /// D[N/2] as printed, with N/2 truncated: of five values the second largest, biased high. A
  /// single value has no D[0]; the value itself is taken.
  Literal,
};

/// Sorts `values` in place, descending. Throws std::invalid_argument when it is empty.
/// Source: Masuda 2008, Appendix I.
double descending_median(std::span<double> values, MedianRank rank);

/// The window is the last N samples; the first sample fills it at the start. A step appears (N-1)/2
/// samples late.
class CausalMedian {
 public:
  /// Throws std::invalid_argument when `window` is 0.
  explicit CausalMedian(std::size_t window, MedianRank rank = MedianRank::Corrected);

  /// The median with `sample` as the newest. A sample that is not finite gives nothing and does not
  /// enter the window.
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
