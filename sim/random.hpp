// sim/random.hpp: seeded random numbers, the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace sim {

/// xoshiro256++ (Blackman and Vigna 2019). Each source of randomness owns one, so that switching a
/// source off does not change the numbers of the others.
class Random {
 public:
  /// A generator for `purpose`; different purposes of one seed give independent numbers.
  explicit Random(std::uint64_t seed = 0, std::uint64_t purpose = 0);

  std::uint64_t bits();
  /// In [0, 1).
  double uniform();
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// A whole number below `count`.
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  /// Fills `out` with standard normal numbers.
  void fill_normal(std::span<double> out);
  /// Fills `out` with numbers uniform in [-1, 1).
  void fill_uniform(std::span<double> out);

 private:
  double normal();

  std::array<std::uint64_t, 4> state_{};
};

/// Picks trials of an endless sequence with the same small probability. It draws the gaps between
/// picks (geometric), so each trial costs almost nothing.
class RareEvents {
 public:
  RareEvents(const Random& random, double probability);

  /// Calls `pick(i)` for each picked trial among the next `trials`; i counts from 0.
  template <typename Pick>
  void draw(std::size_t trials, Pick&& pick) {
    std::size_t i = 0;
    while (gap_ < trials - i) {
      i += static_cast<std::size_t>(gap_);
      pick(i);
      ++i;
      gap_ = next_gap();
    }
    if (gap_ != kNever) gap_ -= trials - i;
  }
  /// The underlying generator, for further numbers of a picked trial.
  Random& random() { return random_; }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t next_gap();

  Random random_;
  double probability_ = 0;
  double inverse_log_miss_ = 0;  // 1 / log(1 - probability)
  std::uint64_t gap_ = kNever;   // trials before the next pick
};

}  // namespace sim
