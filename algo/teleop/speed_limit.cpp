// algo/teleop/speed_limit.cpp: Eq. 1-4 of Park et al. 2005.
#include "algo/teleop/speed_limit.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

SparsenessStep sparseness_step(double sparseness,
                               std::span<const double> distances,
                               double v_max,
                               const Parameters& parameters) {
  const double gamma = parameters[kSparsenessFactor];
  SparsenessStep step;
  step.range = sparseness * parameters[kRingReach];
  step.speed = sparseness * v_max;
  const bool sparse = !distances.empty() && nearest_heard(distances, parameters) >= step.range;
  step.next = std::clamp(
      sparse ? sparseness / gamma : gamma * sparseness, parameters[kLeastSparseness], 1.0);
  return step;
}

double slowed_speed(double v_cmd,
                    double v_sprs,
                    std::span<const double> distances,
                    double v_max,
                    const Parameters& parameters) {
  if (!std::isfinite(v_cmd)) return 0;
  if (v_cmd <= 0) return std::max(v_cmd, -v_max);
  if (!(v_sprs > 0)) return 0;  // NaN too
  const double d_min = parameters[kStopDistance];
  const double room = std::max(nearest_heard(distances, parameters), d_min) - d_min;
  const double wanted = std::min({v_cmd, v_sprs, v_max});
  return wanted * (1 - std::exp(-parameters[kSlowingGain] * room));
}

}  // namespace algo
