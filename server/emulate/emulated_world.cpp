// server/emulate/emulated_world.cpp: steps the physics and serves the devices between steps.
#include "server/emulate/emulated_world.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "algo/diff_drive.hpp"
#include "server/emulate/clock.hpp"

namespace server::emulate {
namespace {

/// The scenario for the world under the devices: the same physics steps and delays, and no sensors
/// except encoders and contacts.
sim::Scenario bare(sim::Scenario scenario) {
  const sim::Substeps substeps(scenario.period);
  scenario.period = substeps.length;
  scenario.drive.delay_ticks *= static_cast<std::uint32_t>(substeps.count);
  scenario.robot.sensors.lasers.clear();
  scenario.robot.sensors.sonar.reset();
  return scenario;
}

/// Those of the scenario's robot, or usual ones.
algo::FloorSensors floor_sensors(const algo::RobotSpec& robot) {
  const double front = robot.half_length > 0 ? robot.half_length : robot.radius;
  return robot.floor.value_or(usual_floor_sensors(front));
}

constexpr double kMadeGood = 0.5;  // [s] of delayed steps to make up for on a busy computer

double metres_per_count(const sim::RobotModel& robot) {
  return 2 * std::numbers::pi * robot.wheel_radius / robot.counts_per_turn;
}

}  // namespace

EmulatedWorld::EmulatedWorld(const sim::Scenario& scenario,
                             std::uint64_t seed,
                             Links links,
                             TruthRecord& record)
    : scenario_(scenario),
      links_(std::move(links)),
      record_(record),
      metres_per_count_(metres_per_count(scenario.robot)),
      world_(bare(scenario), seed),
      trail_(sim::Substeps(scenario.period).length, Mirror::memory() + scenario.period),
      sonars_(scenario),
      floor_(scenario, floor_sensors(world_.spec())) {
  if (!scenario.robots.empty()) {
    throw std::invalid_argument(
        "Devices can be emulated for one robot only; this scenario has several robots.");
  }
  for (std::uint32_t i = 0; i < links_.scanners.size(); ++i) {
    mirrors_.emplace_back(scenario_, seed, i);
  }
}

void EmulatedWorld::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

EmulatedWorld::Truth EmulatedWorld::truth() const {
  const std::lock_guard held(mutex_);
  return truth_;
}

void EmulatedWorld::run(const std::stop_token& stop) {
  algo::Observation observation;
  world_.reset(observation);
  trail_.reset(world_.ground_truth()->pose, 0);
  const double period = world_.spec().period;
  double due = machine_time();
  while (!stop.stop_requested()) {
    due += period;
    const double late = machine_time() - due;
    if (late > kMadeGood) {
      const double skipped = std::floor(late / period);
      due += skipped * period;
      missed_ += static_cast<std::uint64_t>(skipped);
    }
    sleep_until(due);
    world_.step(command(), observation);
    const algo::GroundTruth truth = *world_.ground_truth();
    trail_.push(truth.pose);
    feel(observation, truth.pose, due);
    look(observation.stamp);
    look_at_floor(observation.stamp, truth);
    note(observation.stamp, truth);
  }
}

/// The motion of the base's motors as a twist for the vehicle.
algo::Command EmulatedWorld::command() {
  if (!links_.base) return {};
  const auto held = links_.base->connection->lock();
  motion_ = links_.base->device->turn(machine_time());
  return {.base = algo::twist_of({motion_.left, motion_.right}, world_.spec().half_track)};
}

/// `due` [s] of machine_time(): the nominal end of the step, even if it ran late.
void EmulatedWorld::feel(const algo::Observation& observation,
                         const algo::Pose2& pose_W,
                         double due) {
  if (!links_.base) return;
  const algo::Encoders& now = *observation.encoders;
  const auto rolled = [this](std::uint32_t count, std::uint32_t before) {
    return static_cast<double>(algo::count_difference(count, before)) * metres_per_count_;
  };
  const double left = rolled(now.left, encoders_.left);
  const double right = rolled(now.right, encoders_.right);
  encoders_ = now;
  senses_.left_travel += left;
  senses_.right_travel += right;
  // A step is only a few counts, so speeds are smoothed over several steps.
  constexpr double kWeight = 0.2;
  const double period = world_.spec().period;
  senses_.motion.left += kWeight * (left / period - senses_.motion.left);
  senses_.motion.right += kWeight * (right / period - senses_.motion.right);
  if (std::abs(senses_.motion.left) < 1e-6) senses_.motion.left = 0;
  if (std::abs(senses_.motion.right) < 1e-6) senses_.motion.right = 0;
  senses_.front_bumper = observation.bumper_pressed();
  senses_.echoes.clear();
  sonars_.sense(observation.stamp, pose_W, senses_.echoes);
  const auto held = links_.base->connection->lock();
  links_.base->device->sense(senses_, due);
}

void EmulatedWorld::look(double now) {
  for (std::size_t i = 0; i < mirrors_.size(); ++i) {
    const auto& [device, connection] = links_.scanners[i];
    const auto held = connection->lock();
    mirrors_[i].sense(device->sweep(),
                      now,
                      trail_,
                      [&](const algo::LaserScan& scan, std::optional<std::uint8_t> part) {
                        device->offer(scan, machine_time(), part);
                        connection->wake();
                      });
  }
}

void EmulatedWorld::look_at_floor(double now, const algo::GroundTruth& truth) {
  if (!links_.floor) return;
  const auto metres = floor_.sense(now, truth.pose, truth.tilt.value_or(algo::Tilt{}));
  const auto held = links_.floor->connection->lock();
  links_.floor->device->sense(metres);
}

void EmulatedWorld::note(double now, const algo::GroundTruth& truth) {
  constexpr double kEvery = 0.1;  // [s]
  {
    const std::lock_guard held(mutex_);
    truth_ = {.time = now,
              .pose_W = truth.pose,
              .clearance = truth.clearance,
              .collided = truth_.collided || truth.collided,
              .missed = missed_};
  }
  if (now < next_note_) return;
  next_note_ += kEvery;
  record_.pose(machine_time(), truth.pose, motion_);
}

}  // namespace server::emulate
