// server/lab/reproduce/pictures.hpp: a layout with the path of each reading.
#pragma once

#include <span>
#include <string>

#include "server/experiment/series.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

/// An SVG document: the obstacles, start and goal of `scenario`, and of every row of it the path of
/// its first run.
std::string draw_paths(const PaperConditions& paper,
                       const sim::Scenario& scenario,
                       std::span<const experiment::Series> rows);

}  // namespace server::reproduce
