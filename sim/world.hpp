// sim/world.hpp: the simulated robot: a scenario and a seed in, observations out.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/local_localization.hpp"
#include "algo/robot.hpp"
#include "sim/drive_errors.hpp"
#include "sim/gyro_model.hpp"
#include "sim/infrared_model.hpp"
#include "sim/laser_model.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/scenario.hpp"
#include "sim/sensor.hpp"
#include "sim/sonar_model.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// A robot in a world of obstacles, with dynamics or without (Scenario::vehicle).
///
/// The same scenario, seed, commands and edits give the same observations bit for bit. reset()
/// starts the scenario anew: obstacles, noise and time as at first. Belongs to one thread.
class World final : public algo::Robot, public algo::Editing {
 public:
  /// Throws std::invalid_argument with a sentence when the scenario cannot be run.
  World(const Scenario& scenario, std::uint64_t seed);

  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;
  void stop() noexcept override { vehicle_->halt(); }
  algo::Editing* editing() override { return this; }
  std::optional<std::string> edit(const algo::Request& request) override;
  std::optional<algo::GroundTruth> ground_truth() const override;
  void find_moved(algo::Recycled<algo::Moved>& moved) const override;

 private:
  void check() const;
  void start();
  void start_localization(const algo::Pose2& pose_W);
  std::optional<std::string> add(const algo::Obstacle& obstacle);
  std::optional<std::string> move(std::uint32_t id, const algo::Pose2& pose_W);
  std::optional<std::string> remove(std::uint32_t id);
  std::optional<std::string> refusal(const algo::Obstacle& obstacle) const;
  void follow_paths(double now);
  void place(std::size_t index, const algo::Pose2& pose_W);
  void sense(algo::Observation& observation);
  void sense_motion(algo::Observation& observation);
  void sense_turn(algo::Observation& observation);
  void sense_contact(algo::Observation& observation);
  void sense_channels(algo::Observation& observation);
  double contact_bearing() const;

  Scenario scenario_{};
  std::uint64_t seed_ = 0;
  VehicleParameters parameters_{};
  Hull hull_{};
  algo::RobotSpec spec_{};

  ObstacleSet obstacles_{};
  std::unique_ptr<VehicleModel> vehicle_{};
  std::vector<LaserModel> lasers_{};
  std::optional<SonarModel> sonar_{};
  std::vector<InfraredModel> infrared_{};
  std::optional<GyroModel> gyro_{};
  std::vector<std::unique_ptr<Sensor>> sensors_{};  // one a channel
  algo::LocalLocalization localization_{};
  std::unique_ptr<PoseTrail> trail_{};
  DriveErrors errors_;
  algo::Odometry odometry_{};  // without the drift
  algo::Pose2 wheels_W_{};     // with it, by the wheels alone
  algo::Pose2 sensed_W_{};     // the true pose at the tick before
  algo::Encoders encoders_{};
  std::uint64_t tick_ = 0;
  bool touched_ = false;  // something happened since start()
};

}  // namespace sim
