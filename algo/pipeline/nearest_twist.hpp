// algo/pipeline/nearest_twist.hpp: the admissible motion nearest to the wanted one.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

#include "algo/types.hpp"

namespace algo {

constexpr int kMostTwistChecks = 33;

/// The twist nearest to `wanted` for which `admits(twist)` holds, among those between zero and
/// `most`: no component has another sign, or is larger. `most` lies between zero and `wanted`.
/// Distances are measured in shares of `full`, the twist of a full stick, which has no zero. Rest
/// is not asked about: it is the answer if nothing else is admissible.
///
/// A grid of five by five, nearest first, then steps of half a cell, a quarter and so on from the
/// first admissible place towards `most`. Calls `admits` at most kMostTwistChecks times.
template <typename Admits>
Twist2 nearest_twist(const Twist2& wanted,
                     const Twist2& most,
                     const Twist2& full,
                     Admits&& admits) {
  constexpr int kCells = 4;
  constexpr int kHalvings = 5;  // to a 128th
  struct Place {
    double v = 0, omega = 0;  // shares of `most`
    double far = 0;           // squared distance from `wanted`
  };
  const auto twist = [&most](const Place& p) { return Twist2{p.v * most.v, p.omega * most.omega}; };
  const auto place = [&](double v, double omega) {
    const double dv = (wanted.v - v * most.v) / full.v;
    const double dw = (wanted.omega - omega * most.omega) / full.omega;
    return Place{v, omega, dv * dv + dw * dw};
  };
  const auto nearer = [](const Place& a, const Place& b) {
    return std::tie(a.far, b.omega) < std::tie(b.far, a.omega);
  };
  if (most == Twist2{} || admits(most)) return most;
  int checks = 1;

  constexpr std::size_t kPlaces = kCells + 1;
  std::array<Place, kPlaces * kPlaces> grid{};
  std::size_t count = 0;
  const int from_v = most.v == 0 ? kCells : 0;  // a zero has no shares
  const int from_omega = most.omega == 0 ? kCells : 0;
  for (int i = from_v; i <= kCells; ++i) {
    for (int k = from_omega; k <= kCells; ++k) {
      const Place p = place(static_cast<double>(i) / kCells, static_cast<double>(k) / kCells);
      const Twist2 t = twist(p);
      if (t != most && t != Twist2{}) grid.at(count++) = p;
    }
  }
  std::sort(grid.begin(), grid.begin() + static_cast<std::ptrdiff_t>(count), nearer);
  Place best = place(most.v == 0 ? 1 : 0, most.omega == 0 ? 1 : 0);  // rest
  for (std::size_t i = 0; i < count; ++i) {
    ++checks;
    if (!admits(twist(grid.at(i)))) continue;
    best = grid.at(i);
    break;
  }

  double step = 1.0 / kCells;
  for (int halving = 0; halving < kHalvings; ++halving) {
    step /= 2;
    const double v = std::min(1.0, best.v + step);
    const double omega = std::min(1.0, best.omega + step);
    std::array<Place, 3> next{place(v, omega), place(v, best.omega), place(best.v, omega)};
    std::ranges::sort(next, nearer);
    for (const Place& p : next) {
      if (p.far >= best.far || checks == kMostTwistChecks) continue;
      ++checks;
      if (!admits(twist(p))) continue;
      best = p;
      break;
    }
  }
  return twist(best);
}

}  // namespace algo
