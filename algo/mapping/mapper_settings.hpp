// algo/mapping/mapper_settings.hpp: the lengths and shares of a mapper.
#pragma once

#include <cmath>

#include "algo/mapping/scan_matcher.hpp"
#include "algo/types.hpp"

namespace algo {

struct MapperSettings {
  double cell = 0.05;     // [m]
  double reach = 20;      // [m] farther returns are ignored
  double new_way = 0.25;  // [m] travel between two scans that enter the map,
  double new_turn = 0.2;  // [rad] or turn
  double submap = 10;     // [m] way of a submap, a radian counting as a metre
  double lost = 0.3;      // smallest share of a scan's points on the map without a search
  MatchPrior prior{};
};

/// Whether a scan at `b` shows enough more than one at `a` to enter the map too.
inline bool apart(const Pose2& a, const Pose2& b, const MapperSettings& settings) {
  const Pose2 step = pose_step(a, b);
  return step.position().norm() >= settings.new_way || std::abs(step.heading) >= settings.new_turn;
}

}  // namespace algo
