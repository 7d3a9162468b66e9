// tests/sim/spot_kernel_test.cpp: the spots of a sweep at once against one spot at a time.
#include "sim/spot_kernel.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace {

constexpr sim::SpotRule kRule{
    .jump = 0.02, .mixed_gap = 1.2, .near_share_to_win = 0.3, .range_max = 8, .no_echo = 100};

struct Echo {
  double range = 0;
  std::uint32_t hit = 0;
};
using Spot = std::array<Echo, sim::kSpotRays>;

/// The definition in the comment of judge_spots(), literally.
Echo judged(Spot spot) {
  const Echo own = spot.back();
  std::ranges::stable_sort(spot, {}, &Echo::range);
  std::size_t split = 0;
  double widest = kRule.jump;
  for (std::size_t k = 1; k < spot.size(); ++k) {
    const double gap = spot[k].range - spot[k - 1].range;
    if (gap > widest) split = k;
    widest = std::max(widest, gap);
  }
  if (split == 0) return own;
  const auto mean = [&](std::size_t from, std::size_t to) {
    double sum = 0;
    double count = 0;
    for (std::size_t k = from; k < to; ++k) {
      if (!(spot[k].range < spot[from].range + kRule.mixed_gap)) break;
      sum += spot[k].range;
      ++count;
    }
    return sum / count;
  };
  const double near = mean(0, split);
  const double far = mean(split, spot.size());
  const double share = static_cast<double>(split) / sim::kSpotRays;
  const bool far_returns = spot[split].hit < kRule.no_echo;
  if (far_returns && far - near < kRule.mixed_gap) {
    return {share * near + (1 - share) * far, spot[0].hit};
  }
  if (share >= kRule.near_share_to_win) return {near, spot[0].hit};
  return {far_returns ? far : kRule.range_max, spot[split].hit};
}

/// Rays on up to three surfaces, which may be equally far; the last one gives no echo.
Spot drawn(sim::Random& random) {
  std::array<Echo, 3> surfaces{};
  for (std::uint32_t k = 0; k < 2; ++k)
    surfaces[k] = {0.5 * static_cast<double>(1 + random.bits() % 6), k};
  surfaces[2] = {kRule.range_max, kRule.no_echo + static_cast<std::uint32_t>(random.bits() % 2)};
  Spot spot{};
  for (Echo& echo : spot) {
    echo = surfaces[random.bits() % surfaces.size()];
    if (echo.hit < kRule.no_echo && random.bits() % 2 == 0) echo.range += random.uniform(0, 0.05);
  }
  return spot;
}

TEST(SpotKernel, JudgesAllAsOne) {
  sim::Random random(1);
  for (const std::size_t spots : {0U, 1U, 3U, 4U, 7U, 64U, 361U}) {
    std::vector<Spot> each(spots);
    std::vector<double> ranges(spots * sim::kSpotRays);
    std::vector<std::uint32_t> hits(spots * sim::kSpotRays);
    for (std::size_t i = 0; i < spots; ++i) {
      each[i] = drawn(random);
      for (std::size_t k = 0; k < sim::kSpotRays; ++k) {
        ranges[k * spots + i] = each[i][k].range;
        hits[k * spots + i] = each[i][k].hit;
      }
    }
    sim::judge_spots(kRule, spots, ranges.data(), hits.data());
    for (std::size_t i = 0; i < spots; ++i) {
      const Echo expected = judged(each[i]);
      EXPECT_EQ(ranges[(sim::kSpotRays - 1) * spots + i], expected.range) << i << " of " << spots;
      EXPECT_EQ(hits[(sim::kSpotRays - 1) * spots + i], expected.hit) << i << " of " << spots;
    }
  }
}

}  // namespace
