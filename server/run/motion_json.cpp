// server/run/motion_json.cpp: one reader and one writer each.
#include "server/run/motion_json.hpp"

#include "server/run/json_fields.hpp"
#include "server/run/pose_json.hpp"

namespace server {
namespace {

using nlohmann::json;

using Drive = sim::DriveConfig;
constexpr NumberRange kLimit{1e-3, 100};
constexpr Field<Drive> kDrive[] = {
    {"max_v", &Drive::max_v, kLimit},
    {"max_omega", &Drive::max_omega, kLimit},
    {"max_acceleration", &Drive::max_acceleration, kLimit},
    {"max_angular_acceleration", &Drive::max_angular_acceleration, kLimit},
    {"ramps", &Drive::ramps},
    {"delay_ticks", &Drive::delay_ticks, {0, 100}},
    {"yaw_slip", &Drive::yaw_slip, {0, 0.9}},
    {"odometry_scale", &Drive::odometry_scale, {0, 0.5}},
    {"odometry_noise", &Drive::odometry_noise, {0, 0.5}},
    {"odometry_slip", &Drive::odometry_slip, {0, 0.9}},
};

}  // namespace

sim::DriveConfig drive_from_json(const JsonReader& in) {
  sim::DriveConfig drive;
  read_only_fields(in, kDrive, drive);
  return drive;
}

json to_json(const sim::DriveConfig& drive) {
  return written(kDrive, drive);
}

algo::ObstaclePath path_from_json(const JsonReader& in) {
  in.only({"period", "phase", "comes_and_goes", "keys"});
  algo::ObstaclePath path;
  path.period = in.number("period", {0.1, kMaxPathTime});
  path.phase = in.number_or("phase", 0, {-kMaxPathTime, kMaxPathTime});
  path.comes_and_goes = in.flag_or("comes_and_goes", false);
  double last = -1;
  in.each("keys", kMaxPathKeys, [&](const json& key, const std::string& at) {
    if (!key.is_array() || key.size() != 3) {
      throw DocumentError(at, "must be a key [t, x, y] in seconds and metres");
    }
    const double time = finite_number(key[0], at + "/0", {0, kMaxPathTime});
    if (time <= last) throw DocumentError(at + "/0", "must be later than the key before");
    last = time;
    path.keys.push_back({time,
                         {finite_number(key[1], at + "/1", kCoordinate),
                          finite_number(key[2], at + "/2", kCoordinate)}});
  });
  if (path.keys.empty()) in.fail("keys", "must hold one key [t, x, y] at least");
  return path;
}

json to_json(const algo::ObstaclePath& path) {
  json keys = json::array();
  for (const auto& key : path.keys) {
    keys.push_back({key.time, key.position_W.x(), key.position_W.y()});
  }
  json out = {{"period", path.period}, {"phase", path.phase}, {"keys", std::move(keys)}};
  if (path.comes_and_goes) out["comes_and_goes"] = true;
  return out;
}

}  // namespace server
