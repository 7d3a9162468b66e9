// server/lab/mapping/locate_log.cpp: one scan after the other.
#include "server/lab/mapping/locate_log.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/mapping/map_localizer.hpp"
#include "server/run/text_file.hpp"

namespace server::mapping {
std::optional<algo::Pose2> start_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::istringstream words(text);
  algo::Pose2 pose;
  char comma = 0;
  char other = 0;
  std::string rest;
  const bool good = static_cast<bool>(words >> pose.x >> comma >> pose.y >> other >> pose.heading);
  if (!good || comma != ',' || other != ',' || (words >> rest) || !finite(pose)) {
    throw std::runtime_error("--start must be x,y,heading, not \"" + text + "\".");
  }
  pose.heading = algo::wrap_angle(pose.heading);
  return pose;
}

LocatedLog locate_log(const Recording& log,
                      const algo::Submap& map,
                      const std::optional<algo::Pose2>& start_M) {
  algo::MapLocalizer localizer(map);
  if (start_M) localizer.place(*start_M);
  LocatedLog found;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    localizer.take_whole(log.scans[i], log.path_W[i]);
    found.poses_M.emplace_back();
    if (!localizer.located()) continue;
    found.poses_M.back() = localizer.best().pose_M();
    if (!found.first) found.first = i;
    const Eigen::Matrix3d c = localizer.best().covariance();
    found.deviation += std::sqrt(c(0, 0) + c(1, 1));
    ++found.located;
  }
  if (found.located > 0) found.deviation /= static_cast<double>(found.located);
  found.last = localizer.sentence();
  return found;
}

void write_poses(const Recording& log, const LocatedLog& found, const std::filesystem::path& file) {
  std::string text;
  for (std::size_t i = 0; i < found.poses_M.size(); ++i) {
    if (!found.poses_M[i]) continue;
    const algo::Pose2& pose = *found.poses_M[i];
    text +=
        fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}\n", log.stamps[i], pose.x, pose.y, pose.heading);
  }
  write_text(file, text);
}

nlohmann::json to_json(const LocatedLog& found) {
  nlohmann::json out = {
      {"scans", found.poses_M.size()}, {"located", found.located}, {"fix", found.last}};
  out["deviation_m"] =
      found.located > 0 ? nlohmann::json(found.deviation) : nlohmann::json(nullptr);
  out["first_located"] = found.first ? nlohmann::json(*found.first) : nlohmann::json(nullptr);
  return out;
}

std::string to_text(const LocatedLog& found) {
  std::string text = fmt::format("Located at {} of {} scans", found.located, found.poses_M.size());
  if (found.first) {
    text +=
        fmt::format(", first at scan {}, counted from 0; standard deviation {:.3f} m in the mean",
                    *found.first,
                    found.deviation);
  }
  return text + ".\nAt the end: " + found.last;
}

}  // namespace server::mapping
