// algo/obstacle_path.cpp: the position of a moving obstacle.
#include "algo/obstacle_path.hpp"

#include <algorithm>
#include <cmath>

namespace algo {

/// [s] of the path, from 0 to the period.
double ObstaclePath::time_at(double stamp) const {
  const double time = std::fmod(stamp + phase, period);
  return time < 0 ? time + period : time;
}

bool ObstaclePath::is_there(double stamp) const {
  if (!comes_and_goes) return true;
  const double time = time_at(stamp);
  return !keys.empty() && keys.front().time <= time && time <= keys.back().time;
}

Vec2 ObstaclePath::at(double stamp) const {
  if (keys.empty()) return {0, 0};
  const double time = time_at(stamp);
  const auto after = std::ranges::upper_bound(keys, time, {}, &Key::time);
  if (after == keys.begin()) return keys.front().position_W;
  if (after == keys.end()) return keys.back().position_W;
  const Key& a = *(after - 1);
  const double part = (time - a.time) / (after->time - a.time);
  return a.position_W + part * (after->position_W - a.position_W);
}

}  // namespace algo
