// server/run/motion_json.cpp: one reader and one writer each.
#include "server/run/motion_json.hpp"

#include <fmt/format.h>

#include "server/run/pose_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxKeys = 10'000;
constexpr double kMaxTime = 1e6;  // [s]

}  // namespace

sim::DriveConfig drive_from_json(const JsonReader& in) {
  in.only({"max_v",
           "max_omega",
           "max_acceleration",
           "max_angular_acceleration",
           "ramps",
           "delay_ticks",
           "yaw_slip",
           "odometry_scale",
           "odometry_noise",
           "odometry_slip"});
  const auto limit = [&](const char* key) -> std::optional<double> {
    if (!in.has(key)) return std::nullopt;
    return in.number(key, {1e-3, 100});
  };
  sim::DriveConfig drive;
  drive.max_v = limit("max_v");
  drive.max_omega = limit("max_omega");
  drive.max_acceleration = limit("max_acceleration");
  drive.max_angular_acceleration = limit("max_angular_acceleration");
  drive.ramps = in.flag_or("ramps", false);
  drive.delay_ticks = static_cast<std::uint32_t>(in.whole_or("delay_ticks", 0, 100));
  drive.yaw_slip = in.number_or("yaw_slip", 0, {0, 0.9});
  drive.odometry_scale = in.number_or("odometry_scale", 0, {0, 0.5});
  drive.odometry_noise = in.number_or("odometry_noise", 0, {0, 0.5});
  drive.odometry_slip = in.number_or("odometry_slip", 0, {0, 0.9});
  return drive;
}

json to_json(const sim::DriveConfig& drive) {
  json out = {{"ramps", drive.ramps},
              {"delay_ticks", drive.delay_ticks},
              {"yaw_slip", drive.yaw_slip},
              {"odometry_scale", drive.odometry_scale},
              {"odometry_noise", drive.odometry_noise},
              {"odometry_slip", drive.odometry_slip}};
  const auto put = [&](const char* key, const std::optional<double>& limit) {
    if (limit) out[key] = *limit;
  };
  put("max_v", drive.max_v);
  put("max_omega", drive.max_omega);
  put("max_acceleration", drive.max_acceleration);
  put("max_angular_acceleration", drive.max_angular_acceleration);
  return out;
}

sim::ObstaclePath path_from_json(const JsonReader& in, std::uint32_t id) {
  in.only({"period", "phase", "keys"});
  sim::ObstaclePath path;
  path.id = id;
  path.period = in.number("period", {0.1, kMaxTime});
  path.phase = in.number_or("phase", 0, {-kMaxTime, kMaxTime});
  const json& keys = in.array("keys", kMaxKeys);
  if (keys.empty()) in.fail("keys", "must hold one key [t, x, y] at least");
  double last = -1;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string at = fmt::format("{}/{}", in.at("keys"), i);
    if (!keys[i].is_array() || keys[i].size() != 3) {
      throw DocumentError(at, "must be a key [t, x, y] in seconds and metres");
    }
    const double time = finite_number(keys[i][0], at + "/0", {0, kMaxTime});
    if (time <= last) throw DocumentError(at + "/0", "must be later than the key before");
    last = time;
    path.keys.push_back({time,
                         {finite_number(keys[i][1], at + "/1", kCoordinate),
                          finite_number(keys[i][2], at + "/2", kCoordinate)}});
  }
  return path;
}

json to_json(const sim::ObstaclePath& path) {
  json keys = json::array();
  for (const auto& key : path.keys) {
    keys.push_back({key.time, key.position_W.x(), key.position_W.y()});
  }
  return {{"period", path.period}, {"phase", path.phase}, {"keys", std::move(keys)}};
}

}  // namespace server
