// algo/laser_scan.cpp: functions on whole scans, written so that they vectorise.
#include "algo/laser_scan.hpp"

#include <algorithm>
#include <cstring>

#include "algo/wide.hpp"

namespace algo {
namespace {

/// Packs all ranges as distances. The sum leaves no bits for a fraction; the clamps turn NaN into
/// 0. Converts by way of 32 bits, since vectors have that conversion.
TAUTLINE_WIDE void pack_ranges(const double* ranges,
                               std::size_t count,
                               std::uint16_t* __restrict out) {
  constexpr double kNoFraction = 0x1p52;
  constexpr double kMax = kPackedMaxRange;
  for (std::size_t i = 0; i < count; ++i) {
    const double mm = ranges[i] * 1000.0;
    const double positive = mm > 0 ? mm : 0;
    const double clipped = positive < kMax ? positive : kMax;
    const auto whole = static_cast<std::int32_t>((clipped + kNoFraction) - kNoFraction);
    out[i] = static_cast<std::uint16_t>(whole);
  }
}

}  // namespace

const std::vector<Vec2>& BeamDirections::of(const LaserScan& scan, double heading) {
  const bool same = directions_.size() == scan.size() && angle_min_ == scan.angle_min &&
                    angle_increment_ == scan.angle_increment && heading_ == heading;
  if (same) return directions_;
  angle_min_ = scan.angle_min;
  angle_increment_ = scan.angle_increment;
  heading_ = heading;
  directions_.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    directions_[i] = direction(heading + scan.angle(i));
  }
  return directions_;
}

/// x - x is 0 for a finite number and NaN otherwise; Eigen vectorises the sum.
bool all_finite(std::span<const double> numbers) {
  const Eigen::Map<const Eigen::ArrayXd> x(numbers.data(),
                                           static_cast<Eigen::Index>(numbers.size()));
  return (x - x).sum() == 0;
}

void pack_beams(const LaserScan& scan, std::span<std::uint16_t> out) {
  pack_ranges(scan.ranges.data(), scan.size(), out.data());
  // Beams without a distance come in stretches, so eight are checked together.
  constexpr std::size_t kTogether = sizeof(std::uint64_t);
  std::size_t first = 0;
  for (; first + kTogether <= scan.size(); first += kTogether) {
    std::uint64_t together = 0;
    std::memcpy(&together, scan.status.data() + first, kTogether);
    static_assert(static_cast<int>(Beam::Ok) == 0);
    static_assert(static_cast<int>(Beam::Free) == 1);
    constexpr std::uint64_t kAllFree = 0x0101010101010101;
    if (together == kAllFree) {
      std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(first), kTogether, kPackedFree);
    } else if (together != 0) {
      for (std::size_t i = first; i < first + kTogether; ++i) out[i] = pack_beam(scan, i);
    }
  }
  for (; first < scan.size(); ++first) out[first] = pack_beam(scan, first);
}

}  // namespace algo
