// sim/sensor.hpp: the interface of all sensors of a simulated robot, and of channel sensors, which
// have a file each.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "algo/observation.hpp"
#include "algo/obstacle.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/range_caster.hpp"
#include "sim/robot_model.hpp"
#include "sim/sensor_configs.hpp"
#include "sim/solid_caster.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// The inputs of a sensor in one tick.
struct Surroundings {
  double stamp = 0;  // [s] run clock
  const VehicleState& vehicle;
  const PoseTrail& trail;  // the robot's recent poses
  const ObstacleSet& obstacles;
  bool contact = false;                 // the robot was touched in this tick
  const SolidCaster* solids = nullptr;  // all obstacles, if the ground is not level
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  Sensor(const Sensor&) = delete;
  Sensor& operator=(const Sensor&) = delete;
  Sensor(Sensor&&) = default;
  Sensor& operator=(Sensor&&) = default;

  // Changes of the obstacles, for a sensor that keeps its own copy of them.
  virtual void add(const algo::Obstacle& /*obstacle*/) {}
  virtual void move(std::uint32_t /*id*/, const algo::Pose2& /*pose_W*/) {}
  virtual void remove(std::uint32_t /*id*/) {}

  /// Appends the new readings to `observation`.
  virtual void sense(const Surroundings& around, algo::Observation& observation) = 0;
  /// [s] How far back along the trail a reading reaches at most.
  virtual double memory() const { return 0; }

 protected:
  Sensor() = default;
};

/// A sensor that casts rays at the obstacles, with its own slice of the world.
class CastingSensor : public Sensor {
 public:
  void add(const algo::Obstacle& obstacle) override { caster_.add(obstacle); }
  void move(std::uint32_t id, const algo::Pose2& pose_W) override { caster_.move(id, pose_W); }
  void remove(std::uint32_t id) override { caster_.remove(id); }

 protected:
  /// `height` [m] above the floor.
  explicit CastingSensor(double height) : caster_(height) {}

  RangeCaster& caster() { return caster_; }
  const RangeCaster& caster() const { return caster_; }

 private:
  RangeCaster caster_;
};

inline bool within(double value, double low, double high) {
  return value >= low && value <= high;  // false for NaN
}

/// Returns `config`; throws std::invalid_argument with its defect, as a sentence about `sensor`.
template <typename Config>
const Config& checked(const Config& config, const std::string& sensor) {
  if (const auto problem = defect(config)) {
    throw std::invalid_argument(sensor + ": " + *problem + ".");
  }
  return config;
}

/// Sets the reading of a sonar or infrared beam that hit an obstacle at `range` [m], if that is in
/// range.
inline void measure(algo::RangeReading& reading, double range) {
  if (range >= reading.range_max) return;
  reading.range = range;
  reading.status = algo::Beam::Ok;
}

/// Makes all sensors of `robot`, in the order of their readings. Throws std::invalid_argument with
/// a sentence.
std::vector<std::unique_ptr<Sensor>> make_sensors(const RobotModel& robot, std::uint64_t seed);

/// A sensor with a channel of its own.
class ChannelSensor {
 public:
  virtual ~ChannelSensor() = default;
  /// Overwrites `values`; false if there is no new reading in this tick.
  virtual bool read(const Surroundings& around, std::vector<double>& values) = 0;
};

/// A setting that a scenario may set, and its limits.
struct SettingInfo {
  std::string_view name{};
  std::string_view help{};
  double min = 0;
  double max = 0;
  std::size_t most = 1;  // numbers; 1: a single number, not a list
  bool required = false;
};

/// One file sim/sensors/NAME.cpp defines `SensorKind NAME()`.
struct SensorKind {
  std::string_view name{};  // name of its file
  std::string_view help{};
  std::string_view kind{};  // as in ChannelInfo
  std::string_view unit{};
  std::uint32_t values = 1;  // per reading
  std::vector<SettingInfo> settings{};
  /// Why settings do not go together, apart from their own limits; may be empty.
  std::function<std::optional<std::string>(const SensorConfig&)> defect{};
  std::function<std::unique_ptr<ChannelSensor>(const SensorConfig&, std::uint64_t seed)> make{};
};

constexpr std::size_t kMostSensors = 16;
constexpr std::size_t kMostSettingValues = 4096;

/// All sensor kinds, sorted by name.
std::span<const SensorKind> sensor_table();
/// The defect of `config`, as in "times must ascend"; nothing if a sensor can be made from it.
std::optional<std::string> defect(const SensorConfig& config);
/// Makes a sensor; `config` must have no defect.
std::unique_ptr<ChannelSensor> make_sensor(const SensorConfig& config, std::uint64_t seed);
algo::ChannelInfo channel_of(const SensorConfig& config);

/// Lets a sensor read once per period: at the first tick, then at each whole multiple.
class Every {
 public:
  explicit Every(double period) : period_(period) {}
  bool due(double stamp);

 private:
  double period_ = 0;  // [s]; 0: every tick
  double next_ = 0;    // [s] run clock
};

}  // namespace sim
