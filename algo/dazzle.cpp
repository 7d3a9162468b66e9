// algo/dazzle.cpp: finds beams without a measurement, and the space that they hide.
#include "algo/dazzle.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

/// True if beam `i` did not measure.
bool unknown(const LaserScan& scan, std::size_t i) {
  if (scan.status[i] != Beam::Invalid) return false;
  return scan.codes[i] != BeamCode::NoEcho && scan.codes[i] != BeamCode::WeakSignal;
}

/// The widest run of neighbours that contains kLeastCone or more beams for which `counts` holds.
/// Free beams do not end a run: between dazzled ones they tell no more.
template <class Counts>
BeamSpan widest_run(const LaserScan& scan, Counts&& counts) {
  BeamSpan widest;
  BeamSpan run;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (counts(i)) {
      if (counted++ == 0) run.begin = i;
      run.end = i + 1;
    } else if (scan.status[i] != Beam::Invalid) {
      counted = 0;
    }
    const bool wider = run.end - run.begin > widest.end - widest.begin;
    if (counted >= kLeastCone && wider) widest = run;
  }
  return widest;
}

}  // namespace

BeamSpan widest_cone(const LaserScan& scan) {
  return widest_run(scan, [&scan](std::size_t i) { return unknown(scan, i); });
}

bool hidden(const LaserScan& scan, const RobotSpec& spec) {
  constexpr double kBeside = 0.05;  // [m] beside the hull
  constexpr double kBefore = 0.1;   // [m] before it, where an obstacle can still be hit
  if (std::ranges::find(scan.status, Beam::Invalid) == scan.status.end()) return false;
  const bool rectangle = spec.half_length > 0;
  const double front = rectangle ? spec.half_length : spec.radius;
  const double half = (rectangle ? spec.half_width : spec.radius) + kBeside;
  const double ahead = std::max(front + kBefore - scan.mount_R.x, kBefore);
  const BeamSpan cone = widest_run(scan, [&](std::size_t i) {
    if (!unknown(scan, i)) return false;
    const Vec2 beam = direction(scan.mount_R.heading + scan.angle(i));
    // The lateral offset at `ahead` is y + ahead tan(bearing); here multiplied by the cosine.
    const double beside = scan.mount_R.y * beam.x() + ahead * beam.y();
    return beam.x() > 0 && std::abs(beside) <= half * beam.x();
  });
  return cone.end > cone.begin;
}

}  // namespace algo
