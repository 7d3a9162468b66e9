// algo/filter/filter_kernels.hpp: the scan filters on bare numbers; algo/filter/filter.hpp puts
// them on scans.
//
// Every kernel takes n finite values (the caller has sorted out what is not: these files are
// compiled for finite numbers), gives n values in the same unit and is bit-exact to its definition.
// n = 0 and n < 2N+1 are legal; N = 0 returns the input. N < 0, or an output of another length,
// throws std::invalid_argument. `out` may be the same memory as `in`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace algo {

/// What stands beyond the first and the last sample.
enum class Border : std::uint8_t {
  Replicate,  // the edge sample again and again: invents no value
  Reflect,    // mirrored at the edge sample, which is not repeated
};

/// Buffers of the kernels; keep one per filter, so that nothing is allocated once it is warm.
struct FilterScratch {
  std::vector<double> padded{};
  std::vector<double> low{};
  std::vector<double> high{};
  std::vector<double> mask{};
  std::vector<double> spare{};
  std::vector<std::uint8_t> trusted{};
};

/// PMED = (max_k min(G_k) + min_k max(G_k)) / 2 over the N+1 groups G_k of N+1 neighbours in the
/// window of 2N+1 about each sample.
/// Source: Nong 2008 (thesis), Eq. 1 = Choi 2008, Eq. 1. The thesis prints i = 1..N and
/// G_i = [i..N+1], groups of shrinking length, against its own sentence; the sentence is right.
/// Computed as (opening + closing) / 2 with a flat element of N+1.
void pseudomedian(std::span<const double> in,
                  int half_width,
                  Border border,
                  FilterScratch& scratch,
                  std::span<double> out);

/// Middle value of the window of 2N+1.
void median(std::span<const double> in,
            int half_width,
            Border border,
            FilterScratch& scratch,
            std::span<double> out);

/// (close(open(x)) + open(close(x))) / 2, with opening and closing as in pseudomedian(): removes
/// every isolated impulse of at most N samples completely. Not in the sources.
void lulu(std::span<const double> in,
          int half_width,
          Border border,
          FilterScratch& scratch,
          std::span<double> out);

// The same with samples that must not be believed: `valid` (0 or 1) says which may be. Each group
// or window uses its valid samples only, an empty group is skipped. A sample of the output is
// valid when its own input is and its border-replicated window of 2N+1 holds at least N+1 valid
// ones; any other keeps its input value and is marked 0 in `out_valid`.

void pseudomedian(std::span<const double> in,
                  std::span<const std::uint8_t> valid,
                  int half_width,
                  FilterScratch& scratch,
                  std::span<double> out,
                  std::span<std::uint8_t> out_valid);

/// Of an even number of valid samples: the upper of the two in the middle.
void median(std::span<const double> in,
            std::span<const std::uint8_t> valid,
            int half_width,
            FilterScratch& scratch,
            std::span<double> out,
            std::span<std::uint8_t> out_valid);

void lulu(std::span<const double> in,
          std::span<const std::uint8_t> valid,
          int half_width,
          FilterScratch& scratch,
          std::span<double> out,
          std::span<std::uint8_t> out_valid);

}  // namespace algo
