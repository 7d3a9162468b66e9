// algo/filter/filter_kernels.cpp: sliding minima and maxima as simple loops over the index, which
// the compiler vectorises. Queues do not vectorise and are slower at these sizes.
//
// Compiled with -O3 for finite numbers (algo/CMakeLists.txt): no infinity and no NaN in here.
#include "algo/filter/filter_kernels.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

// Two versions of the passes, for four or two numbers at a time, chosen when the program starts.
// Not under a sanitizer: the choice is made before its runtime is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TAUTLINE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define TAUTLINE_WIDE
#endif

namespace algo {
namespace {

// Stand for "no valid sample here": they never win a minimum or a maximum.
constexpr double kNoneForMin = std::numeric_limits<double>::max();
constexpr double kNoneForMax = -kNoneForMin;

inline double smaller(double a, double b) {
  return b < a ? b : a;
}
inline double larger(double a, double b) {
  return a < b ? b : a;
}

// to[i] = extreme of from[i] and from[i + shift], for i in [0, n).
TAUTLINE_WIDE void fold_min(const double* __restrict from,
                            double* __restrict to,
                            std::size_t shift,
                            std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = smaller(from[i], from[i + shift]);
}

TAUTLINE_WIDE void fold_max(const double* __restrict from,
                            double* __restrict to,
                            std::size_t shift,
                            std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = larger(from[i], from[i + shift]);
}

TAUTLINE_WIDE void mean_of_two(const double* __restrict a,
                               const double* __restrict b,
                               double* __restrict out,
                               std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = (a[i] + b[i]) / 2;
}

// N = 1 and 2 in one pass, by the definition: these are the common settings, and separate passes do
// not pay for so few samples. p is padded by N on either side.
TAUTLINE_WIDE void pseudomedian_3(const double* __restrict p,
                                  double* __restrict out,
                                  std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double a = p[i];
    const double b = p[i + 1];
    const double c = p[i + 2];
    const double open = larger(smaller(a, b), smaller(b, c));
    const double close = smaller(larger(a, b), larger(b, c));
    out[i] = (open + close) / 2;
  }
}

TAUTLINE_WIDE void pseudomedian_5(const double* __restrict p,
                                  double* __restrict out,
                                  std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double a = p[i];
    const double b = p[i + 1];
    const double c = p[i + 2];
    const double d = p[i + 3];
    const double e = p[i + 4];
    const double low_bc = smaller(b, c);
    const double low_cd = smaller(c, d);
    const double high_bc = larger(b, c);
    const double high_cd = larger(c, d);
    const double open = larger(larger(smaller(a, low_bc), smaller(b, low_cd)), smaller(low_cd, e));
    const double close =
        smaller(smaller(larger(a, high_bc), larger(b, high_cd)), larger(high_cd, e));
    out[i] = (open + close) / 2;
  }
}

TAUTLINE_WIDE void median_3(const double* __restrict p, double* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double low = smaller(p[i], p[i + 1]);
    const double high = larger(p[i], p[i + 1]);
    out[i] = larger(low, smaller(high, p[i + 2]));
  }
}

// Neither the smaller of two minima nor the larger of two maxima can be the middle one of five.
TAUTLINE_WIDE void median_5(const double* __restrict p, double* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double a = larger(smaller(p[i], p[i + 1]), smaller(p[i + 3], p[i + 4]));
    const double b = smaller(larger(p[i], p[i + 1]), larger(p[i + 3], p[i + 4]));
    const double low = smaller(a, b);
    const double high = larger(a, b);
    out[i] = larger(low, smaller(high, p[i + 2]));
  }
}

// Widest window for the doubling passes. Up to it they are faster than any method whose work does
// not grow with the width, since such methods do not vectorise.
constexpr std::size_t kDoublingLimit = 512;

