// sim/robot_sensors.cpp: makes the sensors of a robot model.
#include <utility>

#include "sim/bumper_ring.hpp"
#include "sim/floor_sensors.hpp"
#include "sim/inclinometer_model.hpp"
#include "sim/infrared_model.hpp"
#include "sim/laser_model.hpp"
#include "sim/line_camera_model.hpp"
#include "sim/sensor.hpp"
#include "sim/sonar_model.hpp"

namespace sim {
namespace {

/// Enters the readings of a channel's sensor into the observation.
class Channel final : public Sensor {
 public:
  Channel(std::uint8_t number, std::unique_ptr<ChannelSensor> sensor)
      : number_(number), sensor_(std::move(sensor)) {}

  void sense(const Surroundings& around, algo::Observation& observation) override {
    algo::ChannelReading& reading = observation.channels.append();
    reading.channel = number_;
    reading.stamp = observation.stamp;
    if (!sensor_->read(around, reading.values)) observation.channels.pop_back();
  }

 private:
  std::uint8_t number_ = 0;
  std::unique_ptr<ChannelSensor> sensor_;
};

}  // namespace

std::vector<std::unique_ptr<Sensor>> make_sensors(const RobotModel& robot, std::uint64_t seed) {
  const Sensors& made_of = robot.sensors;
  std::vector<std::unique_ptr<Sensor>> sensors;
  for (std::uint32_t i = 0; i < made_of.lasers.size(); ++i) {
    sensors.push_back(std::make_unique<LaserModel>(made_of.lasers[i], seed, i));
  }
  if (made_of.sonar) {
    sensors.push_back(std::make_unique<SonarModel>(*made_of.sonar, hull_of(robot), seed));
  }
  for (std::uint32_t i = 0; i < made_of.infrared.size(); ++i) {
    sensors.push_back(std::make_unique<InfraredModel>(made_of.infrared[i], seed, i));
  }
  if (made_of.floor) sensors.push_back(std::make_unique<FloorSensorModel>(*made_of.floor, seed));
  if (made_of.bumpers > 0) {
    sensors.push_back(std::make_unique<BumperRing>(made_of.bumpers, robot.radius));
  }
  if (made_of.inclinometer) {
    sensors.push_back(std::make_unique<InclinometerModel>(*made_of.inclinometer, seed));
  }
  if (made_of.line_camera) {
    sensors.push_back(std::make_unique<LineCameraModel>(*made_of.line_camera, seed));
  }
  for (std::size_t i = 0; i < made_of.further.size(); ++i) {
    sensors.push_back(std::make_unique<Channel>(static_cast<std::uint8_t>(i),
                                                make_sensor(made_of.further[i], seed + i)));
  }
  return sensors;
}

}  // namespace sim
