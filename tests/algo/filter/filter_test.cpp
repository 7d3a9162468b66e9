// tests/algo/filter/filter_test.cpp: the fast filters against their definitions, and on whole
// scans.
#include "algo/filter/filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

using algo::Beam;
using algo::BeamCode;
using algo::Border;
using algo::FilterKind;
using algo::LaserScan;

using Samples = std::vector<double>;
using Marks = std::vector<std::uint8_t>;

// ---- The definitions, word for word ----

std::ptrdiff_t at_border(std::ptrdiff_t i, std::ptrdiff_t n, Border border) {
  if (border == Border::Replicate) return std::clamp<std::ptrdiff_t>(i, 0, n - 1);
  while (n > 1 && (i < 0 || i >= n)) i = i < 0 ? -i : 2 * (n - 1) - i;
  return n == 1 ? 0 : i;
}

/// Window of sample c: the valid ones of w[0..2N], nothing where invalid.
std::vector<std::optional<double>> window(
    const Samples& x, const Marks& valid, int N, std::ptrdiff_t c, Border border) {
  std::vector<std::optional<double>> w;
  for (std::ptrdiff_t k = c - N; k <= c + N; ++k) {
    const auto i = static_cast<std::size_t>(at_border(k, std::ssize(x), border));
    w.push_back(valid[i] != 0 ? std::optional(x[i]) : std::nullopt);
  }
  return w;
}

/// Eq. 1 over the groups G_k = w[k..k+N], each of its valid samples, empty groups skipped.
double pseudomedian_of(const std::vector<std::optional<double>>& w, int N) {
  std::optional<double> max_of_min;
  std::optional<double> min_of_max;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(N); ++k) {
    std::vector<double> group;
    for (std::size_t j = k; j <= k + static_cast<std::size_t>(N); ++j) {
      if (w[j]) group.push_back(*w[j]);
    }
    if (group.empty()) continue;
    const double low = *std::ranges::min_element(group);
    const double high = *std::ranges::max_element(group);
    max_of_min = std::max(max_of_min.value_or(low), low);
    min_of_max = std::min(min_of_max.value_or(high), high);
  }
  return (*max_of_min + *min_of_max) / 2;
}

double median_of(const std::vector<std::optional<double>>& w) {
  std::vector<double> values;
  for (const auto& each : w) {
    if (each) values.push_back(*each);
  }
  std::ranges::sort(values);
  return values[values.size() / 2];  // the upper middle one of an even number
}

bool enough(const std::vector<std::optional<double>>& w, int N) {
  return w[static_cast<std::size_t>(N)] &&
         std::ranges::count_if(w, [](const auto& v) { return v.has_value(); }) >= N + 1;
}

Samples random_samples(std::mt19937_64& random, std::size_t n) {
  // Few different values give runs and ties; many give the general case.
  const bool coarse = random() % 2 == 0;
  Samples x(n);
  for (double& each : x) {
    each = coarse ? static_cast<double>(random() % 5) : static_cast<double>(random() % 80000) / 7;
  }
  return x;
}

struct Case {
  Samples in{};
  Marks valid{};
  int N = 0;
};

template <typename Check>
void for_random_cases(unsigned invalid_in_ten, Check check) {
  std::mt19937_64 random(2008);
  for (int round = 0; round < 400; ++round) {
    Case each;
    each.in = random_samples(random, 1 + random() % 70);
    each.N = static_cast<int>(random() % 8);
    if (round % 40 == 0) each.N = 30 + static_cast<int>(random() % 20);
    for (std::size_t i = 0; i < each.in.size(); ++i) {
      each.valid.push_back(random() % 10 < invalid_in_ten ? 0 : 1);
    }
    check(each);
  }
}

TEST(Pseudomedian, IsBitExactToTheDefinition) {
  algo::FilterScratch scratch;
  for (const Border border : {Border::Replicate, Border::Reflect}) {
    for_random_cases(0, [&](const Case& each) {
      Samples out(each.in.size());
      algo::pseudomedian(each.in, each.N, border, scratch, out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        const auto w = window(each.in, each.valid, each.N, static_cast<std::ptrdiff_t>(i), border);
        ASSERT_EQ(out[i], pseudomedian_of(w, each.N))
            << "n " << out.size() << ", N " << each.N << ", sample " << i;
      }
    });
  }
}

