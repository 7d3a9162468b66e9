// server/run/map_file.hpp: maps of map_server, a PGM picture and a YAML file that describes it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "algo/mapping/occupancy_map.hpp"
#include "algo/mapping/submap.hpp"

namespace server {

/// Reads the map that `yaml` describes. Keys: image, resolution, origin, and if they are not the
/// usual ones negate, occupied_thresh, free_thresh and mode. Cells between the two thresholds stay
/// unknown. Throws std::runtime_error with a sentence that names the file and the field.
algo::OccupancyMap read_map(const std::filesystem::path& yaml);

/// The same for texts: `name` is the description's in messages, `read_picture` gives the bytes of
/// the image it names.
algo::OccupancyMap map_from(const std::string& description,
                            const std::string& name,
                            const std::function<std::string(const std::string&)>& read_picture);

/// The walls that touch a free cell. The others lie within thick walls or behind them, where no
/// scanner sees them. All walls, if no wall touches one.
algo::Submap seen_walls(const algo::OccupancyMap& map);

/// The map as JSON: name, cell [m], corner x, y [m], columns, rows, and the cells by rows from the
/// corner as pairs of kind and number, one after the other: 0 unknown, 1 free, 2 wall.
std::string map_document(const algo::OccupancyMap& map, const std::string& name);

/// The picture that write_map() puts beside `yaml`: the same name with the ending ".pgm". Throws
/// std::runtime_error if that is `yaml` itself.
std::filesystem::path picture_beside(const std::filesystem::path& yaml);

/// Writes the known cells to picture_beside(yaml), and to `yaml` the cell and the origin. Throws
/// std::runtime_error.
void write_map(const algo::OccupancyMap& map, const std::filesystem::path& yaml);

}  // namespace server
