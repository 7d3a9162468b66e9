// server/lab/reproduce/filter_references.hpp: the filters of the study: the product's own, those
// the thesis compares with, and plain textbook forms to measure cost against.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "algo/filter/filter_kernels.hpp"

namespace server {

/// One filter over a scan, as the masked kernels of algo/filter/filter_kernels.hpp: `valid` says
/// which samples may be believed, `out_valid` which results are.
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

/// "before" (nothing done), pseudomedian, median, lulu, mean, midrange; in this order.
std::span<const StudyFilter> study_filters_table();

/// The filter named so applied to a scan whose samples are all valid.
std::vector<double> filtered(const StudyFilter& filter, std::span<const double> in, int half_width);

/// Eq. 1 as the thesis prints it, groups G_i = [i..N+1] for i = 1..N of the window 1..2N+1: they
/// shrink and never look beyond the centre. Kept to show what the misprint would do.
std::vector<double> pseudomedian_as_printed(std::span<const double> in, int half_width);

/// Eq. 1 sample by sample with nothing reused: N+1 groups of N+1.
void pseudomedian_by_definition(std::span<const double> in, int half_width, std::span<double> out);

/// The usual running median: a sorted window that loses one sample and gains one at each step.
void running_median(std::span<const double> in, int half_width, std::span<double> out);

}  // namespace server
