// sim/sensor.hpp: further sensors of a simulated robot, each a file that fills a channel.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/observation.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/sensor_configs.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// What a sensor may sense in one tick.
struct Surroundings {
  double stamp = 0;  // [s] run clock
  const VehicleState& vehicle;
  const ObstacleSet& obstacles;
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Overwrites `values`; false, when there is no new reading in this tick.
  virtual bool sense(const Surroundings& around, std::vector<double>& values) = 0;
};

/// What a scenario may set, and within which limits.
struct SettingInfo {
  std::string_view name{};
  std::string_view help{};
  double min = 0;
  double max = 0;
  std::size_t most = 1;  // numbers; 1: a number, no list
  bool required = false;
};

/// One file sim/sensors/NAME.cpp defines `SensorKind NAME()`.
struct SensorKind {
  std::string_view name{};  // of its file
  std::string_view help{};
  std::string_view kind{};  // as of a ChannelInfo
  std::string_view unit{};
  std::uint32_t values = 1;  // in a reading
  std::vector<SettingInfo> settings{};
  /// Why settings do not go together, beside their own limits; may be empty.
  std::function<std::optional<std::string>(const SensorConfig&)> defect{};
  std::function<std::unique_ptr<Sensor>(const SensorConfig&, std::uint64_t seed)> make{};
};

constexpr std::size_t kMostSensors = 16;
constexpr std::size_t kMostSettingValues = 4096;

/// By name.
std::span<const SensorKind> sensor_table();
/// What is wrong with `config`, as "times must ascend"; nothing when a sensor can be made of it.
std::optional<std::string> defect(const SensorConfig& config);
/// Of a config without defect.
std::unique_ptr<Sensor> make_sensor(const SensorConfig& config, std::uint64_t seed);
algo::ChannelInfo channel_of(const SensorConfig& config);

/// Lets a sensor read once in a period: at the first tick, then at each whole multiple.
class Every {
 public:
  explicit Every(double period) : period_(period) {}
  bool due(double stamp);

 private:
  double period_ = 0;  // [s]; 0: every tick
  double next_ = 0;    // [s] run clock
};

}  // namespace sim
