// algo/filter/filter.hpp: the table of scan filters, and their use on a LaserScan.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "algo/filter/filter_kernels.hpp"
#include "algo/laser_scan.hpp"
#include "algo/parameters.hpp"

namespace algo {

enum class FilterKind : std::uint8_t { None, Pseudomedian, Median, Lulu };

struct FilterInfo {
  std::string_view name{};   // "pseudomedian", as in REST, command line, scenario files
  std::string_view label{};  // for people
  std::string_view help{};
  FilterKind kind{};
};

/// All filters; those from the papers come first.
std::span<const FilterInfo> filter_table();
std::optional<FilterKind> find_filter(std::string_view name);

inline constexpr ParameterInfo kFilterHalfWidth{
    .name = "filter.half_width",
    .label = "Filter half width N",
    .max = 10.0,
    .step = 1.0,
    .initial = 1.0,
    .help = "The scan filter looks at N beams on either side; 0 switches it off.",
    .alias = "filter_half_width"};

/// Filters whole scans. Keeps its buffers: give each pipeline its own.
class ScanFilter {
 public:
  /// Filters the ranges of `in` into `out`, which must be another scan.
  ///
  /// A Free beam counts as range_max and is valid. An Invalid beam, or one whose range is not
  /// finite, is never used. An output is Ok if valid and below range_max, Free if valid and at or
  /// beyond it. An Invalid beam keeps its flag, code and value. A beam with too few valid
  /// neighbours becomes Invalid with code Unknown (equations.md A). At the border the edge beam is
  /// repeated, since a scan of 180 degrees is not periodic. Without a finite range_max no beam is
  /// valid.
  ///
  /// Any number of beams is legal. Throws std::invalid_argument when half_width is below 0, and
  /// when ranges, status and codes of `in` differ in number.
  void apply(FilterKind kind, int half_width, const LaserScan& in, LaserScan& out);

 private:
  bool believe(const LaserScan& in);
  void disbelieve(double range_max);
  void filter_all(FilterKind kind, int half_width, LaserScan& out);
  void filter_believed(FilterKind kind, int half_width, const LaserScan& in, LaserScan& out);

  FilterScratch scratch_{};
  std::vector<double> values_{};
  std::vector<std::uint8_t> believed_{};
  std::vector<std::uint8_t> out_believed_{};
};

}  // namespace algo