/// van Herk, Gil and Werman: three extremes per sample for any width. `a` has n samples; the n -
/// width + 1 results replace them in place. `suffix` holds each block's running extremes from the
/// right.
template <typename Extreme>
void slide_blocks(std::vector<double>& a,
                  std::vector<double>& suffix,
                  std::size_t n,
                  std::size_t width,
                  Extreme extreme) {
  for (std::size_t i = n; i-- > 0;) {
    const bool block_end = (i + 1) % width == 0 || i + 1 == n;
    suffix[i] = block_end ? a[i] : extreme(a[i], suffix[i + 1]);
  }
  double prefix = a[0];
  for (std::size_t i = 1; i + 1 < width; ++i) prefix = extreme(prefix, a[i]);
  for (std::size_t i = 0; i + width <= n; ++i) {
    const std::size_t last = i + width - 1;
    prefix = last % width == 0 ? a[last] : extreme(prefix, a[last]);
    a[i] = extreme(suffix[i], prefix);
  }
}

/// Doubling: extremes of 2, 4, 8 .. samples, then two overlapping ones make up the width. At most
/// nine simple passes up to kDoublingLimit. The result is in `a`.
template <typename Fold>
void slide_doubling(std::vector<double>& a,
                    std::vector<double>& spare,
                    std::size_t n,
                    std::size_t width,
                    Fold fold) {
  std::size_t have = 1;
  while (have < width) {
    const std::size_t shift = std::min(have, width - have);
    fold(a.data(), spare.data(), shift, n - have + 1 - shift);
    std::swap(a, spare);
    have += shift;
  }
}

template <typename Fold, typename Extreme>
std::size_t slide(std::vector<double>& a,
                  std::vector<double>& spare,
                  std::size_t n,
                  std::size_t width,
                  Fold fold,
                  Extreme extreme) {
  spare.resize(a.size());
  if (width <= kDoublingLimit) {
    slide_doubling(a, spare, n, width, fold);
  } else {
    slide_blocks(a, spare, n, width, extreme);
  }
  return n - width + 1;
}

std::size_t slide_min(std::vector<double>& a, std::size_t n, std::size_t width, FilterScratch& s) {
  return slide(a, s.spare, n, width, fold_min, smaller);
}

std::size_t slide_max(std::vector<double>& a, std::size_t n, std::size_t width, FilterScratch& s) {
  return slide(a, s.spare, n, width, fold_max, larger);
}

void replace(std::vector<double>& a, std::size_t n, double from, double to) {
  for (std::size_t i = 0; i < n; ++i) a[i] = a[i] == from ? to : a[i];
}

/// max of min of `width`; in place, 2 (width - 1) samples shorter. With `masked`, the input marks
/// "none" by kNoneForMin and the output by kNoneForMax.
std::size_t opening(
    std::vector<double>& a, std::size_t n, std::size_t width, bool masked, FilterScratch& s) {
  n = slide_min(a, n, width, s);
  if (masked) replace(a, n, kNoneForMin, kNoneForMax);
  return slide_max(a, n, width, s);
}

/// min of max, with the two "none" marks swapped.
std::size_t closing(
    std::vector<double>& a, std::size_t n, std::size_t width, bool masked, FilterScratch& s) {
  n = slide_max(a, n, width, s);
  if (masked) replace(a, n, kNoneForMax, kNoneForMin);
  return slide_min(a, n, width, s);
}

std::size_t border_index(std::ptrdiff_t i, std::ptrdiff_t n, Border border) {
  if (border == Border::Replicate) {
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1));
  }
  if (n == 1) return 0;
  const std::ptrdiff_t period = 2 * (n - 1);
  const std::ptrdiff_t folded = ((i % period) + period) % period;
  return static_cast<std::size_t>(folded < n ? folded : period - folded);
}

/// `in` with `margin` border samples on either side.
template <typename T>
void pad(std::span<const T> in, std::size_t margin, Border border, std::vector<T>& padded) {
  const std::size_t n = in.size();
  padded.resize(n + 2 * margin);
  std::copy(in.begin(), in.end(), padded.begin() + static_cast<std::ptrdiff_t>(margin));
  const auto length = static_cast<std::ptrdiff_t>(n);
  for (std::size_t k = 0; k < margin; ++k) {
    const auto before = static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(margin);
    padded[k] = in[border_index(before, length, border)];
    padded[margin + n + k] =
        in[border_index(length + static_cast<std::ptrdiff_t>(k), length, border)];
  }
}

