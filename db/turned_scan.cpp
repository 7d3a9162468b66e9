// db/turned_scan.cpp: straight loops without branches, which g++ 12 vectorises at -O3.
#include "db/turned_scan.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

// Where the loader can choose, each is compiled for plain x86-64 and for wider vectors.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TAUTLINE_WIDE __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define TAUTLINE_WIDE
#endif

namespace db::detail {
namespace {

constexpr int kEdge = 300;  // [mm] neighbours farther apart lie on different surfaces
constexpr std::size_t kMargin = kFarthest + 1;

// Little-endian on every machine the program runs on.
static_assert(std::endian::native == std::endian::little);

/// `part` quarters of the way from every sample to its right neighbour; there is one more of them.
TAUTLINE_WIDE void move_on(const std::uint16_t* samples,
                           std::size_t count,
                           int part,
                           std::uint16_t* out) {
  std::uint16_t* __restrict to = out;
  if (part == 0) {
    std::memcpy(to, samples, count * sizeof(std::uint16_t));
    return;
  }
  const int lean = part < kQuarters / 2 ? 0 : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const int a = samples[i];
    const int step = samples[i + 1] - a;
    const int size = step < 0 ? -step : step;
    const int across = lean * step;  // on either side of an edge, but never between
    const int along = (step * part) >> 2;
    to[i] = static_cast<std::uint16_t>(a + (size > kEdge ? across : along));
  }
}

/// How much samples differ, each by 255 at most, those of even and of odd number.
TAUTLINE_WIDE void compare(const std::uint16_t* a,
                           const std::uint16_t* b,
                           std::size_t count,
                           std::uint8_t* scratch,
                           std::uint32_t* sums) {
  std::uint8_t* __restrict differences = scratch;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t more = a[i] > b[i] ? a[i] : b[i];
    const std::uint16_t less = a[i] > b[i] ? b[i] : a[i];
    const auto size = static_cast<std::uint16_t>(more - less);
    differences[i] = static_cast<std::uint8_t>(size < 255 ? size : 255);
  }
  std::uint32_t even = 0;
  std::uint32_t odd = 0;
  for (std::size_t i = 0; i + 1 < count; i += 2) {
    even += differences[i];
    odd += differences[i + 1];
  }
  if (count % 2 == 1) even += differences[count - 1];
  sums[0] = even;
  sums[1] = odd;
}

}  // namespace

void TurnedScan::set_reference(std::span<const std::byte> samples) {
  count_ = samples.size() / sizeof(std::uint16_t);
  reference_.resize(count_ + 2 * kMargin);
  if (count_ == 0) return;
  std::memcpy(reference_.data() + kMargin, samples.data(), samples.size());
  std::fill_n(reference_.begin(), kMargin, reference_[kMargin]);
  std::fill_n(reference_.end() - kMargin, kMargin, reference_[kMargin + count_ - 1]);
}

/// The reference as it lies after `turn`, without its margins.
void TurnedScan::move_reference(std::uint8_t turn, std::vector<std::uint16_t>& out) const {
  const int quarters = turn - kNotTurned;
  const int beams = quarters >> 2;  // rounds down, also below 0
  out.resize(count_);
  move_on(reference_.data() + static_cast<std::ptrdiff_t>(kMargin) + beams,
          count_,
          quarters - kQuarters * beams,
          out.data());
}

std::span<const std::uint16_t> TurnedScan::expect(const Turn& turn) {
  move_reference(turn[0], expected_);
  if (turn[1] == turn[0]) return expected_;
  move_reference(turn[1], moved_);
  for (std::size_t i = 1; i < count_; i += 2) expected_[i] = moved_[i];
  return expected_;
}

void TurnedScan::try_turn(int turn) {
  if (turn < 0 || turn > kMostTurned) return;
  std::array<std::uint32_t, 2> sums{};
  move_reference(static_cast<std::uint8_t>(turn), moved_);
  compare(scan_.data(), moved_.data(), count_, differences_.data(), sums.data());
  for (std::size_t parity = 0; parity < 2; ++parity) {
    if (sums[parity] >= least_[parity]) continue;
    least_[parity] = sums[parity];
    best_[parity] = static_cast<std::uint8_t>(turn);
  }
}

/// Tries turns `off` quarters to either side of the best of each parity.
void TurnedScan::refine(int off) {
  const Turn about = best_;
  for (std::size_t parity = 0; parity < (about[0] == about[1] ? 1U : 2U); ++parity) {
    try_turn(about[parity] - off);
    try_turn(about[parity] + off);
  }
}

std::optional<Turn> TurnedScan::find(std::span<const std::byte> samples) {
  scan_.resize(count_);
  differences_.resize(count_);
  if (count_ > 0) std::memcpy(scan_.data(), samples.data(), count_ * sizeof(std::uint16_t));
  best_ = {kNotTurned, kNotTurned};
  least_.fill(std::numeric_limits<std::uint32_t>::max());
  try_turn(kNotTurned);  // first: it wins where others are as good
  for (int turn = 0; turn <= kMostTurned; turn += kQuarters) try_turn(turn);
  refine(2);
  refine(1);
  std::array<std::uint32_t, 2> sums{};
  if (count_ > 1) {
    compare(scan_.data(), scan_.data() + 1, count_ - 1, differences_.data(), sums.data());
  }
  if (sums[0] + sums[1] <= least_[0] + least_[1]) return std::nullopt;
  return best_;
}

}  // namespace db::detail
