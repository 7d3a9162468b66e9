// algo/terrain/ground_trials.cpp: the vote and the values of its winner.
#include "algo/terrain/ground_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/terrain/ground_value.hpp"

namespace algo {

void GroundTrials::restart() {
  count_ = 0;
  in_trench_ = false;
  open_end_ = false;
  trench_seen_ = false;
  trench_looks_ = 0;
}

void GroundTrials::add(const GroundLook& look, double way, double widest) {
  if (done()) return;
  const bool trench = look.kind == GroundClass::Trench;
  if (trench && (!trench_seen_ || in_trench_)) {
    if (!trench_seen_) trench_from_ = way;
    trench_seen_ = true;
    trench_to_ = way;
    ++trench_looks_;
  }
  if (count_ < kGroundTrials) {
    trials_[count_++] = {look.kind, look.far, look.near, way};
    in_trench_ = trench;
  } else {
    in_trench_ = look.near_off;
  }
  if (in_trench_ && count_ == kGroundTrials && way - trench_from_ > widest) {
    in_trench_ = false;
    open_end_ = true;
  }
}

double GroundTrials::mean_or_median_height(GroundClass kind) const {
  std::array<double, kGroundTrials> heights{};
  std::size_t n = 0;
  double sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (trials_[i].kind != kind) continue;
    heights[n] = ground_height(trials_[i].near, flat_.near, sensors_.angle);
    sum += heights[n++];
  }
  if (n == 0) return 0;
  if (kind == GroundClass::Trench) return sum / static_cast<double>(n);
  return descending_median(std::span(heights.data(), n), MedianRank::Corrected);
}

/// Eq. 14 sees what the beam has ahead of it; the way over the trench is all of it (ours). A look
/// counts until the rest is below the threshold, and stands for half a step to either side.
double GroundTrials::width() const {
  if (open_end_) return std::numeric_limits<double>::infinity();
  const double seen = trench_to_ - trench_from_;
  const double step = trench_looks_ > 1 ? seen / (trench_looks_ - 1) : 0;
  return seen + step + GroundThresholds{}.near * std::cos(sensors_.angle);
}

/// While the near beam climbs the riser of a high step, and the far one is on top, the table says
/// slope up. On a riser X2 falls by 1 / cos(alpha) along the way; on a slope of 30 degrees by half.
bool GroundTrials::up_a_riser() const {
  constexpr double kSteep = 0.8;
  double n = 0, ways = 0, nears = 0, squares = 0, products = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Trial& t = trials_[i];
    if (t.kind != GroundClass::SlopeUp) continue;
    n += 1;
    ways += t.way;
    nears += t.near;
    squares += t.way * t.way;
    products += t.way * t.near;
  }
  const double spread = n * squares - ways * ways;
  return spread > 0 && n * products - ways * nears < -kSteep * spread;
}

/// A step as high as its top, or unknown ground if the beam has not come to the top.
GroundFinding GroundTrials::riser(double confidence) const {
  GroundFinding out{.kind = GroundClass::StepUp, .confidence = confidence};
  if (trials_[count_ - 1].kind == GroundClass::SlopeUp) out.kind = GroundClass::Unknown;
  for (std::size_t i = 0; i < count_; ++i) {
    const double height = ground_height(trials_[i].near, flat_.near, sensors_.angle);
    out.height = std::max(out.height, height);
  }
  return out;
}

GroundFinding GroundTrials::finding() const {
  ClassVote vote;
  for (std::size_t i = 0; i < count_; ++i) vote.add(trials_[i].kind);
  GroundFinding out{.kind = count_ == 0 ? GroundClass::Flat : vote.winner()};
  if (count_ == 0) return out;
  const auto votes = static_cast<double>(vote.count(out.kind));
  out.confidence = votes / static_cast<double>(count_);
  switch (out.kind) {
    case GroundClass::StepUp:
    case GroundClass::StepDown:
      out.height = mean_or_median_height(out.kind);
      break;
    case GroundClass::Trench: {
      out.height = mean_or_median_height(out.kind);
      out.width = width();
      break;
    }
    case GroundClass::SlopeUp:
      if (up_a_riser()) return riser(out.confidence);
      [[fallthrough]];
    case GroundClass::SlopeDown: {
      double sum = 0;
      for (std::size_t i = 0; i < count_; ++i) {
        const Trial& t = trials_[i];
        if (t.kind != out.kind) continue;
        sum += ground_slope(t.far, t.near, sensors_.separation, sensors_.angle);
      }
      out.slope = sum / votes;
      break;
    }
    default:
      break;
  }
  return out;
}

}  // namespace algo