/// Throws if the call is invalid. True if there is nothing to filter; `out` is then `in`.
bool trivial(std::span<const double> in, int half_width, std::span<double> out) {
  if (half_width < 0) {
    throw std::invalid_argument("a filter's half width must be 0 or above, not " +
                                std::to_string(half_width));
  }
  if (out.size() != in.size()) {
    throw std::invalid_argument("a filter's output has " + std::to_string(out.size()) +
                                " samples for an input of " + std::to_string(in.size()));
  }
  if (!in.empty() && half_width > 0) return false;
  if (!in.empty()) std::memmove(out.data(), in.data(), in.size() * sizeof(double));
  return true;
}

/// Slides over `padded`. Sorts the first window and then keeps it sorted: the new sample replaces
/// the one that leaves.
void slide_median(const std::vector<double>& padded,
                  std::size_t N,
                  std::vector<double>& sorted,
                  std::span<double> out) {
  const std::size_t width = 2 * N + 1;
  sorted.assign(padded.begin(), padded.begin() + static_cast<std::ptrdiff_t>(width));
  std::sort(sorted.begin(), sorted.end());
  out[0] = sorted[N];
  for (std::size_t i = 1; i < out.size(); ++i) {
    const double leaves = padded[i - 1];
    const double comes = padded[i + width - 1];
    auto place = std::lower_bound(sorted.begin(), sorted.end(), leaves);
    for (; place + 1 != sorted.end() && place[1] < comes; ++place) place[0] = place[1];
    for (; place != sorted.begin() && comes < place[-1]; --place) place[0] = place[-1];
    *place = comes;
    out[i] = sorted[N];
  }
}

constexpr std::size_t kOnePassLimit = 2;

/// N = 1 or 2; `padded` by N on either side.
void pseudomedian_in_one_pass(const double* padded, std::size_t N, std::span<double> out) {
  if (N == 1) {
    pseudomedian_3(padded, out.data(), out.size());
  } else {
    pseudomedian_5(padded, out.data(), out.size());
  }
}

/// Index of the first 0 in [from, count), or `count`.
std::size_t find_zero(const std::uint8_t* marks, std::size_t from, std::size_t count) {
  const void* const found = from < count ? std::memchr(marks + from, 0, count - from) : nullptr;
  if (found == nullptr) return count;
  return static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - marks);
}

/// Marks in s.trusted and `out_valid` the samples with a valid window, which a running sum counts.
void judge_windows(std::span<const std::uint8_t> valid,
                   std::size_t N,
                   FilterScratch& s,
                   std::span<std::uint8_t> out_valid) {
  pad(valid, N, Border::Replicate, s.trusted);
  std::size_t count = 0;
  for (std::size_t k = 0; k < 2 * N; ++k) count += s.trusted[k];
  for (std::size_t i = 0; i < out_valid.size(); ++i) {
    count += s.trusted[i + 2 * N];
    out_valid[i] = s.trusted[i + N] != 0 && count > N ? 1 : 0;
    count -= s.trusted[i];
  }
}

/// True if there is nothing to filter.
bool trivial(std::span<const double> in,
             std::span<const std::uint8_t> valid,
             int half_width,
             std::span<double> out,
             std::span<std::uint8_t> out_valid) {
  if (valid.size() != in.size() || out_valid.size() != in.size()) {
    throw std::invalid_argument("a filter's marks must be as many as its samples, " +
                                std::to_string(in.size()));
  }
  if (!trivial(in, half_width, out)) return false;
  if (!valid.empty()) std::memmove(out_valid.data(), valid.data(), valid.size());
  return true;
}

