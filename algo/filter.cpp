// algo/filter.cpp: decides per beam what may enter a filter, filters, and sets the status again.
#include "algo/filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
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
    filter_believed(half_width == 0 ? FilterKind::None : kind, half_width, out);
  }
}

/// Fills values_ with what each beam says and believed_ with whether it may be believed; true when
/// all may.
bool ScanFilter::believe(const LaserScan& in) {
  const std::size_t n = in.size();
  values_.resize(n);
  believed_.resize(n);
  const double range_max = in.range_max;
  const unsigned sound = std::isfinite(range_max) ? 1 : 0;
  // Restricted: bytes may be part of anything, so that each store would make all be read again.
  const double* const ranges = in.ranges.data();
  const Beam* const status = in.status.data();
  double* const __restrict values = values_.data();
  std::uint8_t* const __restrict believed = believed_.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double value = status[i] == Beam::Ok ? ranges[i] : range_max;
    // A comparison that a NaN fails as well; an infinite range is no reading either.
    const bool finite = std::abs(value) <= std::numeric_limits<double>::max();
    values[i] = finite ? value : 0.0;
    believed[i] = static_cast<std::uint8_t>(sound & static_cast<unsigned>(finite) &
                                            static_cast<unsigned>(status[i] != Beam::Invalid));
  }
  return n == 0 || std::memchr(believed, 0, n) == nullptr;
}

/// The usual case: every beam is believed.
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
  // As set_ok() and set_free() do, without a branch.
  const double range_max = out.range_max;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool ok = ranges[i] < range_max;
    ranges[i] = ok ? ranges[i] : range_max;
    out.status[i] = ok ? Beam::Ok : Beam::Free;
    out.codes[i] = ok ? BeamCode::None : BeamCode::BeyondRange;
  }
}

void ScanFilter::filter_believed(FilterKind kind, int half_width, LaserScan& out) {
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
  // Nearly all are believed: first those as set_ok() and set_free() do, without a branch.
  const double range_max = out.range_max;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool believed = out_believed_[i] != 0;
    const bool ok = filtered[i] < range_max;
    const double range = ok ? filtered[i] : range_max;
    const Beam state = ok ? Beam::Ok : Beam::Free;
    const BeamCode code = ok ? BeamCode::None : BeamCode::BeyondRange;
    out.ranges[i] = believed ? range : out.ranges[i];
    out.status[i] = believed ? state : out.status[i];
    out.codes[i] = believed ? code : out.codes[i];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out_believed_[i] != 0 || out.status[i] == Beam::Invalid) continue;
    const double kept = out.ranges[i];
    out.set_invalid(i, BeamCode::Unknown);
    if (std::isfinite(kept)) out.ranges[i] = kept;
  }
}

}  // namespace algo
