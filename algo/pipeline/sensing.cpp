// algo/pipeline/sensing.cpp: filter, then merge.
#include "algo/pipeline/sensing.hpp"

#include "algo/filter/filter.hpp"
#include "algo/perceive.hpp"

namespace algo {

const LaserScan* Sensing::take(const Observation& observation,
                               const Parameters& parameters,
                               LaserScan& scan) {
  merge_.take(observation);
  const LaserScan* front = front_scan(observation);
  if (front == nullptr) return nullptr;
  filter_.apply(kind_, static_cast<int>(parameters[algo::kFilterHalfWidth]), *front, scan);
  merge_.enter(observation.odometry.pose, observation.stamp, scan);
  return front;
}

}  // namespace algo