/// Pads `in` into s.mask, with kNoneForMin where not valid. judge_windows() must have padded
/// s.trusted for a margin N <= margin.
void mask_samples(std::span<const double> in,
                  std::span<const std::uint8_t> valid,
                  std::size_t margin,
                  FilterScratch& s) {
  pad(in, margin, Border::Replicate, s.mask);
  pad(valid, margin, Border::Replicate, s.trusted);
  for (std::size_t i = 0; i < s.mask.size(); ++i) {
    if (s.trusted[i] == 0) s.mask[i] = kNoneForMin;
  }
}

void keep_invalid(std::span<const double> in,
                  std::span<const std::uint8_t> out_valid,
                  const std::vector<double>& a,
                  const std::vector<double>& b,
                  std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = out_valid[i] != 0 ? (a[i] + b[i]) / 2 : in[i];
  }
}

/// The pseudomedian of the window of 2N+1 samples from `p`, by its definition. The middle sample
/// must be trusted, so that no group is empty.
double pseudomedian_of_trusted(const double* p, const std::uint8_t* trusted, std::size_t N) {
  double open = kNoneForMax;
  double close = kNoneForMin;
  for (std::size_t first = 0; first <= N; ++first) {
    double least = kNoneForMin;
    double most = kNoneForMax;
    for (std::size_t k = first; k <= first + N; ++k) {
      least = trusted[k] != 0 ? smaller(least, p[k]) : least;
      most = trusted[k] != 0 ? larger(most, p[k]) : most;
    }
    open = larger(open, least);
    close = smaller(close, most);
  }
  return (open + close) / 2;
}

/// For few invalid samples: filters all in one pass as if valid, and then again those samples whose
/// window holds an invalid one.
void pseudomedian_mended(std::span<const double> in,
                         std::span<const std::uint8_t> valid,
                         std::size_t N,
                         FilterScratch& s,
                         std::span<double> out,
                         std::span<std::uint8_t> out_valid) {
  pad(in, N, Border::Replicate, s.padded);
  pad(valid, N, Border::Replicate, s.trusted);
  const double* const padded = s.padded.data();
  const std::uint8_t* const trusted = s.trusted.data();
  pseudomedian_in_one_pass(padded, N, out);
  std::memset(out_valid.data(), 1, out_valid.size());
  std::size_t mended = 0;  // windows mended before this one
  const std::size_t samples = s.trusted.size();
  for (std::size_t bad = find_zero(trusted, 0, samples); bad < samples;
       bad = find_zero(trusted, bad + 1, samples)) {
    const std::size_t end = std::min(bad + 1, out.size());
    for (std::size_t i = std::max(mended, bad - std::min(bad, 2 * N)); i < end; ++i) {
      std::size_t count = 0;
      for (std::size_t k = i; k <= i + 2 * N; ++k) count += trusted[k];
      const bool sound = trusted[i + N] != 0 && count > N;
      out[i] = sound ? pseudomedian_of_trusted(padded + i, trusted + i, N) : padded[i + N];
      out_valid[i] = sound ? 1 : 0;
    }
    mended = end;
  }
}

}  // namespace

void pseudomedian(std::span<const double> in,
                  int half_width,
                  Border border,
                  FilterScratch& scratch,
                  std::span<double> out) {
  if (trivial(in, half_width, out)) return;
  const auto N = static_cast<std::size_t>(half_width);
  pad(in, N, border, scratch.padded);
  const std::vector<double>& padded = scratch.padded;
  if (N <= kOnePassLimit) return pseudomedian_in_one_pass(padded.data(), N, out);
  scratch.low = padded;
  scratch.high = padded;
  opening(scratch.low, padded.size(), N + 1, false, scratch);
  closing(scratch.high, padded.size(), N + 1, false, scratch);
  mean_of_two(scratch.low.data(), scratch.high.data(), out.data(), out.size());
}

