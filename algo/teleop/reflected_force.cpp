// algo/teleop/reflected_force.cpp: bands of the stick's two axes, and the force outside of them.
#include "algo/teleop/reflected_force.hpp"

#include <algorithm>
#include <cmath>

#include "algo/teleop/speed_limit.hpp"

namespace algo {
namespace {

constexpr double kTrackingHalfWidth = 100;  // W_DB about a position that the hand shall keep

/// The band about the position of `wanted`, a speed of at most `most`.
ForceBand band_about(double wanted, double most) {
  if (!std::isfinite(wanted) || !std::isfinite(most) || most <= 0) return {};
  return {.offset = std::clamp(kFullStick * wanted / most, -kFullStick, kFullStick),
          .half_width = kTrackingHalfWidth};
}

}  // namespace

ForceBand band_between(double w_lb, double w_ub, double w_max) {
  const bool sound = std::isfinite(w_lb) && std::isfinite(w_ub) && std::isfinite(w_max);
  if (!sound || w_max <= 0) return {};
  const double offset = kFullStick * (w_lb + w_ub) / 2 / w_max;
  const double half_width = kFullStick * (w_ub - w_lb) / 2 / w_max;
  return {.offset = std::clamp(offset, -kFullStick, kFullStick),
          .half_width = std::clamp(half_width, 0.0, kFullStick)};
}

ForwardForce forward_force(const Parameters& parameters) {
  return static_cast<ForwardForce>(parameters[kForwardForce]);
}

double forward_limit(double v_cmd,
                     double v_sprs,
                     std::span<const double> distances,
                     double v_max,
                     const Parameters& parameters,
                     ForwardForce reading) {
  if (reading == ForwardForce::Sparseness) return v_sprs;
  const double v = reading == ForwardForce::Executed ? v_cmd : v_max;
  return slowed_speed(v, v_sprs, distances, v_max, parameters);
}

ForceBand forward_band(double v_limit, double v_max) {
  return band_about(v_limit, v_max);
}

ForceBand wall_band(double w_d, double w_max) {
  return band_about(w_d, w_max);
}

double reflected_force(double q, const ForceBand& band, const ForceLevels& levels, double ramp) {
  if (!std::isfinite(q)) return 0;
  const double above = q - (band.offset + band.half_width);
  const double below = (band.offset - band.half_width) - q;
  const double rise = ramp * kFullStick;
  const auto share = [rise](double beyond) { return beyond < rise ? beyond / rise : 1.0; };
  if (above > 0) return -levels.above * share(above);
  if (below > 0) return levels.below * share(below);
  return 0;
}

}  // namespace algo
