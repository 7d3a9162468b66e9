// algo/filter/filter_kernels.hpp: the scan filters on plain numbers; algo/filter/filter.hpp applies
// them to scans.
//
// Every kernel takes n values and gives n values in the same unit, bit-exact to its definition. All
// values must be finite: these files are compiled for finite numbers only. n = 0 and n < 2N+1 are
// legal; N = 0 returns the input. N < 0, or an output of another length, throws
// std::invalid_argument. `out` may be the same memory as `in`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace algo {

/// The values assumed beyond the first and the last sample.
enum class Border : std::uint8_t {
  Replicate,  // repeats the edge sample: invents no value
  Reflect,    // mirrors at the edge sample, which is not repeated
};

/// Buffers of the kernels. Keep one per filter, so that nothing is allocated after the first scans.
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

/// The middle value of the window of 2N+1.
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

// The same filters with a mask: `valid` (0 or 1) tells which samples may be used. Each group or
// window uses its valid samples only; an empty group is skipped. An output sample is valid if its
// own input is valid and its border-replicated window of 2N+1 holds at least N+1 valid samples. Any
// other keeps its input value and is marked 0 in `out_valid`.

void pseudomedian(std::span<const double> in,
                  std::span<const std::uint8_t> valid,
                  int half_width,
                  FilterScratch& scratch,
                  std::span<double> out,
                  std::span<std::uint8_t> out_valid);

/// For an even number of valid samples, takes the upper of the two in the middle.
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
