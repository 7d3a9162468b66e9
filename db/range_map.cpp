// db/range_map.cpp: where a scan lies in the map, and how the map moves.
#include "db/range_map.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <numbers>

#include "db/residuals.hpp"

namespace db::detail {
namespace {

constexpr std::size_t kFewestPerHalfTurn = 32;  // below, the series for its sine is too short
constexpr std::size_t kMostPerHalfTurn = 1 << 16;
constexpr std::int32_t kNoRange = 65000 * kFine;  // [1/16 mm] above, samples are no distances

/// `from` to `to` on a line, for the samples of one parity in [first, last).
void draw_line(std::span<std::int32_t> places,
               std::size_t parity,
               std::array<std::size_t, 2> ends,
               std::array<std::int32_t, 2> turns) {
  constexpr int kBits = 20;
  const auto length = static_cast<std::int64_t>(std::max<std::size_t>(ends[1] - ends[0], 1));
  const std::int64_t step = (std::int64_t{turns[1] - turns[0]} << kBits) / length;
  const std::size_t first = ends[0] + ((ends[0] ^ parity) & 1U);
  for (std::size_t i = first; i < std::min(ends[1] + 1, places.size()); i += 2) {
    const auto along = static_cast<std::int64_t>(i - ends[0]) * step;
    places[i] =
        static_cast<std::int32_t>(i) * kFine + turns[0] + static_cast<std::int32_t>(along >> kBits);
  }
}

/// By how many cells a shift of `by` [mm] moves what is seen, and by how much nearer that comes. A
/// loop of its own, without branches, which g++ 12 vectorises at -O3.
void find_shifts(const std::int32_t* ranges,
                 const float* cosines,
                 const float* sines,
                 std::size_t cells,
                 std::array<float, 2> by,
                 float cells_per_radian,
                 std::int32_t* across,
                 std::int32_t* nearing) {
  constexpr float kNearest = 100 * kFine;  // [1/16 mm]
  const float scale = cells_per_radian * static_cast<float>(kFine * kFine);
  std::int32_t* __restrict to_side = across;
  std::int32_t* __restrict ahead = nearing;
  for (std::size_t k = 0; k < cells; ++k) {
    const auto range = static_cast<float>(ranges[k]);
    const float away = range > kNearest ? range : kNearest;
    to_side[k] = static_cast<std::int32_t>((by[1] * cosines[k] - by[0] * sines[k]) * scale / away);
    ahead[k] = static_cast<std::int32_t>((by[0] * cosines[k] + by[1] * sines[k]) * kFine);
  }
}

}  // namespace

bool is_sane(const Motion& motion) {
  const auto within = [](std::int32_t most) {
    return [most](std::int32_t value) { return value >= -most && value <= most; };
  };
  return std::ranges::all_of(motion.turns[0], within(kMostTurn)) &&
         std::ranges::all_of(motion.turns[1], within(kMostTurn)) &&
         std::ranges::all_of(motion.shift, within(kMostShift));
}

std::int32_t RangeMap::middle(const Motion& motion) {
  return (motion.turns[0][kKnots / 2] + motion.turns[1][kKnots / 2]) / (2 * kFine);
}

void RangeMap::restart(std::span<const std::byte> samples, std::size_t per_half_turn) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (!is_of(count, per_half_turn)) {
    count_ = count;
    per_half_turn_ = per_half_turn;
    // Twice the view: what has been turned out of it stays a while.
    const std::size_t cells = std::bit_ceil(2 * (count + kMargin));
    mask_ = static_cast<std::uint32_t>(cells - 1);
    ranges_.resize(cells);
    seen_.resize(cells);
    places_.resize(count);
    set_directions();
  }
  std::ranges::fill(ranges_, 0);
  std::ranges::fill(seen_, std::uint8_t{0});
  motion_ = {};
  for (std::size_t i = 0; i < count; ++i) {
    ranges_[i] = load<std::uint16_t>(samples, i) * kFine;
    seen_[i] = 1;
  }
  // How far the scanner turned between even and odd samples is not known yet, so that the odd ones
  // are filled in from the even ones wherever those, two beams apart, are of one surface.
  for (std::size_t i = 1; i + 1 < count; i += 2) {
    const std::int32_t step = ranges_[i + 1] - ranges_[i - 1];
    if (step <= 2 * kEdge && step >= -2 * kEdge) ranges_[i] = ranges_[i - 1] + step / 2;
  }
}

