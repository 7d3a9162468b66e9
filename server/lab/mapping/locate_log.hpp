// server/lab/mapping/locate_log.hpp: follows a recorded log on a known map.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/mapping/submap.hpp"
#include "algo/types.hpp"
#include "server/lab/mapping/map_study.hpp"

namespace server::mapping {

struct LocatedLog {
  std::vector<std::optional<algo::Pose2>> poses_M{};  // one per scan; empty where not located
  std::size_t located = 0;                            // scans
  std::optional<std::size_t> first{};                 // scan at which it was located, from 0
  double deviation = 0;                               // [m] mean, of the located poses, if any
  std::string last{};                                 // the fix at the end, in words
};

/// "x,y,heading"; nothing for an empty text. Throws std::runtime_error with a sentence.
std::optional<algo::Pose2> start_of(const std::string& text);

/// The robot stands at its first scan until the search for its place is over.
LocatedLog locate_log(const Recording& log,
                      const algo::Submap& map,
                      const std::optional<algo::Pose2>& start_M);

/// Writes the located poses: the log's stamp, x, y [m] and heading [rad]. Throws
/// std::runtime_error.
void write_poses(const Recording& log, const LocatedLog& found, const std::filesystem::path& file);

nlohmann::json to_json(const LocatedLog& found);
std::string to_text(const LocatedLog& found);

}  // namespace server::mapping
