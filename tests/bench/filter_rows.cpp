// tests/bench/filter_rows.cpp: the pseudomedian against its literal definition.
#include <algorithm>
#include <cmath>

#include "tests/bench/rooms.hpp"
#include "tests/bench/rows.hpp"
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include "algo/filter/filter_kernels.hpp"

namespace bench {
namespace {

/// Eq. 1 of the thesis literally: the mean of the largest minimum and the smallest maximum of the
/// N + 1 groups of N + 1 neighbours in each window of 2 N + 1.
void literal_pseudomedian(const std::vector<double>& in, int N, std::vector<double>& out) {
  const int n = static_cast<int>(in.size());
  const auto at = [&](int i) { return in[static_cast<std::size_t>(std::clamp(i, 0, n - 1))]; };
  for (int i = 0; i < n; ++i) {
    double of_minima = -HUGE_VAL;
    double of_maxima = HUGE_VAL;
    for (int group = i - N; group <= i; ++group) {
      double low = at(group);
      double high = low;
      for (int k = group + 1; k <= group + N; ++k) {
        low = std::min(low, at(k));
        high = std::max(high, at(k));
      }
      of_minima = std::max(of_minima, low);
      of_maxima = std::min(of_maxima, high);
    }
    out[static_cast<std::size_t>(i)] = (of_minima + of_maxima) / 2;
  }
}

/// Scans of W(20) with noise, in whole millimetres.
std::vector<std::vector<double>> noisy_scans(std::size_t count) {
  const auto world = reference::room(20);
  sim::RangeCaster caster = caster_of(world);
  std::mt19937_64 random(3);
  std::vector<std::vector<double>> scans;
  for (const algo::Pose2& pose : poses_in(world, 20, count)) {
    std::vector<double> ranges(kBeams);
    caster.cast(pose, half_turn(), kNearRange, ranges);
    for (double& range : ranges) {
      range = std::nearbyint(1000 * (range + reference::uniform(random, -0.015, 0.015))) / 1000;
    }
    scans.push_back(std::move(ranges));
  }
  return scans;
}

}  // namespace

void filters(Pass& pass) {
  struct Case {
    int N = 0;
    double floor = 0;
    double stretch = 0;
  };
  const auto scans = noisy_scans(pass.count<std::size_t>(256, 32));
  algo::FilterScratch scratch;
  std::vector<double> ours(kBeams);
  std::vector<double> literal(kBeams);
  for (const Case& about : {Case{1, 4, 12}, Case{2, 5, 18}, Case{10, 30, 120}}) {
    const auto filter = [&](const std::vector<double>& scan) {
      algo::pseudomedian(scan, about.N, algo::Border::Replicate, scratch, ours);
    };
    for (const auto& scan : scans) {
      filter(scan);
      literal_pseudomedian(scan, about.N, literal);
      require(ours == literal, fmt::format("P12: N = {} differs from its definition", about.N));
    }
    std::size_t i = 0;
    const auto next = [&]() -> const std::vector<double>& {
      return scans[i = (i + 1) % scans.size()];
    };
    const auto times = pass.time(fmt::format("P12 N={}", about.N),
                                 {{"ours",
                                   [&] {
                                     filter(next());
                                     benchmark::DoNotOptimize(ours.data());
                                     benchmark::ClobberMemory();
                                   }},
                                  {"literal", [&] {
                                     literal_pseudomedian(next(), about.N, literal);
                                     benchmark::DoNotOptimize(literal.data());
                                     benchmark::ClobberMemory();
                                   }}});
    pass.add_ratio({.row = "P12",
                    .name = fmt::format("pseudomedian N = {}", about.N),
                    .floor = about.floor,
                    .stretch = about.stretch},
                   times[0],
                   times[1]);
  }
}

}  // namespace bench
