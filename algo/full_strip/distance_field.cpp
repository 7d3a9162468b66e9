// algo/full_strip/distance_field.cpp: stamps a kernel where a cell becomes occupied, and rebuilds a
// tile by a distance transform where one becomes free.
#include "algo/full_strip/distance_field.hpp"

#include <algorithm>
#include <cmath>

#include "algo/wide.hpp"

namespace algo {
namespace {

constexpr auto kFar = static_cast<std::int16_t>(DistanceField::kReach * 1000);  // [mm]
constexpr std::int16_t kNoSquare = 10'000;  // square of a distance beyond kReach

/// Lets the gaps of a row's columns grow by a cell, up to `most`; an occupied cell closes its own.
TAUTLINE_WIDE void grow_gaps(const std::uint8_t* hits,
                             std::uint8_t occupied,
                             std::uint8_t most,
                             std::size_t columns,
                             std::uint8_t* __restrict gaps) {
  for (std::size_t x = 0; x < columns; ++x) {
    const auto more = static_cast<std::uint8_t>(gaps[x] + 1);
    gaps[x] = hits[x] >= occupied ? std::uint8_t{0} : std::min(more, most);
  }
}

/// Squares of gaps; kNoSquare for those beyond `radius`. False if all are.
TAUTLINE_WIDE bool square_gaps(const std::uint8_t* gaps,
                               std::uint8_t radius,
                               std::size_t count,
                               std::int16_t* __restrict squares) {
  for (std::size_t x = 0; x < count; ++x) {
    const std::int16_t gap = gaps[x];
    const auto square = static_cast<std::int16_t>(gap * gap);
    squares[x] = gap > radius ? kNoSquare : square;
  }
  std::int16_t least = kNoSquare;
  for (std::size_t x = 0; x < count; ++x) least = std::min(least, squares[x]);
  return least < kNoSquare;
}

/// The least square of the distances from each cell of a tile's row to the occupied cells in the
/// columns up to `radius` aside. `squares` has those of the columns, the first one `radius` before
/// the first cell.
TAUTLINE_WIDE void least_squares(const std::int16_t* squares,
                                 int radius,
                                 std::array<std::int16_t, DistanceField::kTile>& out) {
  std::array<std::int16_t, DistanceField::kTile> best;
  best.fill(kNoSquare);
  for (int aside = -radius; aside <= radius; ++aside, ++squares) {
    const auto more = static_cast<std::int16_t>(aside * aside);
    for (std::size_t x = 0; x < best.size(); ++x) {
      best[x] = std::min(best[x], static_cast<std::int16_t>(squares[x] + more));
    }
  }
  out = best;
}

}  // namespace

DistanceField::DistanceField()
    : field_(static_cast<std::size_t>(kSize) * kSize, kFar),
      kernel_(kWidth * kWidth),
      reaches_(kRadius + 1, -1),
      metric_(2 * kRadius * kRadius + 1),
      soiled_(static_cast<std::size_t>(kTiles) * kTiles) {
  tiles_.reserve(soiled_.size() + 1);
  for (std::size_t square = 0; square < metric_.size(); ++square) {
    const double mm = std::sqrt(static_cast<double>(square)) * kCell * 1000;
    metric_[square] = static_cast<std::int16_t>(std::min<double>(std::nearbyint(mm), kFar));
  }
  std::size_t cell = 0;
  for (int y = -kRadius; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x, ++cell) {
      const int square = x * x + y * y;
      kernel_[cell] = metric_[static_cast<std::size_t>(square)];
      // Rows far from the middle are short: nothing beyond kReach is lowered.
      if (y >= 0 && kernel_[cell] < kFar) reaches_[static_cast<std::size_t>(y)] = x;
    }
  }
}

void DistanceField::reset() {
  std::ranges::fill(field_, kFar);
  std::ranges::fill(soiled_, std::uint8_t{0});
  tiles_.clear();
}

void DistanceField::occupy(int column, int row) {
  const int y0 = std::max(0, row - kRadius);
  const int y1 = std::min(kSize, row + kRadius + 1);
  for (int y = y0; y < y1; ++y) {
    const int reach = reaches_[static_cast<std::size_t>(std::abs(y - row))];
    const int x0 = std::max(0, column - reach);
    const int x1 = std::min(kSize, column + reach + 1);
    const int middle = (y - row + kRadius) * static_cast<int>(kWidth) + kRadius;
    const std::int16_t* const near = &kernel_[static_cast<std::size_t>(middle + x0 - column)];
    std::int16_t* const to = &field_[index(x0, y)];
    for (int x = 0; x < x1 - x0; ++x) to[x] = std::min(to[x], near[x]);
  }
}

