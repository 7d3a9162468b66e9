// server/lab/reproduce/filter_signals.cpp: runs the filters on test signals and measures their
// cost.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>

#include "server/lab/reproduce/filter_study.hpp"
#include "sim/random.hpp"

namespace server {
namespace {

using Samples = std::vector<double>;

constexpr std::size_t kLength = 60;
constexpr std::size_t kMiddle = 30;
/// Samples nearer to the border than this are ignored.
constexpr std::size_t kMargin = 12;

Samples made(const std::function<double(std::size_t)>& value) {
  Samples out(kLength);
  for (std::size_t i = 0; i < kLength; ++i) out[i] = value(i);
  return out;
}

double largest_difference(const Samples& a, const Samples& b) {
  double largest = 0;
  for (std::size_t i = kMargin; i + kMargin < kLength; ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// Half of the difference between the highest and the lowest value.
double amplitude(const Samples& x) {
  const auto [low, high] = std::minmax_element(x.begin() + kMargin, x.end() - kMargin);
  return (*high - *low) / 2;
}

SignalResult study(const StudyFilter& filter, int half_width) {
  const auto apply = [&](const Samples& x) { return filtered(filter, x, half_width); };
  const Samples flat(kLength, 0.0);
  const auto impulses = [&](std::initializer_list<std::size_t> places) {
    Samples x = flat;
    for (const std::size_t place : places) x[place] = 1;
    return largest_difference(apply(x), flat);
  };
  const Samples step = made([](std::size_t i) { return i < kMiddle ? 0.0 : 1.0; });
  const Samples ramp = made([](std::size_t i) { return static_cast<double>(i); });
  const Samples fastest = made([](std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; });
  const Samples slower = made([](std::size_t i) { return i % 4 < 2 ? 1.0 : -1.0; });
  return {.filter = std::string(filter.name),
          .half_width = half_width,
          .single = impulses({kMiddle}),
          .adjacent = impulses({kMiddle, kMiddle + 1}),
          .apart = impulses({kMiddle, kMiddle + 2}),
          .step = largest_difference(apply(step), step),
          .ramp = largest_difference(apply(ramp), ramp),
          .fastest = amplitude(apply(fastest)),
          .slower = amplitude(apply(slower))};
}

/// Salt (8000) and pepper (0), equally likely, on the flat reference without its spikes.
Samples spoiled(const Samples& truth, double share, sim::Random& random) {
  Samples out = truth;
  for (double& value : out) {
    if (random.uniform() < share) value = random.uniform() < 0.5 ? 0 : 8000;
  }
  return out;
}

/// [s] CPU time of one call, the fastest of a few rounds: other load can only add time.
class Stopwatch {
 public:
  void round(const std::function<void()>& work) {
    constexpr int kCalls = 20;
    const std::clock_t start = std::clock();
    int calls = 0;
    do {
      for (int k = 0; k < kCalls; ++k) work();
      calls += kCalls;
    } while (std::clock() - start < CLOCKS_PER_SEC / 500);
    const double each = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / calls;
    best_ = std::min(best_, each);
  }
  double best() const { return best_; }

 private:
  double best_ = std::numeric_limits<double>::max();
};

CostResult cost_of(int half_width) {
  sim::Random random(7);
  Samples in(360);
  for (double& value : in) value = std::nearbyint(random.uniform(500, 8000));
  Samples out(in.size());
  algo::FilterScratch scratch;
  constexpr algo::Border kBorder = algo::Border::Replicate;
  Stopwatch fast;
  Stopwatch fast_median;
  Stopwatch plain;
  Stopwatch plain_median;
  for (int round = 0; round < 15; ++round) {
    fast.round([&] { algo::pseudomedian(in, half_width, kBorder, scratch, out); });
    fast_median.round([&] { algo::median(in, half_width, kBorder, scratch, out); });
    plain.round([&] { pseudomedian_by_definition(in, half_width, out); });
    plain_median.round([&] { running_median(in, half_width, out); });
  }
  return {.half_width = half_width,
          .product = fast.best() / fast_median.best(),
          .textbook = plain.best() / plain_median.best()};
}

}  // namespace

std::vector<SignalResult> study_signals() {
  std::vector<SignalResult> out;
  for (const StudyFilter& filter : study_filters_table().subspan(1)) {
    for (const int half_width : {1, 2}) out.push_back(study(filter, half_width));
  }
  return out;
}

std::vector<NoiseResult> study_noise() {
  constexpr int kScans = 500;
  const Samples truth = flat_scene().truth_mm;
  std::vector<NoiseResult> out;
  for (const double share : {0.01, 0.05, 0.10}) {
    for (const StudyFilter& filter : study_filters_table()) {
      for (const int half_width : {1, 2}) {
        const bool nothing_done = filter.name == "before";
        if (nothing_done && half_width > 1) continue;
        sim::Random random(2008);  // the same scans for every filter
        std::ptrdiff_t off = 0;
        for (int scan = 0; scan < kScans; ++scan) {
          const Samples after = filtered(filter, spoiled(truth, share, random), half_width);
          for (std::size_t i = 0; i < truth.size(); ++i) {
            if (std::abs(after[i] - truth[i]) > kImpulse_mm) ++off;
          }
        }
        out.push_back({.spoiled = share,
                       .filter = std::string(filter.name),
                       .half_width = nothing_done ? 0 : half_width,
                       .off = static_cast<double>(off) / (kScans * 360.0)});
      }
    }
  }
  return out;
}

std::vector<CostResult> study_cost() {
  std::vector<CostResult> out;
  for (const int half_width : {1, 2, 5, 10}) out.push_back(cost_of(half_width));
  return out;
}

}  // namespace server
