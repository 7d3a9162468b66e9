// sim/random.cpp: xoshiro256++, the ziggurat for normal numbers, geometric gaps.
#include "sim/random.hpp"

#include <bit>
#include <cmath>

#include "algo/wide.hpp"

namespace sim {
namespace {

/// splitmix64 (Steele, Lea and Flood 2014): expands a seed to a whole state.
std::uint64_t split_mix(std::uint64_t& x) {
  x += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = x;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double to_unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// In [-1, 1): 2 to_unit(bits) - 1 with one step less, exact to the bit.
double to_both_sides(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-52 - 1.0;
}

// Ziggurat for the normal density (Marsaglia and Tsang 2000) with 128 layers of equal area. Layer i
// reaches from 0 to edge[i]; a point left of edge[i + 1] is certainly under the curve.
constexpr std::size_t kLayers = 128;
constexpr double kTailStart = 3.442619855899;
constexpr double kLayerArea = 9.91256303526217e-3;

struct Layers {
  std::array<double, kLayers + 1> edge{};
  std::array<double, kLayers> safe{};        // edge[i + 1] / edge[i]
  std::array<double, kLayers + 1> height{};  // of the density at each edge
};

double density(double x) {
  return std::exp(-0.5 * x * x);
}

Layers make_layers() {
  Layers t;
  t.edge[0] = kLayerArea / density(kTailStart);
  t.edge[1] = kTailStart;
  for (std::size_t i = 2; i < kLayers; ++i) {
    const double height = kLayerArea / t.edge[i - 1] + density(t.edge[i - 1]);
    t.edge[i] = std::sqrt(-2.0 * std::log(height));
  }
  t.edge[kLayers] = 0;
  for (std::size_t i = 0; i < kLayers; ++i) t.safe[i] = t.edge[i + 1] / t.edge[i];
  for (std::size_t i = 0; i <= kLayers; ++i) t.height[i] = density(t.edge[i]);
  return t;
}

const Layers kTable = make_layers();

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t purpose) {
  std::uint64_t x = seed;
  x = split_mix(x) ^ purpose;
  for (std::uint64_t& word : state_) word = split_mix(x);
}

std::uint64_t Random::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Random::uniform() {
  return to_unit(bits());
}

/// Inlined into fill_normal(), where the state stays in registers.
inline double Random::normal() {
  for (;;) {
    const std::uint64_t draw = bits();  // low 7 bits choose the layer, high 53 the place in it
    const std::size_t layer = draw % kLayers;
    const double u = to_both_sides(draw);
    if (std::abs(u) < kTable.safe[layer]) return u * kTable.edge[layer];
    if (layer == 0) {  // beyond the outermost edge: Marsaglia's tail method
      for (;;) {
        const double x = -std::log(1.0 - uniform()) / kTailStart;
        const double y = -std::log(1.0 - uniform());
        if (2.0 * y >= x * x) return u < 0 ? -(kTailStart + x) : kTailStart + x;
      }
    }
    const double x = u * kTable.edge[layer];
    const double low = kTable.height[layer];
    const double high = kTable.height[layer + 1];
    if (low + uniform() * (high - low) < density(x)) return x;
  }
}

TAUTLINE_WIDE void Random::fill_normal(std::span<double> out) {
  Random drawn = *this;
  for (double& value : out) value = drawn.normal();
  *this = drawn;
}

void Random::fill_uniform(std::span<double> out) {
  for (double& value : out) value = to_both_sides(bits());
}

RareEvents::RareEvents(const Random& random, double probability)
    : random_(random), probability_(probability) {
  if (probability_ > 0 && probability_ < 1) inverse_log_miss_ = 1.0 / std::log1p(-probability_);
  gap_ = next_gap();
}

std::uint64_t RareEvents::next_gap() {
  if (!(probability_ > 0)) return kNever;
  if (probability_ >= 1) return 0;
  // P(gap >= n) = (1 - p)^n, hence n = floor(log(u) / log(1 - p)) with u in (0, 1].
  const double gap = std::floor(std::log(1.0 - random_.uniform()) * inverse_log_miss_);
  return gap < 0x1.0p62 ? static_cast<std::uint64_t>(gap) : kNever - 1;
}

}  // namespace sim
