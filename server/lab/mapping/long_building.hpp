// server/lab/mapping/long_building.hpp: a simulated drive with long loops, as a log and its truth.
#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/scenario.hpp"

namespace server::mapping {

/// Writes a CARMEN log to `file`, and true relations to the same name with the ending ".relations":
/// a drive of 1.9 km through the corridors of a building of 300 m by 50 m, round loops of 500 m and
/// more, with a scanner of 30 m and 180 degrees. `errors` disturb its odometry. Doors and rooms are
/// the seed's. The relations join poses a metre of way apart, and poses of different laps less than
/// 2 m apart. Throws std::invalid_argument and std::runtime_error.
void write_long_building(const std::filesystem::path& file,
                         std::uint64_t seed,
                         const sim::DriveConfig& errors);

}  // namespace server::mapping
