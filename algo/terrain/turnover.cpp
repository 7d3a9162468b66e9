// algo/terrain/turnover.cpp: Eq. 20-26, and the rule along the track.
#include "algo/terrain/turnover.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace algo {
namespace {

constexpr double kStanding = 1e-6;  // [m/s] slower than this turns on the spot

}  // namespace

GravityShares gravity_shares(const Attitude& attitude) {
  return {-std::sin(attitude.pitch),
          std::sin(attitude.roll) * std::cos(attitude.pitch),
          std::cos(attitude.roll) * std::cos(attitude.pitch)};
}

SidewaysRange sideways_range(const Attitude& attitude, const Stance& stance) {
  const GravityShares k = gravity_shares(attitude);
  const double held = k.z * stance.width / (2 * stance.mass_height);
  return {-kGravity * (k.y + held), -kGravity * (k.y - held)};
}

double speed_change(double v, double a, double distance) {
  return -v + std::sqrt(std::max(0.0, v * v + 2 * a * distance));
}

TurnRange turn_range(const SidewaysRange& sideways, double v, double v_max, double w_max) {
  TurnRange out{.must_turn = sideways.min > 0 || sideways.max < 0};
  if (std::abs(v) < kStanding) {
    out.min = -w_max;
    out.max = w_max;
    return out;
  }
  const double most = v_max * w_max;
  double low = std::clamp(sideways.min, -most, most) / v;
  double high = std::clamp(sideways.max, -most, most) / v;
  if (v < 0) std::swap(low, high);
  out.min = std::clamp(low, -w_max, w_max);
  out.max = std::clamp(high, -w_max, w_max);
  return out;
}

double along_limit(const Attitude& attitude, const Stance& stance, double share) {
  const GravityShares k = gravity_shares(attitude);
  return share * kGravity * (k.z * stance.length / (2 * stance.mass_height) - std::abs(k.x));
}

double standing_margin(const Attitude& attitude, const Stance& stance) {
  const GravityShares k = gravity_shares(attitude);
  const auto left_of = [&](double base, double off) {
    return std::atan2(base, 2 * stance.mass_height) - std::atan2(std::abs(off), k.z);
  };
  return std::min(left_of(stance.width, k.y), left_of(stance.length, k.x));
}

}  // namespace algo
