// server/run/drawn_map.hpp: the room that a known map shows, from its cells and as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "algo/drawn_space.hpp"
#include "algo/mapping/occupancy_map.hpp"

namespace server {

/// The room on a map: known where a cell of the map is free or a wall, and near walls.
algo::DrawnSpace drawn_space(const algo::OccupancyMap& map);

/// As a run's document keeps it, so that the run can be repeated without the map: left, bottom,
/// columns, rows, and the cells as pairs of clearance and number, one after the other.
nlohmann::json to_json(const algo::DrawnSpace& space);
/// Throws std::exception with a sentence.
algo::DrawnSpace drawn_space_from_json(const nlohmann::json& value);

}  // namespace server
