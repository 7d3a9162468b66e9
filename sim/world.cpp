// sim/world.cpp: one tick of the simulated robot, and the edits of its world.
#include "sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "algo/diff_drive.hpp"
#include "algo/pose_step.hpp"
#include "sim/bullet_vehicle.hpp"
#include "sim/kinematic_vehicle.hpp"

namespace sim {
namespace {

constexpr double kLongestPeriod = 1.0;    // [s]
constexpr double kShortestPeriod = 1e-3;  // [s]
constexpr double kGyroRest = 2.0;         // [s] at rest before a run, for the gyro's bias
constexpr std::uint32_t kMostBumpers = 8;

bool finite(const algo::Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading);
}

/// `vehicle` with the limits that `drive` gives instead of its own.
VehicleParameters limited(VehicleParameters vehicle, const DriveConfig& drive) {
  vehicle.max_v = drive.max_v.value_or(vehicle.max_v);
  vehicle.max_omega = drive.max_omega.value_or(vehicle.max_omega);
  vehicle.max_acceleration = drive.max_acceleration.value_or(vehicle.max_acceleration);
  vehicle.max_angular_acceleration =
      drive.max_angular_acceleration.value_or(vehicle.max_angular_acceleration);
  return vehicle;
}

/// Counts of an encoder after `angle` [rad] of its wheel, modulo 2^32.
std::uint32_t counts(double angle, double per_turn) {
  const double whole = std::floor(angle * per_turn / (2 * std::numbers::pi));
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
}

}  // namespace

bool has_laser(const Scenario& scenario) {
  // A scanner that looks back says nothing about the way ahead.
  const bool looks_ahead = std::ranges::any_of(scenario.lasers, [](const LaserConfig& laser) {
    return std::abs(laser.mount_R.heading) <= std::numbers::pi / 2;
  });
  return looks_ahead || !scenario.sonar;
}

