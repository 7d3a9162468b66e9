// server/lab/reproduce/filter_references.hpp: the filters of the study: the product's own, those
// the thesis compares with, and plain textbook forms for comparing cost.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "algo/filter/filter_kernels.hpp"

namespace server {

/// One filter over a scan, as the masked kernels of algo/filter/filter_kernels.hpp: `valid` marks
/// the valid samples, `out_valid` the valid results.
using FilterFunction = void (*)(std::span<const double> in,
                                std::span<const std::uint8_t> valid,
                                int half_width,
                                algo::FilterScratch& scratch,
                                std::span<double> out,
                                std::span<std::uint8_t> out_valid);

struct StudyFilter {
  std::string_view name{};
  FilterFunction apply = nullptr;
};

/// "before" (unfiltered), pseudomedian, median, lulu, mean, midrange; in this order.
std::span<const StudyFilter> study_filters_table();

/// Applies `filter` to a scan whose samples are all valid.
std::vector<double> filtered(const StudyFilter& filter, std::span<const double> in, int half_width);

/// Eq. 1 as the thesis prints it, groups G_i = [i..N+1] for i = 1..N of the window 1..2N+1: the
/// groups shrink and never reach beyond the centre. Kept to show the effect of the misprint.
std::vector<double> pseudomedian_as_printed(std::span<const double> in, int half_width);

/// Eq. 1 computed for each sample on its own, without reuse: N+1 groups of N+1.
void pseudomedian_by_definition(std::span<const double> in, int half_width, std::span<double> out);

/// The usual running median: a sorted window; each step removes one sample and adds one.
void running_median(std::span<const double> in, int half_width, std::span<double> out);

}  // namespace server
