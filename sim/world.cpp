// sim/world.cpp: one tick of the simulated robot, and the edits of its world.
#include "sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "algo/diff_drive.hpp"
#include "sim/bullet_vehicle.hpp"
#include "sim/kinematic_vehicle.hpp"

namespace sim {
namespace {

constexpr double kLongestPeriod = 1.0;    // [s]
constexpr double kShortestPeriod = 1e-3;  // [s]
constexpr double kGyroRest = 2.0;         // [s] at rest before a run, to estimate the gyro's bias
constexpr std::uint32_t kMostBumpers = 8;

/// `robot` with the limits of `drive` in place of its own.
RobotModel limited(RobotModel robot, const DriveConfig& drive) {
  robot.max_v = drive.max_v.value_or(robot.max_v);
  robot.max_omega = drive.max_omega.value_or(robot.max_omega);
  robot.max_acceleration = drive.max_acceleration.value_or(robot.max_acceleration);
  robot.max_angular_acceleration =
      drive.max_angular_acceleration.value_or(robot.max_angular_acceleration);
  return robot;
}

/// Encoder counts after `angle` [rad] of its wheel, modulo 2^32.
std::uint32_t counts(double angle, double per_turn) {
  const double whole = std::floor(angle * per_turn / (2 * std::numbers::pi));
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
}

}  // namespace

World::World(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      seed_(seed),
      robot_(limited(scenario.robot, scenario.drive)),
      hull_(hull_of(robot_)),
      obstacles_(robot_.hull_high),
      errors_(scenario.drive, seed) {
  if (robot_.arm) robot_.arm->start = scenario_.joints;
  check();
  spec_ = spec_of(robot_, scenario_.period);
  spec_.command_delay = scenario_.period * scenario_.drive.delay_ticks;
  spec_.drives = true;
  // Without dynamics nothing turns over.
  if (scenario_.physics != PhysicsKind::Bullet) spec_.stance.reset();
  spec_.raw_stick = true;
  spec_.uneven = std::ranges::any_of(scenario_.obstacles, algo::is_ground);
  for (const SensorConfig& config : robot_.sensors.further) {
    spec_.channels.push_back(channel_of(config));
  }
  if (robot_.arm) reach_.emplace(robot_);
  sight_ = sight();
  start();
}

/// Refuses scenarios that no world can be made from; obstacles are checked when added.
void World::check() const {
  const double period = scenario_.period;
  if (!(period >= kShortestPeriod && period <= kLongestPeriod)) {
    throw std::invalid_argument("The scenario's period must be 0.001 to 1 s.");
  }
  if (!finite(scenario_.start)) {
    throw std::invalid_argument("The scenario's start must be finite numbers.");
  }
  checked(robot_, "The scenario's robot");
  if (scenario_.joints && !robot_.arm) {
    throw std::invalid_argument("The scenario's joints need a robot with an arm.");
  }
  checked(scenario_.drive, "The scenario's drive");
  if (robot_.sensors.bumpers > kMostBumpers) {
    throw std::invalid_argument("The scenario's bumpers must be 0 to 8.");
  }
  if (robot_.sensors.further.size() > kMostSensors) {
    throw std::invalid_argument("The scenario may have 16 further sensors at most.");
  }
  for (const SensorConfig& config : robot_.sensors.further) {
    checked(config, "The scenario's sensor " + config.channel);
  }
  const bool has_gyro =
      robot_.sensors.has_gyro && (robot_.sensors.gyro || scenario_.physics == PhysicsKind::Bullet);
  if (scenario_.localization == Localization::Gyro && !has_gyro) {
    throw std::invalid_argument("The scenario's localization needs a gyro.");
  }
}

/// Sets everything to the scenario's state at time 0.
void World::start() {
  starting_ = true;
  tick_ = 0;
  obstacles_.clear();
  solids_.reset();
  movers_.clear();
  if (scenario_.physics == PhysicsKind::Bullet) {
    vehicle_ = std::make_unique<BulletVehicle>(robot_, scenario_.period);
  } else {
    vehicle_ = std::make_unique<KinematicVehicle>(robot_, scenario_.period, scenario_.drive.ramps);
  }
  algo::Pose2 pose = scenario_.start;
  pose.heading = algo::wrap_angle(pose.heading);
  vehicle_->reset(pose);
  errors_ = DriveErrors(scenario_.drive, seed_);
  errors_.reset(pose);

  sensors_ = make_sensors(robot_, seed_);
  double memory = 0;
  for (const auto& sensor : sensors_) memory = std::max(memory, sensor->memory());
  start_localization(pose);
  const bool jointed = robot_.arm && scenario_.physics == PhysicsKind::Bullet;
  const Substeps substeps(scenario_.period, jointed ? robot_.arm->step_rate : Substeps::kRate);
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
  if (solids_) {
    vehicle_->stand_on(obstacles_);
    trail_->tilt(vehicle_->state().tilt());
  }
  follow_paths();
  starting_ = false;
  command_ = {};
  touched_.reset();
  bumped_ = false;
  odometry_ = {.pose = pose};
  encoders_ = {};
  used_ = false;
}

/// Takes the gyro's bias before the run, while the robot is known to stand, as a driver does.
void World::start_localization(const algo::Pose2& pose_W) {
  wheels_W_ = pose_W;
  sensed_W_ = pose_W;
  gyro_.reset();
  if (robot_.sensors.has_gyro && robot_.sensors.gyro) gyro_.emplace(*robot_.sensors.gyro, seed_);
  localization_ = {};
  if (scenario_.localization == Localization::Gyro && gyro_) {
    const auto readings = static_cast<int>(kGyroRest / scenario_.period);
    for (int k = 0; k < readings; ++k) {
      localization_.update({}, gyro_->read(0, scenario_.period), scenario_.period);
    }
  }
  localization_.reset(pose_W);
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
  follow_paths();
  if (robot_.arm) {
    algo::JointValues rates{};
    std::copy_n(command_.joint_rates.begin(), rates.size(), rates.begin());
    vehicle_->turn_joints(rates);
  }
  vehicle_->drive(errors_.act(command_.base), obstacles_, *trail_);
}

/// Moves scripted obstacles to their positions now, even through robots.
void World::follow_paths() {
  const double time = now();
  for (Mover& mover : movers_) {
    const algo::Obstacle& obstacle = obstacles_[mover.index];
    if (obstacle.path->is_there(time)) {
      place(mover.index, pose_at(obstacle, time));
      mover.there = true;
    } else if (mover.there) {
      hide(mover);
    }
  }
}

void World::find_moved(algo::Recycled<algo::Moved>& moved) const {
  moved.clear();
  for (const Mover& mover : movers_) {
    if (mover.there) moved.push_back({mover.id, obstacles_[mover.index].pose_W});
  }
}

void World::sense(algo::Observation& observation) {
  used_ = true;  // the scanners have drawn their noise
  observation.clear_sensors();
  observation.stamp = now();
  sense_motion(observation);
  const Surroundings around{
      now(), vehicle_->state(), *trail_, obstacles_, contact(), solids_.get()};
  for (const auto& sensor : sensors_) sensor->sense(around, observation);
}

/// Odometry as a driver computes it from its encoders' counts (equations.md I). Without dynamics it
/// is the true pose, as in the papers.
void World::sense_motion(algo::Observation& observation) {
  const double now = observation.stamp;
  const VehicleState& state = vehicle_->state();
  const std::uint32_t left = counts(state.left_angle, robot_.counts_per_turn);
  const std::uint32_t right = counts(state.right_angle, robot_.counts_per_turn);
  if (scenario_.physics == PhysicsKind::Kinematic) {
    odometry_.pose = state.pose_W;
    odometry_.twist = state.twist;
  } else {
    observation.inclinometer = algo::Inclinometer{now, state.roll, state.pitch};
    // On a slope the wheels roll a longer way than the map shows: all lengths are scaled, which
    // leaves the turns as they are.
    const double level = solids_ ? std::cos(observation.inclinometer->pitch) : 1;
    const algo::DriveGeometry geometry{
        robot_.wheel_radius * level, robot_.half_track * level, spec_.axle * level};
    const algo::WheelCounts moved{algo::count_difference(left, encoders_.left),
                                  algo::count_difference(right, encoders_.right)};
    odometry_.pose =
        algo::integrate_counts(geometry, robot_.counts_per_turn, odometry_.pose, moved);
    const double radians = 2 * std::numbers::pi / robot_.counts_per_turn / scenario_.period;
    odometry_.twist = algo::forward_kinematics(
        geometry,
        {static_cast<double>(moved.left) * radians, static_cast<double>(moved.right) * radians});
  }
  odometry_.stamp = now;
  encoders_ = {now, left, right};
  observation.odometry = errors_.report(odometry_);
  if (robot_.sensors.encoders) observation.encoders = encoders_;
  if (robot_.arm) observation.joints = algo::JointReading{now, state.arm.position, state.arm.rate};
  sense_turn(observation);
}

/// The gyro, and the odometry with it if the scenario says so. A gyro that the scenario configures
/// reads the mean rate since the previous tick.
void World::sense_turn(algo::Observation& observation) {
  const VehicleState& state = vehicle_->state();
  const double turned = algo::wrap_angle(state.pose_W.heading - sensed_W_.heading);
  sensed_W_ = state.pose_W;
  const algo::Pose2 wheels_R = algo::pose_step(wheels_W_, observation.odometry.pose);
  wheels_W_ = observation.odometry.pose;
  if (gyro_) {
    const double rate = gyro_->read(turned / scenario_.period, scenario_.period);
    observation.gyro = algo::YawGyro{observation.stamp, rate};
  } else if (robot_.sensors.has_gyro && scenario_.physics == PhysicsKind::Bullet) {
    observation.gyro = algo::YawGyro{observation.stamp, state.twist.omega};
  }
  if (scenario_.localization != Localization::Gyro) return;
  const double rate = observation.gyro->rate;
  if (tick_ > 0) localization_.update(wheels_R, rate, scenario_.period);
  observation.odometry.pose = localization_.pose_W();
  observation.odometry.twist.omega = rate - localization_.bias();
}

std::optional<algo::GroundTruth> World::ground_truth() const {
  const VehicleState& state = vehicle_->state();
  const double distance = obstacles_.distance(state.pose_W.position());
  const double clearance =
      hull_.half_length > 0 ? obstacles_.clearance(hull_, state.pose_W) : distance - robot_.radius;
  algo::GroundTruth truth{.pose = state.pose_W,
                          .obstacle_distance = distance,
                          .clearance = clearance,
                          .collided = contact() || clearance < 0,
                          .tilt = solids_ ? std::optional(state.tilt()) : std::nullopt,
                          .overturned = state.overturned(),
                          .fallen = state.fallen};
  if (reach_) add_arm(truth);
  return truth;
}

/// The nearest part of a robot with an arm counts.
void World::add_arm(algo::GroundTruth& truth) const {
  const VehicleState& state = vehicle_->state();
  const NearestPart arm = reach_->nearest(state, obstacles_);
  if (truth.collided) truth.touched = algo::BodyLink::Base;
  if (arm.distance < 0) truth.touched = arm.link;
  if (state.arm.touched) truth.touched = state.arm.touched;
  truth.collided = truth.touched.has_value();
  truth.clearance = std::min(truth.clearance, arm.distance);
}

}  // namespace sim
