// db/turned_scan.cpp: straight loops without branches, which g++ 12 vectorises at -O3.
#include "db/turned_scan.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

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

}  // namespace db::detail
