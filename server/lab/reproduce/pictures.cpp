// server/lab/reproduce/pictures.cpp: the first run of each reading.
#include "server/lab/reproduce/pictures.hpp"

#include <fmt/format.h>

#include "server/experiment/path_picture.hpp"

namespace server::reproduce {

std::string draw_paths(const PaperConditions& paper,
                       const sim::Scenario& scenario,
                       std::span<const experiment::Series> rows) {
  std::vector<experiment::DrawnPath> paths;
  for (std::size_t i = 0; i < readings().size(); ++i) {
    const experiment::Series* const row = find_series(rows, scenario.name, readings()[i]);
    if (row == nullptr) continue;
    const experiment::Row& first = row->runs.front();
    paths.push_back({.words = fmt::format("{}: {}", readings()[i], algo::name(first.outcome)),
                     .track_W = first.track_W,
                     .stroke = i});
  }
  return draw_paths(fmt::format("{}: the path of each reading", scenario.name),
                    scenario,
                    paper.arrival_radius,
                    paths);
}

}  // namespace server::reproduce
