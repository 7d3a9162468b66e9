// server/lab/reproduce/filter_references.cpp: reference filters, written for clarity; only algo's
// kernels are tuned.
#include "server/lab/reproduce/filter_references.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>

namespace server {
namespace {

/// Sample i of `in`; the border sample repeats beyond the border.
double repeated(std::span<const double> in, std::ptrdiff_t i) {
  return in[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ssize(in) - 1))];
}

/// Reduces the valid samples of each window; handles validity like the product's filters.
template <double (*Reduce)(const std::vector<double>&)>
void over_windows(std::span<const double> in,
                  std::span<const std::uint8_t> valid,
                  int half_width,
                  algo::FilterScratch& /*scratch*/,
                  std::span<double> out,
                  std::span<std::uint8_t> out_valid) {
  const std::ptrdiff_t last = std::ssize(in) - 1;
  std::vector<double> window;
  for (std::ptrdiff_t c = 0; c <= last; ++c) {
    window.clear();
    for (std::ptrdiff_t k = c - half_width; k <= c + half_width; ++k) {
      const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last));
      if (valid[i] != 0) window.push_back(in[i]);
    }
    const auto i = static_cast<std::size_t>(c);
    const bool enough = valid[i] != 0 && std::ssize(window) > half_width;
    out[i] = enough ? Reduce(window) : in[i];
    out_valid[i] = enough ? 1 : 0;
  }
}

void before(std::span<const double> in,
            std::span<const std::uint8_t> valid,
            int /*half_width*/,
            algo::FilterScratch& /*scratch*/,
            std::span<double> out,
            std::span<std::uint8_t> out_valid) {
  std::ranges::copy(in, out.begin());
  std::ranges::copy(valid, out_valid.begin());
}

double mean(const std::vector<double>& window) {
  return std::accumulate(window.begin(), window.end(), 0.0) / static_cast<double>(window.size());
}

double midrange(const std::vector<double>& window) {
  const auto [low, high] = std::ranges::minmax(window);
  return (low + high) / 2;
}

constexpr std::array<StudyFilter, 6> kTable{{{"before", before},
                                             {"pseudomedian", algo::pseudomedian},
                                             {"median", algo::median},
                                             {"lulu", algo::lulu},
                                             {"mean", over_windows<mean>},
                                             {"midrange", over_windows<midrange>}}};

/// (max of the groups' minima + min of their maxima) / 2 over groups [first(k), last(k)] of samples
/// counted from the centre.
template <typename Group>
double pseudomedian_of(std::span<const double> in, std::ptrdiff_t centre, int groups, Group group) {
  double max_of_min = -std::numeric_limits<double>::max();
  double min_of_max = std::numeric_limits<double>::max();
  for (int k = 0; k < groups; ++k) {
    const auto [first, last] = group(k);
    double low = repeated(in, centre + first);
    double high = low;
    for (std::ptrdiff_t j = first + 1; j <= last; ++j) {
      const double value = repeated(in, centre + j);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    max_of_min = std::max(max_of_min, low);
    min_of_max = std::min(min_of_max, high);
  }
  return (max_of_min + min_of_max) / 2;
}

}  // namespace

std::span<const StudyFilter> study_filters_table() {
  return kTable;
}

std::vector<double> filtered(const StudyFilter& filter,
                             std::span<const double> in,
                             int half_width) {
  algo::FilterScratch scratch;
  const std::vector<std::uint8_t> valid(in.size(), 1);
  std::vector<std::uint8_t> out_valid(in.size());
  std::vector<double> out(in.size());
  filter.apply(in, valid, half_width, scratch, out, out_valid);
  return out;
}

std::vector<double> pseudomedian_as_printed(std::span<const double> in, int half_width) {
  std::vector<double> out(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    // Window index p = 1..2N+1 lies p - (N+1) from the centre.
    out[i] = pseudomedian_of(in, static_cast<std::ptrdiff_t>(i), half_width, [&](int k) {
      return std::pair(k - half_width, 0);
    });
  }
  return out;
}

void pseudomedian_by_definition(std::span<const double> in, int half_width, std::span<double> out) {
  for (std::size_t i = 0; i < in.size(); ++i) {
    out[i] = pseudomedian_of(in, static_cast<std::ptrdiff_t>(i), half_width + 1, [&](int k) {
      return std::pair(k - half_width, k);
    });
  }
}

void running_median(std::span<const double> in, int half_width, std::span<double> out) {
  std::vector<double> window;
  for (std::ptrdiff_t k = -half_width; k <= half_width; ++k) window.push_back(repeated(in, k));
  std::ranges::sort(window);
  for (std::ptrdiff_t i = 0; i < std::ssize(in); ++i) {
    out[static_cast<std::size_t>(i)] = window[static_cast<std::size_t>(half_width)];
    window.erase(std::ranges::lower_bound(window, repeated(in, i - half_width)));
    const double next = repeated(in, i + half_width + 1);
    window.insert(std::ranges::upper_bound(window, next), next);
  }
}

}  // namespace server
