// db/motion_finder.cpp: whole beams by trying, the rest by least squares.
#include "db/motion_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "db/residuals.hpp"

namespace db::detail {
namespace {

constexpr double kMillimetre = 1.0 / kFine;
constexpr std::int32_t kReach = 6;             // [beams] tried to either side of the last turn
constexpr std::int32_t kMargin = 4 * kReach;   // [cells] looked at beyond the view
constexpr std::size_t kTried = 8;              // every eighth sample is enough for whole beams
constexpr std::int32_t kMostDifference = 255;  // [mm] that one sample counts
// [mm] Beyond, a sample is left out of the first, second, third fit. The first must reach as far as
// a jagged wall changes in the beams by which a scanner may turn between even and odd ones.
constexpr std::array kErrors{300.0, 150.0, 60.0};
constexpr double kStiffness = 1000;    // holds a turn that nothing tells of
constexpr double kShiftStiffness = 5;  // the same for a shift
constexpr double kMostStep = 1.5;      // [beams] of one fit
constexpr double kMostShiftStep = 60;  // [mm]
constexpr double kLeastShift = 5;      // [mm] shorter ones wait: moving the map blurs it

/// Rounded down, without asking the library; for what is no farther from 0 than places may be.
std::int32_t below(double value) {
  constexpr std::int32_t kAway = 1 << 24;
  return static_cast<std::int32_t>(value + kAway) - kAway;
}

}  // namespace

void MotionFinder::take_samples(std::span<const std::byte> samples) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (lines_.size() != count) {
    lines_.resize(count);
    const double spacing =
        static_cast<double>(kKnots - 1) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
    for (std::size_t i = 0; i < count; ++i) {
      const double knots = static_cast<double>(i) * spacing;
      const std::size_t knot = std::min(static_cast<std::size_t>(knots), kKnots - 2);
      lines_[i] = {(i % 2) * kKnots + knot, knots - static_cast<double>(knot)};
    }
  }
  samples_.resize(count);
  for (std::size_t i = 0; i < count; ++i) samples_[i] = load<std::uint16_t>(samples, i);
}

void MotionFinder::take_cells(const RangeMap& map) {
  const Motion& last = map.motion();
  const std::int32_t middle = RangeMap::middle(last);
  const auto [least, most] = std::minmax({last.turns[0][0],
                                          last.turns[0][1],
                                          last.turns[0][2],
                                          last.turns[1][0],
                                          last.turns[1][1],
                                          last.turns[1][2]});
  first_cell_ = least / kFine - kMargin;
  // A view torn farther apart than that tells nothing.
  const std::int32_t spread = std::min((most - least) / kFine, 4 * kReach);
  cells_.resize(map.count() + static_cast<std::size_t>(spread + 2 * kMargin));
  ranges_.resize(cells_.size());
  const auto last_beam = static_cast<std::int32_t>(map.count()) + RangeMap::kMargin - 1;
  bool before = map.is_joined(first_cell_ - 1);
  bool here = map.is_joined(first_cell_);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::int32_t number = first_cell_ + static_cast<std::int32_t>(i);
    const bool after = map.is_joined(number + 1);
    Cell& cell = cells_[i];
    cell.range = map.range(number) * kMillimetre;
    ranges_[i] = map.range(number) / kFine;
    cell.usable = here;
    cell.step = map.range(number + 1) * kMillimetre - cell.range;
    cell.slope = before && after
                     ? (map.range(number + 2) - map.range(number - 1)) * (kMillimetre / 3)
                     : cell.step;
    const auto [c, s] = map.direction(std::clamp(number - middle, -RangeMap::kMargin, last_beam));
    const double across = cell.slope * map.parallax(cell.range);
    cell.shift = {-c - across * s, -s + across * c};
    before = here;
    here = after;
  }
}

/// Beyond the cells taken the outermost counts.
std::size_t MotionFinder::index(std::int32_t cell) const {
  const auto last = static_cast<std::int32_t>(cells_.size()) - 1;
  return static_cast<std::size_t>(std::clamp(cell - first_cell_, 0, last));
}