void DistanceField::free(int column, int row) {
  const int x0 = std::max(0, column - kRadius) / kTile;
  const int x1 = std::min(kSize - 1, column + kRadius) / kTile;
  const int y0 = std::max(0, row - kRadius) / kTile;
  const int y1 = std::min(kSize - 1, row + kRadius) / kTile;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const auto tile = static_cast<std::size_t>(y) * kTiles + static_cast<std::size_t>(x);
      if (soiled_[tile] != 0) continue;
      soiled_[tile] = 1;
      tiles_.push_back(static_cast<std::uint16_t>(tile));
    }
  }
}

std::span<const std::uint16_t> DistanceField::rebuild(std::span<const std::uint8_t> hits,
                                                      std::uint8_t occupied) {
  const std::size_t now = std::min(kTilesATick, tiles_.size());
  for (std::size_t k = 0; k < now; ++k) {
    soiled_[tiles_[k]] = 0;
    const int left = tiles_[k] % kTiles * kTile;
    const int bottom = tiles_[k] / kTiles * kTile;
    measure_gaps(hits, occupied, left, bottom);
    rebuild_tile(left, bottom);
    rebuilt_[k] = tiles_[k];
  }
  tiles_.erase(tiles_.begin(), tiles_.begin() + static_cast<std::ptrdiff_t>(now));
  return std::span(rebuilt_).first(now);
}

/// First half of a distance transform: along the columns, once upwards and once downwards.
void DistanceField::measure_gaps(std::span<const std::uint8_t> hits,
                                 std::uint8_t occupied,
                                 int left,
                                 int bottom) {
  constexpr std::uint8_t kNone = kRadius + 1;
  const int first = std::max(0, left - kRadius);
  const auto columns = static_cast<std::size_t>(std::min(kSize, left + kTile + kRadius) - first);
  const auto skipped = static_cast<std::size_t>(first - (left - kRadius));
  std::array<std::uint8_t, kSpan> gap;
  const auto pass = [&](int row) {
    grow_gaps(&hits[index(first, row)], occupied, kNone, columns, &gap[skipped]);
  };
  gap.fill(kNone);
  for (int y = std::max(0, bottom - kRadius); y < bottom + kTile; ++y) {
    pass(y);
    if (y >= bottom) gaps_[static_cast<std::size_t>(y - bottom)] = gap;
  }
  gap.fill(kNone);
  for (int y = std::min(kSize, bottom + kTile + kRadius) - 1; y >= bottom; --y) {
    pass(y);
    if (y >= bottom + kTile) continue;
    auto& best = gaps_[static_cast<std::size_t>(y - bottom)];
    for (std::size_t x = 0; x < kSpan; ++x) best[x] = std::min(best[x], gap[x]);
  }
}

/// Second half: along the rows, over all candidates for the nearest.
void DistanceField::rebuild_tile(int left, int bottom) {
  for (int y = 0; y < kTile; ++y) {
    const auto& gaps = gaps_[static_cast<std::size_t>(y)];
    std::array<std::int16_t, kSpan> squares;
    std::int16_t* const to = &field_[index(left, bottom + y)];
    if (!square_gaps(gaps.data(), kRadius, kSpan, squares.data())) {
      std::fill_n(to, kTile, kFar);
      continue;
    }
    std::array<std::int16_t, kTile> best;
    least_squares(squares.data(), kRadius, best);
    for (std::size_t x = 0; x < kTile; ++x) {
      const auto square = static_cast<std::size_t>(best[x]);
      to[x] = square < metric_.size() ? metric_[square] : kFar;
    }
  }
}

void DistanceField::shift(int tile_columns, int tile_rows) {
  move_cells(field_, kSize, tile_columns * kTile, tile_rows * kTile, kFar);
  move_cells(soiled_, kTiles, tile_columns, tile_rows, std::uint8_t{0});
  tiles_.clear();
  for (std::size_t tile = 0; tile < soiled_.size(); ++tile) {
    if (soiled_[tile] != 0) tiles_.push_back(static_cast<std::uint16_t>(tile));
  }
}

}  // namespace algo