TEST(Pseudomedian, IsBitExactToTheDefinitionWithInvalidSamples) {
  algo::FilterScratch scratch;
  for_random_cases(4, [&](const Case& each) {
    Samples out(each.in.size());
    Marks out_valid(each.in.size());
    algo::pseudomedian(each.in, each.valid, each.N, scratch, out, out_valid);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto w =
          window(each.in, each.valid, each.N, static_cast<std::ptrdiff_t>(i), Border::Replicate);
      ASSERT_EQ(out_valid[i] != 0, enough(w, each.N)) << "sample " << i;
      ASSERT_EQ(out[i], enough(w, each.N) ? pseudomedian_of(w, each.N) : each.in[i])
          << "n " << out.size() << ", N " << each.N << ", sample " << i;
    }
  });
}

/// Beyond 512 samples another method takes over.
TEST(Pseudomedian, IsBitExactForVeryWideWindows) {
  algo::FilterScratch scratch;
  std::mt19937_64 random(5);
  const Samples in = random_samples(random, 700);
  const Marks valid(in.size(), 1);
  Samples out(in.size());
  for (const int N : {511, 512, 600}) {
    algo::pseudomedian(in, N, Border::Replicate, scratch, out);
    for (const std::size_t i : {0U, 350U, 699U}) {
      const auto w = window(in, valid, N, static_cast<std::ptrdiff_t>(i), Border::Replicate);
      ASSERT_EQ(out[i], pseudomedian_of(w, N)) << "N " << N << ", sample " << i;
    }
  }
}

TEST(Median, IsTheMiddleOfTheWindow) {
  algo::FilterScratch scratch;
  for (const Border border : {Border::Replicate, Border::Reflect}) {
    for_random_cases(0, [&](const Case& each) {
      Samples out(each.in.size());
      algo::median(each.in, each.N, border, scratch, out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_EQ(
            out[i],
            median_of(window(each.in, each.valid, each.N, static_cast<std::ptrdiff_t>(i), border)));
      }
    });
  }
}

TEST(Median, LeavesInvalidSamplesOut) {
  algo::FilterScratch scratch;
  for_random_cases(4, [&](const Case& each) {
    Samples out(each.in.size());
    Marks out_valid(each.in.size());
    algo::median(each.in, each.valid, each.N, scratch, out, out_valid);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto w =
          window(each.in, each.valid, each.N, static_cast<std::ptrdiff_t>(i), Border::Replicate);
      ASSERT_EQ(out_valid[i] != 0, enough(w, each.N));
      ASSERT_EQ(out[i], enough(w, each.N) ? median_of(w) : each.in[i]);
    }
  });
}

/// L_N: the largest of the minima of all groups of N+1 neighbours that hold the sample.
Samples lower(const Samples& x, int N) {
  Samples out(x.size());
  const auto n = std::ssize(x);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double best = -1e300;
    for (std::ptrdiff_t first = i - N; first <= i; ++first) {
      double low = 1e300;
      for (std::ptrdiff_t k = first; k <= first + N; ++k) {
        low = std::min(low, x[static_cast<std::size_t>(at_border(k, n, Border::Replicate))]);
      }
      best = std::max(best, low);
    }
    out[static_cast<std::size_t>(i)] = best;
  }
  return out;
}

Samples negated(Samples x) {
  for (double& each : x) each = -each;
  return x;
}
Samples upper(const Samples& x, int N) {
  return negated(lower(negated(x), N));
}

/// The definition on a signal with 3N border samples, cut back to size.
Samples lulu_of(const Samples& x, int N) {
  const auto margin = static_cast<std::size_t>(3 * N);
  Samples padded(margin, x.front());
  padded.insert(padded.end(), x.begin(), x.end());
  padded.insert(padded.end(), margin, x.back());
  const Samples a = upper(lower(padded, N), N);
  const Samples b = lower(upper(padded, N), N);
  Samples out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = (a[i + margin] + b[i + margin]) / 2;
  return out;
}

TEST(Lulu, IsBitExactToTheDefinition) {
  algo::FilterScratch scratch;
  for_random_cases(0, [&](const Case& each) {
    Samples out(each.in.size());
    algo::lulu(each.in, each.N, Border::Replicate, scratch, out);
    ASSERT_EQ(out, lulu_of(each.in, each.N)) << "n " << out.size() << ", N " << each.N;
  });
}

TEST(Lulu, WithAllValidIsTheSame) {
  algo::FilterScratch scratch;
  for_random_cases(0, [&](const Case& each) {
    Samples plain(each.in.size());
    Samples masked(each.in.size());
    Marks out_valid(each.in.size());
    algo::lulu(each.in, each.N, Border::Replicate, scratch, plain);
    algo::lulu(each.in, each.valid, each.N, scratch, masked, out_valid);
    ASSERT_EQ(plain, masked);
  });
}

