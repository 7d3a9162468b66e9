// server/run/obstacle_json.hpp: obstacles as JSON documents (docs/interfaces.md).
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/obstacle.hpp"

namespace server {

constexpr std::uint32_t kMaxObstacleId = 999'999'999;

/// An obstacle without an "id" gets id 0. Throws DocumentError.
algo::Obstacle obstacle_from_json(const nlohmann::json& value, const std::string& path);
nlohmann::json to_json(const algo::Obstacle& obstacle);

}  // namespace server