/// The turn of this parity changed by as many whole beams as fit best; near ones are tried first.
void MotionFinder::turn_whole_beams(std::size_t parity) {
  const double middle = found_[parity * kKnots + kKnots / 2];
  const auto about = static_cast<std::int32_t>(std::lround(middle));
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::int32_t best = 0;
  for (std::int32_t k = 0; k <= 2 * kReach; ++k) {
    const std::int32_t turn = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
    std::int64_t sum = 0;
    for (std::size_t i = parity; i < samples_.size(); i += kTried) {
      const std::int32_t there = ranges_[index(static_cast<std::int32_t>(i) + about + turn)];
      sum += std::min(std::abs(samples_[i] - there), kMostDifference);
    }
    if (sum >= least) continue;
    least = sum;
    best = turn;
  }
  for (std::size_t k = 0; k < kKnots; ++k) found_[parity * kKnots + k] += best;
}

/// One step of Gauss and Newton, without samples that are off by more than `most_error` [mm].
void MotionFinder::refine(double most_error) {
  std::array<Vector, kUnknowns> normal{};
  Vector right{};
  left_over_ = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto [knot, part] = lines_[i];
    const double at = static_cast<double>(i) + found_[knot] * (1 - part) + found_[knot + 1] * part;
    const std::int32_t number = below(at);
    const Cell& there = cells_[index(number)];
    const double error = samples_[i] - there.range - there.step * (at - number) * there.usable -
                         there.shift[0] * found_[kUnknowns - 2] -
                         there.shift[1] * found_[kUnknowns - 1];
    left_over_ += std::min<double>(std::abs(error), kMostDifference);
    if (!there.usable || std::abs(error) > most_error) continue;
    const std::array<double, 4> by{
        there.slope * (1 - part), there.slope * part, there.shift[0], there.shift[1]};
    const std::array<std::size_t, 4> of{knot, knot + 1, kUnknowns - 2, kUnknowns - 1};
    for (std::size_t a = 0; a < 4; ++a) {
      right[of[a]] += by[a] * error;
      for (std::size_t b = a; b < 4; ++b) normal[of[a]][of[b]] += by[a] * by[b];
    }
  }
  for (std::size_t a = 0; a < kUnknowns; ++a) {
    normal[a][a] += a < 2 * kKnots ? kStiffness : kShiftStiffness;
  }
  // Symmetric and positive: eliminated without pivots, in the upper triangle alone.
  for (std::size_t a = 0; a < kUnknowns; ++a) {
    for (std::size_t b = a + 1; b < kUnknowns; ++b) {
      const double factor = normal[a][b] / normal[a][a];
      for (std::size_t k = b; k < kUnknowns; ++k) normal[b][k] -= factor * normal[a][k];
      right[b] -= factor * right[a];
    }
  }
  for (std::size_t a = kUnknowns; a-- > 0;) {
    for (std::size_t k = a + 1; k < kUnknowns; ++k) right[a] -= normal[a][k] * right[k];
    right[a] /= normal[a][a];
    const double most = a < 2 * kKnots ? kMostStep : kMostShiftStep;
    found_[a] += std::clamp(right[a], -most, most);
  }
}

Motion MotionFinder::rounded() const {
  Motion motion{};
  for (std::size_t a = 0; a < 2 * kKnots; ++a) {
    motion.turns[a / kKnots][a % kKnots] =
        static_cast<std::int32_t>(std::lround(found_[a] * kFine));
  }
  const double ahead = found_[kUnknowns - 2];
  const double left = found_[kUnknowns - 1];
  if (ahead * ahead + left * left >= kLeastShift * kLeastShift) {
    motion.shift = {static_cast<std::int32_t>(std::lround(ahead)),
                    static_cast<std::int32_t>(std::lround(left))};
  }
  return motion;
}

std::optional<Motion> MotionFinder::find(const RangeMap& map, std::span<const std::byte> samples) {
  take_samples(samples);
  take_cells(map);
  for (std::size_t a = 0; a < 2 * kKnots; ++a) {
    found_[a] = static_cast<double>(map.motion().turns[a / kKnots][a % kKnots]) / kFine;
  }
  found_[kUnknowns - 2] = found_[kUnknowns - 1] = 0;
  for (std::size_t parity = 0; parity < 2; ++parity) turn_whole_beams(parity);
  for (const double most : kErrors) refine(most);
  const Motion motion = rounded();
  std::int64_t neighbours = 0;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    neighbours += std::min(std::abs(samples_[i] - samples_[i - 1]), kMostDifference);
  }
  if (!is_sane(motion) || static_cast<double>(neighbours) <= left_over_) return std::nullopt;
  return motion;
}

}  // namespace db::detail
