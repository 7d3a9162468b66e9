// server/experiment/sweep/sweep_figures.hpp: the pictures of an experiment.
#pragma once

#include <string>
#include <vector>

#include "server/experiment/sweep/sweep_results.hpp"

namespace server::sweep {

constexpr std::size_t kMostDrawn = 40;  // arms in a chart; charts of more are left out
constexpr std::size_t kMostMaps = 8;    // heat maps, one a controller

struct Picture {
  std::string file{};   // "success.svg"
  std::string title{};  // a sentence for people and screen readers
  std::string svg{};
};

/// The runs in a scenario whose paths are drawn, one an arm.
std::vector<std::size_t> runs_with_path(const Plan& plan, const Rows& rows, std::size_t scenario);

/// Rates of success with their intervals; times, paths and least clearances as boxes; for a grid
/// over two parameters, a heat map of the success of each controller; and the paths in each of the
/// first scenarios.
std::vector<Picture> pictures_of(const Plan& plan, const Rows& rows, const Results& results);

}  // namespace server::sweep
