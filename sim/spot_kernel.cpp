// sim/spot_kernel.cpp: without branches, since the order of the surfaces is unpredictable.
#include "sim/spot_kernel.hpp"

#include <array>

#include "algo/wide.hpp"

namespace sim {
namespace {

using Spot = std::array<double, kSpotRays>;

[[gnu::always_inline]] inline void order(double& a, double& b) {
  const double low = b < a ? b : a;
  const double high = b < a ? a : b;
  a = low;
  b = high;
}

/// A sorting network.
[[gnu::always_inline]] inline void sort(Spot& s) {
  static_assert(kSpotRays == 5);
  order(s[0], s[3]);
  order(s[1], s[4]);
  order(s[0], s[2]);
  order(s[1], s[3]);
  order(s[0], s[1]);
  order(s[2], s[4]);
  order(s[1], s[2]);
  order(s[3], s[4]);
  order(s[2], s[3]);
}

/// Mean of the ranges from number `from` on and before number `to`. A spot may include a third
/// surface still farther away; ranges not below `limit` are left out.
[[gnu::always_inline]] inline double mean(const Spot& s, double from, double to, double limit) {
  double sum = 0;
  double count = 0;
  for (std::size_t k = 0; k < kSpotRays; ++k) {
    const auto number = static_cast<double>(k);
    const double below = s[k] < limit ? 1 : 0;
    const double after = number >= from ? below : 0;
    const double taken = number < to ? after : 0;
    sum += taken > 0 ? s[k] : 0;
    count += taken;
  }
  return sum / count;
}

}  // namespace

TAUTLINE_WIDE void judge_spots(const SpotRule& rule,
                               std::size_t spots,
                               double* ranges,
                               std::uint32_t* hits) {
  constexpr std::size_t kBeside = kSpotRays - 1;
  const SpotRule r = rule;
  const double* const beside = ranges;
  const std::uint32_t* const beside_hits = hits;
  double* __restrict out = ranges + kBeside * spots;
  std::uint32_t* __restrict out_hits = hits + kBeside * spots;
  for (std::size_t i = 0; i < spots; ++i) {
    Spot s;
    for (std::size_t k = 0; k < kBeside; ++k) s[k] = beside[k * spots + i];
    s[kBeside] = out[i];
    sort(s);
    double near_count = 0;  // 0: one surface fills the spot
    double widest = r.jump;
    double far_range = s[0];
    for (std::size_t k = 1; k < kSpotRays; ++k) {
      const double gap = s[k] - s[k - 1];
      near_count = gap > widest ? static_cast<double>(k) : near_count;
      far_range = gap > widest ? s[k] : far_range;
      widest = gap > widest ? gap : widest;
    }
    std::uint32_t near_hit = out_hits[i];
    std::uint32_t far_hit = out_hits[i];
    for (std::size_t k = kBeside; k-- > 0;) {  // of equals, the first
      const double range = beside[k * spots + i];
      const std::uint32_t hit = beside_hits[k * spots + i];
      near_hit = range == s[0] ? hit : near_hit;
      far_hit = range == far_range ? hit : far_hit;
    }
    const double near = mean(s, 0, near_count, s[0] + r.mixed_gap);
    const double far = mean(s, near_count, kSpotRays, far_range + r.mixed_gap);
    const double share = near_count / kSpotRays;
    const bool far_returns = far_hit < r.no_echo;
    const bool near_wins = share >= r.near_share_to_win;
    const bool mixed = far_returns & (far - near < r.mixed_gap);
    const double far_alone = far_returns ? far : r.range_max;
    const double alone = near_wins ? near : far_alone;
    const double value = mixed ? share * near + (1 - share) * far : alone;
    const std::uint32_t hit = (mixed | near_wins) ? near_hit : far_hit;
    out[i] = near_count > 0 ? value : out[i];
    out_hits[i] = near_count > 0 ? hit : out_hits[i];
  }
}

}  // namespace sim
