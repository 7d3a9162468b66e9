// server/experiment/path_picture.hpp: paths of several controllers over one world, as SVG that is
// readable in light and dark.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/types.hpp"
#include "sim/scenario.hpp"

namespace server::experiment {

constexpr std::size_t kMostPaths = 12;  // strokes that can be told apart

struct DrawnPath {
  std::string words{};  // in the legend: "modified: reached"
  std::vector<algo::Vec2> track_W{};
  std::size_t stroke = 0;  // below kMostPaths: a colour and a dash
};

/// The obstacles where they are at the start, the robot's circle at the start, the goal, if
/// there is one, with a ring of `goal_radius` [m], and the paths with their legend.
std::string draw_paths(std::string_view title,
                       const sim::Scenario& scenario,
                       double goal_radius,
                       std::span<const DrawnPath> paths);

}  // namespace server::experiment
