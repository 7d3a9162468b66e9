// server/run/obstacle_json.hpp: obstacles as JSON documents (docs/interfaces.md).
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/obstacle.hpp"
#include "sim/scenario.hpp"

namespace server {

constexpr std::uint32_t kMaxObstacleId = 999'999'999;
/// Highest id that an edit may name. It covers robots too, which refuse edits.
constexpr std::uint32_t kMaxStandingId = sim::kRobotIds + sim::kMostRobots;
static_assert(kMaxObstacleId < sim::kRobotIds);

/// An obstacle without an "id" gets id 0. Throws DocumentError.
algo::Obstacle obstacle_from_json(const nlohmann::json& value, const std::string& path);
nlohmann::json to_json(const algo::Obstacle& obstacle);

}  // namespace server