World::World(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      seed_(seed),
      parameters_(limited(vehicle_named(scenario.robot), scenario.drive)),
      hull_(hull_of(parameters_)),
      errors_(scenario.drive, seed) {
  check();
  spec_ = {.name = std::string(parameters_.name),
           .radius = parameters_.radius,
           .half_length = hull_.half_length,
           .half_width = hull_.half_width,
           .half_track = parameters_.half_track,
           .period = scenario_.period,
           .max_v = parameters_.max_v,
           .max_omega = parameters_.max_omega,
           .max_acceleration = parameters_.max_acceleration,
           .max_angular_acceleration = parameters_.max_angular_acceleration,
           .command_delay = scenario_.period * scenario_.drive.delay_ticks,
           .drives = true};
  spec_.has_laser = has_laser(scenario_);
  for (const SensorConfig& config : scenario_.sensors) {
    spec_.channels.push_back(channel_of(config));
  }
  sight_ = sight();
  start();
}

/// Refuses what no world can be made of; obstacles are looked at as they are added.
void World::check() const {
  const double period = scenario_.period;
  if (!(period >= kShortestPeriod && period <= kLongestPeriod)) {
    throw std::invalid_argument("The scenario's period must be 0.001 to 1 s.");
  }
  if (!finite(scenario_.start)) {
    throw std::invalid_argument("The scenario's start must be finite numbers.");
  }
  if (const auto problem = defect(scenario_.drive)) {
    throw std::invalid_argument("The scenario's drive: " + *problem + ".");
  }
  if (scenario_.bumpers > kMostBumpers) {
    throw std::invalid_argument("The scenario's bumpers must be 0 to 8.");
  }
  if (scenario_.sensors.size() > kMostSensors) {
    throw std::invalid_argument("The scenario may have 16 further sensors at most.");
  }
  for (const SensorConfig& config : scenario_.sensors) {
    if (const auto problem = defect(config)) {
      throw std::invalid_argument("The scenario's sensor " + config.channel + ": " + *problem +
                                  ".");
    }
  }
  const bool has_gyro =
      scenario_.has_gyro && (scenario_.gyro || scenario_.vehicle == Vehicle::Bullet);
  if (scenario_.localization == Localization::Gyro && !has_gyro) {
    throw std::invalid_argument("The scenario's localization needs a gyro.");
  }
}

/// Everything as the scenario says, at time 0.
void World::start() {
  obstacles_.clear();
  lasers_.clear();
  if (scenario_.vehicle == Vehicle::Bullet) {
    vehicle_ = std::make_unique<BulletVehicle>(parameters_, scenario_.period);
  } else {
    vehicle_ =
        std::make_unique<KinematicVehicle>(parameters_, scenario_.period, scenario_.drive.ramps);
  }
  algo::Pose2 pose = scenario_.start;
  pose.heading = algo::wrap_angle(pose.heading);
  vehicle_->reset(pose);
  errors_ = DriveErrors(scenario_.drive, seed_);
  errors_.reset(pose);

  double memory = 0;
  for (const LaserConfig& config : scenario_.lasers) {
    lasers_.emplace_back(config, seed_, static_cast<std::uint32_t>(lasers_.size()));
    memory = std::max(memory, lasers_.back().memory());
  }
  sonar_.reset();
  if (scenario_.sonar) {
    sonar_.emplace(*scenario_.sonar, parameters_.radius, seed_);
    memory = std::max(memory, scenario_.sonar->ping);
  }
  infrared_.clear();
  for (const InfraredConfig& config : scenario_.infrared) {
    infrared_.emplace_back(config, seed_, static_cast<std::uint32_t>(infrared_.size()));
    memory = std::max(memory, config.period);
  }
  sensors_.clear();
  for (const SensorConfig& config : scenario_.sensors) {
    sensors_.push_back(make_sensor(config, seed_ + sensors_.size()));
  }
  start_localization(pose);
  const Substeps substeps(scenario_.period);
  trail_ = std::make_unique<PoseTrail>(substeps.length, memory + scenario_.period);
  trail_->reset(pose, 0);

  slots_.clear();
  slot_of_.clear();
  for (const algo::Obstacle& obstacle : scenario_.obstacles) {
    if (const auto problem = objection(algo::AddObstacle{obstacle})) {
      throw std::invalid_argument(*problem);
    }
    insert(obstacle);
  }
  follow_paths(0);
  tick_ = 0;
  command_ = {};
  touched_.reset();
  bumped_ = false;
  odometry_ = {.pose = pose};
  encoders_ = {};
  used_ = false;
}

/// As a driver does it: the gyro's bias is taken before the run, while the robot is known to stand.
void World::start_localization(const algo::Pose2& pose_W) {
  wheels_W_ = pose_W;
  sensed_W_ = pose_W;
  gyro_.reset();
  if (scenario_.has_gyro && scenario_.gyro) gyro_.emplace(*scenario_.gyro, seed_);
  localization_ = {};
  if (scenario_.localization == Localization::Gyro && gyro_) {
    const auto readings = static_cast<int>(kGyroRest / scenario_.period);
    for (int k = 0; k < readings; ++k) {
      localization_.update({}, gyro_->read(0, scenario_.period), scenario_.period);
    }
  }
  localization_.reset(pose_W);
}

void World::restart() {
  if (used_) start();
}

void World::reset(algo::Observation& observation) {
  restart();
  read(observation);
}

bool World::step(const algo::Command& command, algo::Observation& observation) {
  write(command);
  advance();
  read(observation);
  return true;
}

void World::advance() {
  used_ = true;
  ++tick_;
  follow_paths(static_cast<double>(tick_) * scenario_.period);
  vehicle_->drive(errors_.act(command_.base), obstacles_, *trail_);
}

/// Obstacles that move by themselves go where they are at `now`, whoever stands there.
void World::follow_paths(double now) {
  for (const ObstaclePath& path : scenario_.paths) {
    const auto index = obstacles_.find(path.id);
    if (!index) continue;  // somebody removed it
    const algo::Vec2 at_W = path.at(now);
    place(*index, {at_W.x(), at_W.y(), obstacles_[*index].pose_W.heading});
  }
}

void World::find_moved(algo::Recycled<algo::Moved>& moved) const {
  moved.clear();
  for (const ObstaclePath& path : scenario_.paths) {
    if (const auto index = obstacles_.find(path.id)) {
      moved.push_back({path.id, obstacles_[*index].pose_W});
    }
  }
}

void World::sense(algo::Observation& observation) {
  used_ = true;  // the scanners have drawn their noise
  const double now = static_cast<double>(tick_) * scenario_.period;
  observation.clear_sensors();
  observation.stamp = now;
  sense_motion(observation);
  for (LaserModel& laser : lasers_) {
    if (!laser.sense(now, *trail_, observation.scans.append())) observation.scans.pop_back();
  }
  if (sonar_) sonar_->sense(now, *trail_, observation.sonar);
  for (InfraredModel& scanner : infrared_) scanner.sense(now, *trail_, observation.infrared);
  sense_contact(observation);
  sense_channels(observation);
}

/// Odometry as a driver computes it from the counts of its encoders (equations.md I); without
/// dynamics, as the papers have it, the true pose.
void World::sense_motion(algo::Observation& observation) {
  const double now = observation.stamp;
  const VehicleState& state = vehicle_->state();
  const std::uint32_t left = counts(state.left_angle, parameters_.counts_per_turn);
  const std::uint32_t right = counts(state.right_angle, parameters_.counts_per_turn);
  if (scenario_.vehicle == Vehicle::Kinematic) {
    odometry_.pose = state.pose_W;
    odometry_.twist = state.twist;
  } else {
    const algo::DriveGeometry geometry{parameters_.wheel_radius, parameters_.half_track};
    const algo::WheelCounts moved{algo::count_difference(left, encoders_.left),
                                  algo::count_difference(right, encoders_.right)};
    odometry_.pose =
        algo::integrate_counts(geometry, parameters_.counts_per_turn, odometry_.pose, moved);
    const double radians = 2 * std::numbers::pi / parameters_.counts_per_turn / scenario_.period;
    odometry_.twist = algo::forward_kinematics(
        geometry,
        {static_cast<double>(moved.left) * radians, static_cast<double>(moved.right) * radians});
    observation.inclinometer = algo::Inclinometer{now, state.roll, state.pitch};
  }
  odometry_.stamp = now;
  encoders_ = {now, left, right};
  observation.odometry = errors_.report(odometry_);
  if (scenario_.encoders) observation.encoders = encoders_;
  sense_turn(observation);
}

/// The gyro, and the odometry made of it where the scenario has it so. A gyro of the scenario's own
/// reads the mean rate since the tick before.
void World::sense_turn(algo::Observation& observation) {
  const VehicleState& state = vehicle_->state();
  const double turned = algo::wrap_angle(state.pose_W.heading - sensed_W_.heading);
  sensed_W_ = state.pose_W;
  const algo::Pose2 wheels_R = algo::pose_step(wheels_W_, observation.odometry.pose);
  wheels_W_ = observation.odometry.pose;
  if (gyro_) {
    const double rate = gyro_->read(turned / scenario_.period, scenario_.period);
    observation.gyro = algo::YawGyro{observation.stamp, rate};
  } else if (scenario_.has_gyro && scenario_.vehicle == Vehicle::Bullet) {
    observation.gyro = algo::YawGyro{observation.stamp, state.twist.omega};
  }
  if (scenario_.localization != Localization::Gyro) return;
  const double rate = observation.gyro->rate;
  if (tick_ > 0) localization_.update(wheels_R, rate, scenario_.period);
  observation.odometry.pose = localization_.pose_W();
  observation.odometry.twist.omega = rate - localization_.bias();
}

/// [rad] In R, of the surface nearest to the robot's centre: against the slope of the distance.
double World::contact_bearing() const {
  constexpr double kStep = 1e-4;  // [m]
  const algo::Pose2& pose_W = vehicle_->state().pose_W;
  const algo::Vec2 p_W = pose_W.position();
  const auto slope = [&](const algo::Vec2& step) {
    return obstacles_.distance(p_W + step) - obstacles_.distance(p_W - step);
  };
  const double bearing = std::atan2(-slope({0, kStep}), -slope({kStep, 0}));
  return algo::wrap_angle(bearing - pose_W.heading);
}

/// A contact presses the bumper whose share of the hull it lies in.
void World::sense_contact(algo::Observation& observation) {
  if (scenario_.bumpers == 0) return;
  const bool contact = this->contact();
  const double share = 2 * std::numbers::pi / scenario_.bumpers;
  const double bearing = contact && scenario_.bumpers > 1 ? contact_bearing() : 0;
  const auto pressed =
      static_cast<std::uint32_t>(std::lround(bearing / share) + scenario_.bumpers) %
      scenario_.bumpers;
  for (std::uint32_t k = 0; k < scenario_.bumpers; ++k) {
    const double heading = algo::wrap_angle(share * k);
    const algo::Vec2 place = parameters_.radius * algo::direction(heading);
    observation.bumpers.append() = {.mount_R = {place.x(), place.y(), heading},
                                    .stamp = observation.stamp,
                                    .pressed = contact && k == pressed};
  }
}

void World::sense_channels(algo::Observation& observation) {
  const Surroundings around{observation.stamp, vehicle_->state(), obstacles_};
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    algo::ChannelReading& reading = observation.channels.append();
    reading.channel = static_cast<std::uint8_t>(i);
    reading.stamp = observation.stamp;
    if (!sensors_[i]->sense(around, reading.values)) observation.channels.pop_back();
  }
}

std::optional<algo::GroundTruth> World::ground_truth() const {
  const VehicleState& state = vehicle_->state();
  const double distance = obstacles_.distance(state.pose_W.position());
  const double clearance = hull_.half_length > 0 ? obstacles_.clearance(hull_, state.pose_W)
                                                 : distance - parameters_.radius;
  return algo::GroundTruth{.pose = state.pose_W,
                           .obstacle_distance = distance,
                           .clearance = clearance,
                           .collided = contact() || clearance < 0};
}

}  // namespace sim
