// server/lab/reproduce/pictures.hpp: draws a layout with the path of each reading.
#pragma once

#include <span>
#include <string>

#include "server/experiment/series.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

/// An SVG document with the obstacles, start and goal of `scenario`, and the path of the first run
/// of each of its rows.
std::string draw_paths(const PaperConditions& paper,
                       const sim::Scenario& scenario,
                       std::span<const experiment::Series> rows);

}  // namespace server::reproduce
