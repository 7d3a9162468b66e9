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
// a jagged wall changes in the beams by which a scanner may turn between even and odd ones. Until
// the last, a few samples will do.
constexpr std::array<MotionFinder::Fit, 3> kFits{{{300, 8}, {150, 8}, {60, 2}}};
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

/// Where samples lie on their broken lines.
void MotionFinder::lay_lines(std::size_t count) {
  parts_.resize(count);
  const double spacing =
      static_cast<double>(kKnots - 1) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
  for (std::size_t parity = 0; parity < 2; ++parity) {
    std::size_t begin = parity;
    for (std::size_t knot = 0; knot + 1 < kKnots; ++knot) {
      const bool is_last = knot + 2 == kKnots;
      std::size_t i = begin;
      for (; i < count; i += 2) {
        const double part = static_cast<double>(i) * spacing - static_cast<double>(knot);
        if (part >= 1 && !is_last) break;
        parts_[i] = part;
      }
      stretches_[parity * (kKnots - 1) + knot] = {parity * kKnots + knot, begin, i};
      begin = i;
    }
  }
}

void MotionFinder::take_samples(std::span<const std::byte> samples) {
  const std::size_t count = samples.size() / sizeof(std::uint16_t);
  if (parts_.size() != count) lay_lines(count);
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
    for (std::size_t i = parity; i < samples_.size() && sum < least; i += kTried) {
      const std::int32_t there = ranges_[index(static_cast<std::int32_t>(i) + about + turn)];
      sum += std::min(std::abs(samples_[i] - there), kMostDifference);
    }
    if (sum >= least) continue;
    least = sum;
    best = turn;
  }
  for (std::size_t k = 0; k < kKnots; ++k) found_[parity * kKnots + k] += best;
}

/// What the samples of one stretch tell of the turns at its two knots and of the shift.
MotionFinder::Sums MotionFinder::sum_up(const Stretch& stretch, const Fit& fit) const {
  const double turn = found_[stretch.knot];
  const double turn_change = found_[stretch.knot + 1] - turn;
  const double ahead = found_[kUnknowns - 2];
  const double left = found_[kUnknowns - 1];
  double here_here = 0, here_next = 0, here_x = 0, here_y = 0, next_next = 0, next_x = 0,
         next_y = 0, x_x = 0, x_y = 0, y_y = 0;
  double here_error = 0, next_error = 0, x_error = 0, y_error = 0, left_over = 0;
  for (std::size_t i = stretch.begin; i < stretch.end; i += fit.step) {
    const double part = parts_[i];
    const double at = static_cast<double>(i) + turn + turn_change * part;
    const std::int32_t number = below(at);
    const Cell& there = cells_[index(number)];
    const double error = samples_[i] - there.range - there.step * (at - number) * there.usable -
                         there.shift[0] * ahead - there.shift[1] * left;
    left_over += std::min<double>(std::abs(error), kMostDifference);
    const bool counts = there.usable && std::abs(error) <= fit.most_error;
    const double weight = counts ? 1 : 0;
    // What one beam more at either knot, and one millimetre of shift, would change: each by name,
    // since an array of four costs g++ a stall a sample.
    const double here = there.slope * (1 - part) * weight;
    const double next = there.slope * part * weight;
    const double x = there.shift[0] * weight;
    const double y = there.shift[1] * weight;
    here_here += here * here;
    here_next += here * next;
    here_x += here * x;
    here_y += here * y;
    next_next += next * next;
    next_x += next * x;
    next_y += next * y;
    x_x += x * x;
    x_y += x * y;
    y_y += y * y;
    here_error += here * error;
    next_error += next * error;
    x_error += x * error;
    y_error += y * error;
  }
  return {{{{here_here, here_next, here_x, here_y},
            {0, next_next, next_x, next_y},
            {0, 0, x_x, x_y},
            {0, 0, 0, y_y}}},
          {here_error, next_error, x_error, y_error},
          left_over};
}

/// One step of Gauss and Newton.
void MotionFinder::refine(const Fit& fit) {
  std::array<Vector, kUnknowns> normal{};
  Vector right{};
  left_over_ = 0;
  for (const Stretch& stretch : stretches_) {
    const Sums sums = sum_up(stretch, fit);
    const std::array<std::size_t, 4> of{
        stretch.knot, stretch.knot + 1, kUnknowns - 2, kUnknowns - 1};
    left_over_ += sums.left_over;
    for (std::size_t a = 0; a < 4; ++a) {
      right[of[a]] += sums.right[a];
      for (std::size_t b = a; b < 4; ++b) normal[of[a]][of[b]] += sums.normal[a][b];
    }
  }
  for (std::size_t a = 0; a < kUnknowns; ++a) {
    normal[a][a] += a < 2 * kKnots ? kStiffness : kShiftStiffness;
  }
  // Symmetric and positive: eliminated without pivots, in the upper triangle alone.
  for (std::size_t a = 0; a < kUnknowns; ++a) {
    const double per_pivot = 1 / normal[a][a];
    for (std::size_t b = a + 1; b < kUnknowns; ++b) {
      const double factor = normal[a][b] * per_pivot;
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
  for (const Fit& fit : kFits) refine(fit);
  const Motion motion = rounded();
  std::int64_t neighbours = 0;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    neighbours += std::min(std::abs(samples_[i] - samples_[i - 1]), kMostDifference);
  }
  if (!is_sane(motion) || static_cast<double>(neighbours) <= left_over_) return std::nullopt;
  return motion;
}

}  // namespace db::detail
