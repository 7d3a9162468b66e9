// algo/obstacle_path.cpp: the position of a moving obstacle.
#include "algo/obstacle_path.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

Vec2 ObstaclePath::at(double stamp) const {
  if (keys.empty()) return {0, 0};
  double time = std::fmod(stamp + phase, period);
  if (time < 0) time += period;
  const auto after = std::ranges::upper_bound(keys, time, {}, &Key::time);
  if (after == keys.begin()) return keys.front().position_W;
  if (after == keys.end()) return keys.back().position_W;
  const Key& a = *(after - 1);
  const double part = (time - a.time) / (after->time - a.time);
  return a.position_W + part * (after->position_W - a.position_W);
}

}  // namespace algo
