// algo/filter/filter.cpp: selects the valid beams, filters them, and sets the status again.
#include "algo/filter/filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

namespace algo {
namespace {

constexpr std::array<FilterInfo, 4> kTable{{
    {"pseudomedian",
     "Pseudomedian",
     "The papers' filter. Keeps edges; halves a single wrong reading, does not remove it.",
     FilterKind::Pseudomedian},
    {"median",
     "Median",
     "Removes wrong readings narrower than half its window.",
     FilterKind::Median},
    {"lulu",
     "LULU",
     "Removes every wrong reading of up to N beams and keeps edges and slopes.",
     FilterKind::Lulu},
    {"none", "None", "The scan as the scanner gave it.", FilterKind::None},
}};

/// Writes ranges and status as set_ok() and set_free() do, in two passes that vectorise. `filtered`
/// may be the ranges of `out`.
void set_states(std::span<const double> filtered, LaserScan& out) {
  const double range_max = out.range_max;
  double* const ranges = out.ranges.data();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    ranges[i] = filtered[i] < range_max ? filtered[i] : range_max;
  }
  Beam* const __restrict status = out.status.data();
  BeamCode* const __restrict codes = out.codes.data();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    const bool ok = ranges[i] < range_max;
    status[i] = ok ? Beam::Ok : Beam::Free;
    codes[i] = ok ? BeamCode::None : BeamCode::BeyondRange;
  }
}

}  // namespace

std::span<const FilterInfo> filter_table() {
  return kTable;
}

std::optional<FilterKind> find_filter(std::string_view name) {
  const auto* const found = std::ranges::find(kTable, name, &FilterInfo::name);
  if (found == kTable.end()) return std::nullopt;
  return found->kind;
}

void ScanFilter::apply(FilterKind kind, int half_width, const LaserScan& in, LaserScan& out) {
  if (half_width < 0) {
    throw std::invalid_argument("a filter's half width must be 0 or above, not " +
                                std::to_string(half_width));
  }
  if (in.status.size() != in.size() || in.codes.size() != in.size()) {
    throw std::invalid_argument("a scan of " + std::to_string(in.size()) +
                                " ranges must have as many states and codes");
  }
  out = in;
  if (believe(in)) {
    filter_all(half_width == 0 ? FilterKind::None : kind, half_width, out);
  } else {
    filter_believed(half_width == 0 ? FilterKind::None : kind, half_width, in, out);
  }
}

/// Fills values_ with each beam's value and believed_ with its validity; true if all are valid.
bool ScanFilter::believe(const LaserScan& in) {
  const std::size_t n = in.size();
  values_.resize(n);
  believed_.resize(n);
  const double range_max = in.range_max;
  // __restrict: a byte store may alias anything, so each one would force all to be read again.
  const double* const ranges = in.ranges.data();
  const Beam* const status = in.status.data();
  double* const __restrict values = values_.data();
  std::uint8_t* const __restrict believed = believed_.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double range = ranges[i];
    values[i] = status[i] == Beam::Ok ? range : range_max;
  }
  for (std::size_t i = 0; i < n; ++i) believed[i] = status[i] != Beam::Invalid ? 1 : 0;
  if (!std::isfinite(range_max) || !all_finite(values_)) disbelieve(range_max);
  return n == 0 || std::memchr(believed, 0, n) == nullptr;
}

/// Invalidates beams whose value is not finite; without a finite range_max, all beams.
void ScanFilter::disbelieve(double range_max) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const bool finite = std::isfinite(values_[i]);
    if (!finite) values_[i] = 0;
    if (!finite || !std::isfinite(range_max)) believed_[i] = 0;
  }
}

/// The usual case: every beam is valid.
void ScanFilter::filter_all(FilterKind kind, int half_width, LaserScan& out) {
  const std::span<double> ranges(out.ranges);
  switch (kind) {
    case FilterKind::None:
      std::ranges::copy(values_, ranges.begin());
      break;
    case FilterKind::Pseudomedian:
      pseudomedian(values_, half_width, Border::Replicate, scratch_, ranges);
      break;
    case FilterKind::Median:
      median(values_, half_width, Border::Replicate, scratch_, ranges);
      break;
    case FilterKind::Lulu:
      lulu(values_, half_width, Border::Replicate, scratch_, ranges);
      break;
  }
  set_states(ranges, out);
}

void ScanFilter::filter_believed(FilterKind kind,
                                 int half_width,
                                 const LaserScan& in,
                                 LaserScan& out) {
  const std::span<double> filtered(values_);
  out_believed_.assign(believed_.begin(), believed_.end());
  switch (kind) {
    case FilterKind::None:
      break;
    case FilterKind::Pseudomedian:
      pseudomedian(values_, believed_, half_width, scratch_, filtered, out_believed_);
      break;
    case FilterKind::Median:
      median(values_, believed_, half_width, scratch_, filtered, out_believed_);
      break;
    case FilterKind::Lulu:
      lulu(values_, believed_, half_width, scratch_, filtered, out_believed_);
      break;
  }
  // Nearly all beams are valid: first treat all as valid.
  set_states(filtered, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out_believed_[i] != 0) continue;
    const double kept = in.ranges[i];
    const bool told = in.status[i] != Beam::Invalid;
    out.set_invalid(i, told ? BeamCode::Unknown : in.codes[i]);
    if (!told || std::isfinite(kept)) out.ranges[i] = kept;
  }
}

}  // namespace algo