/// By turning step by step, as the library's sine may differ between machines.
void RangeMap::set_directions() {
  const bool known = per_half_turn_ >= kFewestPerHalfTurn && per_half_turn_ <= kMostPerHalfTurn;
  constexpr std::size_t kBeside = 2 * std::size_t{kMargin};
  cosines_.assign(count_ + kBeside, 0);
  sines_.assign(count_ + kBeside, 0);
  cells_per_radian_ = 0;
  if (!known) return;
  cells_per_radian_ = static_cast<double>(per_half_turn_) / std::numbers::pi;
  const double angle = std::numbers::pi / static_cast<double>(per_half_turn_);
  const double square = angle * angle;
  const double c = 1 - square / 2 * (1 - square / 12 * (1 - square / 30));
  const double s = angle * (1 - square / 6 * (1 - square / 20 * (1 - square / 42)));
  std::array<double, 2> ahead{1, 0};
  const std::size_t centre = count_ / 2 + kMargin;
  for (std::size_t off = 0; off <= centre; ++off) {
    cosines_[centre - off] = static_cast<float>(ahead[0]);
    sines_[centre - off] = -static_cast<float>(ahead[1]);
    if (centre + off < sines_.size()) {
      cosines_[centre + off] = static_cast<float>(ahead[0]);
      sines_[centre + off] = static_cast<float>(ahead[1]);
    }
    ahead = {ahead[0] * c - ahead[1] * s, ahead[0] * s + ahead[1] * c};
  }
}

MappedScan RangeMap::move(const Motion& motion) {
  if (motion.shift[0] != 0 || motion.shift[1] != 0) shift(motion.shift, middle(motion));
  aim(motion);
  motion_ = motion;
  return {ranges_.data(), seen_.data(), mask_, places_.data()};
}

void RangeMap::aim(const Motion& motion) {
  const std::size_t last = count_ - 1;
  for (std::size_t parity = 0; parity < 2; ++parity) {
    const auto& turns = motion.turns[parity];
    draw_line(places_, parity, {0, last / 2}, {turns[0], turns[1]});
    draw_line(places_, parity, {last / 2, last}, {turns[1], turns[2]});
  }
}

/// The cells in view as they look from a scanner displaced `by` [mm].
void RangeMap::shift(const std::array<std::int32_t, 2>& by, std::int32_t middle) {
  const std::size_t cells = count_ + 2 * std::size_t{kMargin};
  const std::int32_t first = middle - kMargin;
  moved_ranges_.resize(cells);
  moved_seen_.resize(cells);
  across_.resize(cells);
  nearing_.resize(cells);
  const std::int32_t* const ranges = ranges_.data();
  const std::uint8_t* const seen = seen_.data();
  std::int32_t* const moved_ranges = moved_ranges_.data();
  std::uint8_t* const moved_seen = moved_seen_.data();
  const std::uint32_t mask = mask_;
  for (std::size_t k = 0; k < cells; ++k) {
    moved_ranges[k] =
        ranges[static_cast<std::uint32_t>(first + static_cast<std::int32_t>(k)) & mask];
  }
  find_shifts(moved_ranges,
              cosines_.data(),
              sines_.data(),
              cells,
              {static_cast<float>(by[0]), static_cast<float>(by[1])},
              static_cast<float>(cells_per_radian_),
              across_.data(),
              nearing_.data());
  for (std::size_t k = 0; k < cells; ++k) {
    const std::int32_t cell = first + static_cast<std::int32_t>(k);
    const auto from = static_cast<std::uint32_t>((across_[k] >> 4) + cell);
    const std::int32_t part = across_[k] & (kFine - 1);
    const std::uint32_t a = from & mask;
    const std::uint32_t b = (from + 1) & mask;
    const std::uint32_t nearer = part < kFine / 2 ? a : b;
    const std::int32_t step = ranges[b] - ranges[a];
    const bool joined = step <= kEdge && step >= -kEdge && seen[a] != 0 && seen[b] != 0;
    const std::int32_t range = joined ? ranges[a] + ((step * part) >> 4) : ranges[nearer];
    moved_ranges[k] = range < kNoRange ? range - nearing_[k] : range;
    moved_seen[k] = seen[nearer];
  }
  for (std::size_t k = 0; k < cells; ++k) {
    const std::size_t cell = wrapped(first + static_cast<std::int32_t>(k));
    ranges_[cell] = moved_ranges[k];
    seen_[cell] = moved_seen[k];
  }
}

}  // namespace db::detail