void median(std::span<const double> in,
            int half_width,
            Border border,
            FilterScratch& scratch,
            std::span<double> out) {
  if (trivial(in, half_width, out)) return;
  const auto N = static_cast<std::size_t>(half_width);
  pad(in, N, border, scratch.padded);
  const double* const padded = scratch.padded.data();
  if (N == 1) return median_3(padded, out.data(), out.size());
  if (N == 2) return median_5(padded, out.data(), out.size());
  slide_median(scratch.padded, N, scratch.low, out);
}

void lulu(std::span<const double> in,
          int half_width,
          Border border,
          FilterScratch& scratch,
          std::span<double> out) {
  if (trivial(in, half_width, out)) return;
  const auto N = static_cast<std::size_t>(half_width);
  // 2N border samples cover all values that an opening and a closing in a row read.
  pad(in, 2 * N, border, scratch.padded);
  scratch.low = scratch.padded;
  scratch.high = scratch.padded;
  const std::size_t n = scratch.padded.size();
  closing(scratch.low, opening(scratch.low, n, N + 1, false, scratch), N + 1, false, scratch);
  opening(scratch.high, closing(scratch.high, n, N + 1, false, scratch), N + 1, false, scratch);
  mean_of_two(scratch.low.data(), scratch.high.data(), out.data(), out.size());
}

void pseudomedian(std::span<const double> in,
                  std::span<const std::uint8_t> valid,
                  int half_width,
                  FilterScratch& scratch,
                  std::span<double> out,
                  std::span<std::uint8_t> out_valid) {
  if (trivial(in, valid, half_width, out, out_valid)) return;
  const auto N = static_cast<std::size_t>(half_width);
  if (N <= kOnePassLimit) return pseudomedian_mended(in, valid, N, scratch, out, out_valid);
  mask_samples(in, valid, N, scratch);
  judge_windows(valid, N, scratch, out_valid);
  scratch.low = scratch.mask;
  scratch.high = scratch.mask;
  const std::size_t n = scratch.mask.size();
  opening(scratch.low, n, N + 1, true, scratch);
  replace(scratch.high, n, kNoneForMin, kNoneForMax);
  closing(scratch.high, n, N + 1, true, scratch);
  keep_invalid(in, out_valid, scratch.low, scratch.high, out);
}

void median(std::span<const double> in,
            std::span<const std::uint8_t> valid,
            int half_width,
            FilterScratch& scratch,
            std::span<double> out,
            std::span<std::uint8_t> out_valid) {
  if (trivial(in, valid, half_width, out, out_valid)) return;
  const auto N = static_cast<std::size_t>(half_width);
  mask_samples(in, valid, N, scratch);
  judge_windows(valid, N, scratch, out_valid);
  scratch.low.resize(2 * N + 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out_valid[i] == 0) {
      out[i] = in[i];
      continue;
    }
    auto end = scratch.low.begin();
    for (std::size_t k = i; k <= i + 2 * N; ++k) {
      if (scratch.trusted[k] != 0) *end++ = scratch.mask[k];
    }
    const auto upper_middle = scratch.low.begin() + (end - scratch.low.begin()) / 2;
    std::nth_element(scratch.low.begin(), upper_middle, end);
    out[i] = *upper_middle;
  }
}

void lulu(std::span<const double> in,
          std::span<const std::uint8_t> valid,
          int half_width,
          FilterScratch& scratch,
          std::span<double> out,
          std::span<std::uint8_t> out_valid) {
  if (trivial(in, valid, half_width, out, out_valid)) return;
  const auto N = static_cast<std::size_t>(half_width);
  mask_samples(in, valid, 2 * N, scratch);
  judge_windows(valid, N, scratch, out_valid);
  scratch.low = scratch.mask;
  scratch.high = scratch.mask;
  const std::size_t n = scratch.mask.size();
  closing(scratch.low, opening(scratch.low, n, N + 1, true, scratch), N + 1, true, scratch);
  replace(scratch.high, n, kNoneForMin, kNoneForMax);
  opening(scratch.high, closing(scratch.high, n, N + 1, true, scratch), N + 1, true, scratch);
  keep_invalid(in, out_valid, scratch.low, scratch.high, out);
}

}  // namespace algo