/// The value of an invalid sample must not reach any other sample.
TEST(Lulu, NeverReadsAnInvalidSample) {
  algo::FilterScratch scratch;
  for_random_cases(3, [&](const Case& each) {
    Samples other = each.in;
    for (std::size_t i = 0; i < other.size(); ++i) {
      if (each.valid[i] == 0) other[i] = 8190;
    }
    Samples out_a(each.in.size());
    Samples out_b(each.in.size());
    Marks valid_a(each.in.size());
    Marks valid_b(each.in.size());
    algo::lulu(each.in, each.valid, each.N, scratch, out_a, valid_a);
    algo::lulu(other, each.valid, each.N, scratch, out_b, valid_b);
    ASSERT_EQ(valid_a, valid_b);
    for (std::size_t i = 0; i < out_a.size(); ++i) {
      if (valid_a[i] != 0) {
        ASSERT_EQ(out_a[i], out_b[i]);
        ASSERT_LT(std::abs(out_a[i]), 1e6);
      }
    }
  });
}

/// equations.md A, the table "what it really does", for the pseudomedian and lulu.
TEST(Filters, ResponsesToASpikeAStepAndARamp) {
  algo::FilterScratch scratch;
  const auto filtered = [&](auto kernel, const Samples& in, int N) {
    Samples out(in.size());
    kernel(in, N, Border::Replicate, scratch, out);
    return out;
  };
  const auto pmed = [](auto&&... a) { algo::pseudomedian(a...); };
  const auto smooth = [](auto&&... a) { algo::lulu(a...); };
  const Samples spike = {1, 1, 1, 1, 9, 1, 1, 1, 1};
  for (const int N : {1, 2, 3}) {
    EXPECT_EQ(filtered(pmed, spike, N)[4], 5);  // half of the spike remains, for every N
    EXPECT_EQ(filtered(smooth, spike, N), Samples(9, 1.0));
    const Samples step = {1, 1, 1, 1, 1, 7, 7, 7, 7, 7};
    EXPECT_EQ(filtered(pmed, step, N), step);
    EXPECT_EQ(filtered(smooth, step, N), step);
    const Samples ramp = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    EXPECT_EQ(filtered(pmed, ramp, N), ramp);
    EXPECT_EQ(filtered(smooth, ramp, N), ramp);
  }
  const Samples wave = {1, 3, 1, 3, 1, 3, 1, 3, 1, 3};
  const Samples flat = filtered(pmed, wave, 1);
  for (std::size_t i = 1; i + 1 < wave.size(); ++i) EXPECT_EQ(flat[i], 2);  // the midrange
}

TEST(Filters, InvalidArgumentsAreRefused) {
  algo::FilterScratch scratch;
  const Samples in(5, 1.0);
  Samples out(5);
  Samples shorter(4);
  EXPECT_THROW(algo::pseudomedian(in, -1, Border::Replicate, scratch, out), std::invalid_argument);
  EXPECT_THROW(algo::median(in, 1, Border::Replicate, scratch, shorter), std::invalid_argument);
  Marks marks(5, 1);
  Marks fewer(4, 1);
  EXPECT_THROW(algo::lulu(in, fewer, 1, scratch, out, marks), std::invalid_argument);
}

TEST(Filters, OutputMayBeTheInput) {
  algo::FilterScratch scratch;
  for (const int N : {0, 1, 2, 5, 40}) {
    Samples x = {5, 1, 4, 9, 2, 6, 8, 3};
    Samples apart(x.size());
    algo::pseudomedian(x, N, Border::Replicate, scratch, apart);
    algo::pseudomedian(x, N, Border::Replicate, scratch, x);
    EXPECT_EQ(x, apart) << N;
  }
}

// ---- Scans ----

LaserScan scan_of(const Samples& ranges, double range_max = 8) {
  LaserScan scan;
  scan.range_max = range_max;
  scan.angle_increment = 0.01;
  scan.stamp = 4;
  scan.resize(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i] < range_max) {
      scan.set_ok(i, ranges[i]);
    } else {
      scan.set_free(i);
    }
  }
  return scan;
}

TEST(ScanFilter, FreeCountsAsRangeMaxAndStaysFree) {
  algo::ScanFilter filter;
  LaserScan out;
  // A return beside free beams: half of the way to range_max, (2 + 8) / 2.
  filter.apply(FilterKind::Pseudomedian, 1, scan_of({8, 8, 8, 2, 8, 8, 8}), out);
  EXPECT_EQ(out.status[3], Beam::Ok);
  EXPECT_EQ(out.ranges[3], 5);
  EXPECT_EQ(out.status[2], Beam::Free);
  EXPECT_EQ(out.ranges[2], 8);
  EXPECT_EQ(out.codes[2], BeamCode::BeyondRange);
  EXPECT_EQ(out.codes[3], BeamCode::None);
  EXPECT_EQ(out.stamp, 4);
}

