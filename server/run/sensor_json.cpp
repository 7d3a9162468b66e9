// server/run/sensor_json.cpp: one reader and one writer each.
#include "server/run/sensor_json.hpp"

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "algo/name.hpp"
#include "algo/units.hpp"
#include "server/run/laser_json.hpp"
#include "sim/gyro_model.hpp"
#include "sim/infrared_model.hpp"
#include "sim/sensor.hpp"
#include "sim/sonar_model.hpp"

namespace server {
namespace {

using nlohmann::json;

/// Short numbers for whole degrees; 1e-9 degrees are no difference.
double in_degrees(double angle) {
  return std::round(angle / algo::units::kRadiansPerDegree * 1e9) / 1e9;
}

algo::Pose2 mount_from_json(const JsonReader& in) {
  constexpr NumberRange kOnHull{-10, 10};  // [m]
  return {in.number("x", kOnHull),
          in.number("y", kOnHull),
          algo::wrap_angle(in.number_or("heading", 0, {-100, 100}))};
}

sim::SonarConfig sonar_from_json(const JsonReader& in, const std::string& path) {
  in.only({"count",
           "field_deg",
           "cone_deg",
           "ping",
           "range_min",
           "range_max",
           "noise",
           "incidence_deg",
           "height"});
  sim::SonarConfig sonar;
  const auto degrees = [&](std::string_view key, double fallback) {
    const double initial = fallback / algo::units::kRadiansPerDegree;
    return in.number_or(key, initial, {0, 360}) * algo::units::kRadiansPerDegree;
  };
  sonar.count = static_cast<std::uint32_t>(in.whole_or("count", sonar.count, 64));
  sonar.field = degrees("field_deg", sonar.field);
  sonar.cone = degrees("cone_deg", sonar.cone);
  sonar.ping = in.number_or("ping", sonar.ping);
  sonar.range_min = in.number_or("range_min", sonar.range_min);
  sonar.range_max = in.number_or("range_max", sonar.range_max);
  sonar.noise = in.number_or("noise", sonar.noise);
  sonar.incidence = degrees("incidence_deg", sonar.incidence);
  sonar.height = in.number_or("height", sonar.height);
  if (const auto complaint = sim::defect(sonar)) throw DocumentError(path, *complaint);
  return sonar;
}

json to_json(const sim::SonarConfig& sonar) {
  return {{"count", sonar.count},
          {"field_deg", in_degrees(sonar.field)},
          {"cone_deg", in_degrees(sonar.cone)},
          {"ping", sonar.ping},
          {"range_min", sonar.range_min},
          {"range_max", sonar.range_max},
          {"noise", sonar.noise},
          {"incidence_deg", in_degrees(sonar.incidence)},
          {"height", sonar.height}};
}

sim::InfraredConfig infrared_from_json(const JsonReader& in, const std::string& path) {
  in.only({"mount", "height", "beams", "field_deg", "period", "range_min", "range_max", "noise"});
  sim::InfraredConfig scanner;
  if (in.has("mount")) scanner.mount_R = mount_from_json(in.object("mount"));
  scanner.height = in.number_or("height", scanner.height);
  scanner.beams = static_cast<std::uint32_t>(in.whole_or("beams", scanner.beams, 361));
  const double field = scanner.field / algo::units::kRadiansPerDegree;
  scanner.field = in.number_or("field_deg", field, {0, 360}) * algo::units::kRadiansPerDegree;
  scanner.period = in.number_or("period", scanner.period);
  scanner.range_min = in.number_or("range_min", scanner.range_min);
  scanner.range_max = in.number_or("range_max", scanner.range_max);
  scanner.noise = in.number_or("noise", scanner.noise);
  if (const auto complaint = sim::defect(scanner)) throw DocumentError(path, *complaint);
  return scanner;
}

json to_json(const sim::InfraredConfig& scanner) {
  return {
      {"mount",
       {{"x", scanner.mount_R.x}, {"y", scanner.mount_R.y}, {"heading", scanner.mount_R.heading}}},
      {"height", scanner.height},
      {"beams", scanner.beams},
      {"field_deg", in_degrees(scanner.field)},
      {"period", scanner.period},
      {"range_min", scanner.range_min},
      {"range_max", scanner.range_max},
      {"noise", scanner.noise}};
}

/// `false`: none; an object: one with those errors; absent: as the robot has it.
void read_gyro(const JsonReader& in, sim::Sensors& sensors) {
  if (!in.has("gyro")) return;
  if (in.raw()["gyro"].is_boolean()) {
    sensors.has_gyro = in.flag_or("gyro", true);
    return;
  }
  const JsonReader gyro = in.object("gyro");
  gyro.only({"bias", "bias_walk", "noise"});
  sim::GyroConfig config;
  config.bias = gyro.number_or("bias", config.bias);
  config.bias_walk = gyro.number_or("bias_walk", config.bias_walk);
  config.noise = gyro.number_or("noise", config.noise);
  if (const auto complaint = sim::defect(config)) in.fail("gyro", *complaint);
  sensors.has_gyro = true;
  sensors.gyro = config;
}

/// Besides sensor, channel and unit every field is a setting: a number or a list of them.
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
  const json& list = in.array("sensors", sim::kMostSensors);
  sensors.further.clear();
  std::set<std::string> channels;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = fmt::format("{}/{}", in.at("sensors"), i);
    sensors.further.push_back(sensor_from_json({list[i], path}, path));
    const std::string& channel = sensors.further.back().channel;
    if (!channels.insert(channel).second) {
      throw DocumentError(path + "/channel", fmt::format("'{}' is used twice", channel));
    }
  }
}

}  // namespace

void read_sensors(const JsonReader& in, sim::Sensors& sensors) {
  if (in.has("lasers")) {
    sensors.lasers.clear();
    const json& list = in.array("lasers", 4);
    for (std::size_t i = 0; i < list.size(); ++i) {
      sensors.lasers.push_back(
          laser_from_json({list[i], fmt::format("{}/{}", in.at("lasers"), i)}));
    }
  }
  if (in.has("sonar") && in.raw()["sonar"] == false) {
    sensors.sonar.reset();
  } else if (in.has("sonar")) {
    sensors.sonar = sonar_from_json(in.object("sonar"), in.at("sonar"));
  }
  if (in.has("infrared")) {
    sensors.infrared.clear();
    const json& list = in.array("infrared", 4);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string path = fmt::format("{}/{}", in.at("infrared"), i);
      sensors.infrared.push_back(infrared_from_json({list[i], path}, path));
    }
  }
  read_channels(in, sensors);
  read_gyro(in, sensors);
  sensors.bumpers = static_cast<std::uint32_t>(in.whole_or("bumpers", sensors.bumpers, 8));
  sensors.encoders = in.flag_or("encoders", sensors.encoders);
}

void write_sensors(const sim::Sensors& s, nlohmann::json& out) {
  out["lasers"] = json::array();
  for (const sim::LaserConfig& laser : s.lasers) out["lasers"].push_back(to_json(laser));
  if (s.sonar) out["sonar"] = to_json(*s.sonar);
  for (const sim::InfraredConfig& scanner : s.infrared) out["infrared"].push_back(to_json(scanner));
  for (const sim::SensorConfig& sensor : s.further) out["sensors"].push_back(to_json(sensor));
  if (!s.has_gyro) out["gyro"] = false;
  if (s.has_gyro && s.gyro) {
    out["gyro"] = {
        {"bias", s.gyro->bias}, {"bias_walk", s.gyro->bias_walk}, {"noise", s.gyro->noise}};
  }
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
