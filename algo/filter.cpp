// algo/filter.cpp: decides per beam what may enter a filter, filters, and sets the status again.
#include "algo/filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
  const bool sound = std::isfinite(in.range_max);
  unsigned all = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double value = in.status[i] == Beam::Ok ? in.ranges[i] : in.range_max;
    // A comparison that a NaN fails as well; an infinite range is no reading either.
    const bool finite = std::abs(value) <= std::numeric_limits<double>::max();
    const bool believed = sound && finite && in.status[i] != Beam::Invalid;
    values_[i] = finite ? value : 0.0;
    believed_[i] = believed ? 1 : 0;
    all &= believed_[i];
  }
  return all != 0;
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
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (ranges[i] < out.range_max) {
      out.set_ok(i, ranges[i]);
    } else {
      out.set_free(i);
    }
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
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out_believed_[i] != 0) {
      if (filtered[i] < out.range_max) {
        out.set_ok(i, filtered[i]);
      } else {
        out.set_free(i);
      }
    } else if (out.status[i] != Beam::Invalid) {
      const double kept = out.ranges[i];
      out.set_invalid(i, BeamCode::Unknown);
      if (std::isfinite(kept)) out.ranges[i] = kept;
    }
  }
}

}  // namespace algo
