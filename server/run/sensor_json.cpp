// server/run/sensor_json.cpp: one reader and one writer each.
#include "server/run/sensor_json.hpp"

#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "algo/name.hpp"
#include "algo/units.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/laser_json.hpp"
#include "server/run/pose_json.hpp"
#include "sim/floor_sensors.hpp"
#include "sim/gyro_model.hpp"
#include "sim/inclinometer_model.hpp"
#include "sim/infrared_model.hpp"
#include "sim/line_camera_model.hpp"
#include "sim/sensor.hpp"
#include "sim/sonar_model.hpp"

namespace server {
namespace {

using nlohmann::json;

using algo::units::kRadiansPerDegree;

using Sonar = sim::SonarConfig;
constexpr Field<Sonar> kSonar[] = {
    {"count", &Sonar::count, {0, 64}},
    {"field_deg", &Sonar::field, {0, 360}, kRadiansPerDegree},
    {"cone_deg", &Sonar::cone, {0, 360}, kRadiansPerDegree},
    {"ping", &Sonar::ping},
    {"range_min", &Sonar::range_min},
    {"range_max", &Sonar::range_max},
    {"noise", &Sonar::noise},
    {"incidence_deg", &Sonar::incidence, {0, 360}, kRadiansPerDegree},
    {"crosstalk", &Sonar::crosstalk},
    {"height", &Sonar::height},
};

using Infrared = sim::InfraredConfig;
constexpr Field<Infrared> kInfrared[] = {
    {"mount"},
    {"height", &Infrared::height},
    {"beams", &Infrared::beams, {0, 361}},
    {"field_deg", &Infrared::field, {0, 360}, kRadiansPerDegree},
    {"period", &Infrared::period},
    {"range_min", &Infrared::range_min},
    {"range_max", &Infrared::range_max},
    {"noise", &Infrared::noise},
};

using Floor = sim::FloorSensorConfig;
constexpr Field<Floor> kFloor[] = {
    {"x", &Floor::x},
    {"height", &Floor::height},
    {"half_spacing", &Floor::half_spacing},
    {"angle_deg", &Floor::angle, {0, 90}, kRadiansPerDegree},
    {"separation", &Floor::separation},
    {"noise", &Floor::noise},
    {"spot", &Floor::spot},
    {"glitches", &Floor::glitches},
    {"period", &Floor::period},
    {"grazing", &Floor::grazing},
};

constexpr Field<sim::GyroConfig> kGyro[] = {
    {"bias", &sim::GyroConfig::bias},
    {"bias_walk", &sim::GyroConfig::bias_walk},
    {"noise", &sim::GyroConfig::noise},
};

using LineCamera = sim::LineCameraConfig;
constexpr Field<LineCamera> kLineCamera[] = {
    required<LineCamera>("x", &LineCamera::x, {}),
    required<LineCamera>("height", &LineCamera::height, {}),
    {"pitch_deg", &LineCamera::pitch, {0, 360}, kRadiansPerDegree, true},
    required<LineCamera>("baseline", &LineCamera::baseline, {}),
    {"angle_deg", &LineCamera::angle, {0, 360}, kRadiansPerDegree, true},
    required<LineCamera>("focal", &LineCamera::focal, {}),
    {"columns"},
    {"rows"},
    {"noise", &LineCamera::noise},
    {"dropout", &LineCamera::dropout},
    {"period", &LineCamera::period},
};

using Inclinometer = sim::InclinometerConfig;
constexpr Field<Inclinometer> kInclinometer[] = {
    {"noise_deg", &Inclinometer::noise, {0, 360}, kRadiansPerDegree},
    {"lag", &Inclinometer::lag},
    {"period", &Inclinometer::period},
};

/// Throws DocumentError at `path` for settings that the model refuses.
template <typename Config, std::size_t N>
Config config_from_json(const JsonReader& in,
                        const std::string& path,
                        const Field<Config> (&table)[N]) {
  Config config;
  read_only_fields(in, table, config);
  if constexpr (std::is_same_v<Config, Infrared>) {
    if (in.has("mount")) config.mount_R = mount_from_json(in.object("mount"));
  }
  if constexpr (std::is_same_v<Config, LineCamera>) {
    config.columns = static_cast<int>(in.whole("columns", 10000));
    config.rows = static_cast<int>(in.whole("rows", 10000));
  }
  if (const auto complaint = sim::defect(config)) throw DocumentError(path, *complaint);
  return config;
}

json to_json(const Infrared& scanner) {
  json out = written(kInfrared, scanner);
  out["mount"] = server::to_json(scanner.mount_R);
  return out;
}

json to_json(const LineCamera& camera) {
  json out = written(kLineCamera, camera);
  out["columns"] = camera.columns;
  out["rows"] = camera.rows;
  return out;
}

/// The line camera and the inclinometer. `false` takes either away.
void read_terrain(const JsonReader& in, sim::Sensors& sensors) {
  const auto read = [&in](const char* key, auto& config, const auto& table) {
    if (!in.has(key)) return;
    if (in.raw()[key] == false) {
      config.reset();
    } else {
      config = config_from_json(in.object(key), in.at(key), table);
    }
  };
  read("line_camera", sensors.line_camera, kLineCamera);
  read("inclinometer", sensors.inclinometer, kInclinometer);
}

/// `false`: no gyro; an object: a gyro with those errors; absent: the robot's own.
void read_gyro(const JsonReader& in, sim::Sensors& sensors) {
  if (!in.has("gyro")) return;
  if (in.raw()["gyro"].is_boolean()) {
    sensors.has_gyro = in.flag_or("gyro", true);
    return;
  }
  sensors.gyro = config_from_json(in.object("gyro"), in.at("gyro"), kGyro);
  sensors.has_gyro = true;
}

/// Every field except sensor, channel and unit is a setting: a number or a list of numbers.
sim::SensorConfig sensor_from_json(const JsonReader& in, const std::string& path) {
  sim::SensorConfig config;
  config.sensor = in.text("sensor", algo::Name::kLongest);
  config.channel = in.text("channel");
  config.unit = in.text_or("unit", "");
  if (config.unit.size() > algo::Name::kLongest) in.fail("unit", "is too long");
  for (const auto& [name, value] : in.raw().items()) {
    if (name == "sensor" || name == "channel" || name == "unit") continue;
    sim::Setting setting{.name = name};
    const std::string at = in.at(name);
    if (value.is_array()) {
      if (value.size() > sim::kMostSettingValues) {
        in.fail(name, fmt::format("must have {} numbers at most", sim::kMostSettingValues));
      }
      for (const json& each : value) setting.values.push_back(finite_number(each, at));
    } else {
      setting.values.push_back(finite_number(value, at));
    }
    config.settings.push_back(std::move(setting));
  }
  if (const auto complaint = sim::defect(config)) throw DocumentError(path, *complaint);
  return config;
}

json to_json(const sim::SensorConfig& config) {
  json out = {{"sensor", config.sensor}, {"channel", config.channel}};
  if (!config.unit.empty()) out["unit"] = config.unit;
  for (const sim::Setting& setting : config.settings) {
    out[setting.name] = setting.values.size() == 1 ? json(setting.values[0]) : json(setting.values);
  }
  return out;
}

void read_channels(const JsonReader& in, sim::Sensors& sensors) {
  if (!in.has("sensors")) return;
  sensors.further.clear();
  std::set<std::string> channels;
  in.each("sensors", sim::kMostSensors, [&](const json& value, const std::string& at) {
    sensors.further.push_back(sensor_from_json({value, at}, at));
    const std::string& channel = sensors.further.back().channel;
    if (!channels.insert(channel).second) {
      throw DocumentError(at + "/channel", fmt::format("'{}' is used twice", channel));
    }
  });
}

}  // namespace

void read_sensors(const JsonReader& in, sim::Sensors& sensors) {
  if (in.has("lasers")) {
    sensors.lasers.clear();
    in.each("lasers", 4, [&](const json& value, const std::string& at) {
      sensors.lasers.push_back(laser_from_json({value, at}));
    });
  }
  if (in.has("sonar") && in.raw()["sonar"] == false) {
    sensors.sonar.reset();
  } else if (in.has("sonar")) {
    sensors.sonar = config_from_json(in.object("sonar"), in.at("sonar"), kSonar);
  }
  if (in.has("infrared")) {
    sensors.infrared.clear();
    in.each("infrared", 4, [&](const json& value, const std::string& at) {
      sensors.infrared.push_back(config_from_json({value, at}, at, kInfrared));
    });
  }
  if (in.has("floor_sensors") && in.raw()["floor_sensors"] == false) {
    sensors.floor.reset();
  } else if (in.has("floor_sensors")) {
    sensors.floor = config_from_json(in.object("floor_sensors"), in.at("floor_sensors"), kFloor);
  }
  read_channels(in, sensors);
  read_gyro(in, sensors);
  read_terrain(in, sensors);
  sensors.bumpers = static_cast<std::uint32_t>(in.whole_or("bumpers", sensors.bumpers, 8));
  sensors.encoders = in.flag_or("encoders", sensors.encoders);
}

void write_sensors(const sim::Sensors& s, nlohmann::json& out) {
  out["lasers"] = json::array();
  for (const sim::LaserConfig& laser : s.lasers) out["lasers"].push_back(to_json(laser));
  if (s.sonar) out["sonar"] = written(kSonar, *s.sonar);
  for (const sim::InfraredConfig& scanner : s.infrared) out["infrared"].push_back(to_json(scanner));
  if (s.floor) out["floor_sensors"] = written(kFloor, *s.floor);
  for (const sim::SensorConfig& sensor : s.further) out["sensors"].push_back(to_json(sensor));
  if (!s.has_gyro) out["gyro"] = false;
  if (s.has_gyro && s.gyro) out["gyro"] = written(kGyro, *s.gyro);
  if (s.line_camera) out["line_camera"] = to_json(*s.line_camera);
  if (s.inclinometer) out["inclinometer"] = written(kInclinometer, *s.inclinometer);
  if (s.bumpers != 1) out["bumpers"] = s.bumpers;
  if (!s.encoders) out["encoders"] = false;
}

bool same_sensors(const sim::Sensors& a, const sim::Sensors& b) {
  json first = json::object();
  json second = json::object();
  write_sensors(a, first);
  write_sensors(b, second);
  return first == second;
}

}  // namespace server
