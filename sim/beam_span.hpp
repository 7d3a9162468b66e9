// sim/beam_span.hpp: converts an interval of bearings to whole beams.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sim {

/// Calls `take(begin, end)` for the beams within [from, to], all counted in beams. A full turn has
/// `full_turn` beams and the pattern has `beams`. Calls it twice if the interval crosses the seam.
template <typename Take>
inline void beam_spans(double from, double to, double full_turn, std::size_t beams, Take&& take) {
  const auto count = static_cast<double>(beams);
  const auto clip = [count](double value) {
    return static_cast<std::uint32_t>(value < 0 ? 0 : value > count ? count : value);
  };
  const auto piece = [&](double low, double high) {
    const std::uint32_t begin = clip(low);  // truncated: one beam too early does no harm
    const std::uint32_t end = clip(high + 1);
    if (begin < end) take(begin, end);
  };
  if (to - from >= full_turn) return take(0U, static_cast<std::uint32_t>(beams));
  piece(from, to);
  if (from < 0) piece(from + full_turn, to + full_turn);
  if (to >= full_turn) piece(from - full_turn, to - full_turn);
}

}  // namespace sim