TEST(ScanFilter, AnInvalidBeamNeverEntersAndKeepsItsValue) {
  algo::ScanFilter filter;
  for (const auto& info : algo::filter_table()) {
    LaserScan in = scan_of({3, 3, 3, 3, 3, 3, 3});
    in.set_invalid(3, BeamCode::Dazzled);
    in.ranges[3] = 8.19;  // a code read as a distance
    LaserScan out;
    filter.apply(info.kind, 1, in, out);
    for (std::size_t i = 0; i < in.size(); ++i) {
      EXPECT_EQ(out.status[i], i == 3 ? Beam::Invalid : Beam::Ok) << info.name;
      EXPECT_EQ(out.ranges[i], i == 3 ? 8.19 : 3.0) << info.name;
    }
    EXPECT_EQ(out.codes[3], BeamCode::Dazzled) << info.name;
  }
}

TEST(ScanFilter, ANonFiniteRangeBecomesInvalid) {
  algo::ScanFilter filter;
  for (const auto& info : algo::filter_table()) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      LaserScan in = scan_of({3, 3, 3, 3, 3, 3, 3});
      in.ranges[2] = bad;
      LaserScan out;
      filter.apply(info.kind, 2, in, out);
      EXPECT_EQ(out.status[2], Beam::Invalid) << info.name;
      EXPECT_EQ(out.codes[2], BeamCode::Unknown) << info.name;
      EXPECT_TRUE(std::isfinite(out.ranges[2])) << info.name;
      for (const std::size_t i : {0U, 1U, 3U, 4U}) EXPECT_EQ(out.ranges[i], 3) << info.name;
    }
  }
}

TEST(ScanFilter, WithoutAFiniteRangeMaxEveryBeamIsInvalid) {
  algo::ScanFilter filter;
  LaserScan in = scan_of({3, 3, 3, 8, 3});
  in.range_max = std::numeric_limits<double>::quiet_NaN();
  LaserScan out;
  filter.apply(FilterKind::Median, 1, in, out);
  for (const Beam status : out.status) EXPECT_EQ(status, Beam::Invalid);
}

TEST(ScanFilter, TooFewValidNeighboursMakeABeamInvalid) {
  algo::ScanFilter filter;
  LaserScan in = scan_of({3, 3, 3, 4, 3, 3, 3});
  in.set_invalid(2, BeamCode::NoEcho);
  in.set_invalid(4, BeamCode::NoEcho);
  LaserScan out;
  filter.apply(FilterKind::Pseudomedian, 1, in, out);  // 1 of 3 is valid, 2 are needed
  EXPECT_EQ(out.status[3], Beam::Invalid);
  EXPECT_EQ(out.ranges[3], 4);
  EXPECT_EQ(out.codes[3], BeamCode::Unknown);
}

TEST(ScanFilter, AnyLengthAndNoneAtAll) {
  algo::ScanFilter filter;
  LaserScan out;
  for (const auto& info : algo::filter_table()) {
    for (const std::size_t n : {0U, 1U, 2U, 5U, 360U, 361U, 720U}) {
      const LaserScan in = scan_of(Samples(n, 2.5));
      filter.apply(info.kind, 10, in, out);
      EXPECT_EQ(out.ranges, in.ranges) << info.name << ", " << n;
    }
  }
  LaserScan torn = scan_of({1, 2, 3});
  torn.status.pop_back();
  EXPECT_THROW(filter.apply(FilterKind::None, 1, torn, out), std::invalid_argument);
  EXPECT_THROW(filter.apply(FilterKind::None, -1, scan_of({1}), out), std::invalid_argument);
}

TEST(ScanFilter, HalfWidthZeroIsTheScanItself) {
  algo::ScanFilter filter;
  LaserScan out;
  const LaserScan in = scan_of({1, 7, 2, 8, 3});
  for (const auto& info : algo::filter_table()) {
    filter.apply(info.kind, 0, in, out);
    EXPECT_EQ(out.ranges, in.ranges);
    EXPECT_EQ(out.status, in.status);
  }
}

TEST(FilterTable, NamesAreFoundAndOthersAreNot) {
  for (const auto& info : algo::filter_table()) {
    EXPECT_EQ(algo::find_filter(info.name), info.kind);
    EXPECT_FALSE(info.help.empty());
  }
  EXPECT_EQ(algo::find_filter("pseudomedian"), FilterKind::Pseudomedian);
  EXPECT_EQ(algo::find_filter("Median"), std::nullopt);
}

}  // namespace
