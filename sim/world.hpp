// sim/world.hpp: the simulated robot: a scenario and a seed in, observations out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algo/local_localization.hpp"
#include "algo/robot.hpp"
#include "sim/drive_errors.hpp"
#include "sim/gyro_model.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/scenario.hpp"
#include "sim/sensor.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// One of several robots as the others meet it.
struct Peer {
  algo::Pose2 pose_W{};
  double radius = 0;                     // [m] of a circle about its middle
  const algo::Obstacle* body = nullptr;  // its shape
};

/// A robot in a world of obstacles, with dynamics or without (Scenario::vehicle).
///
/// The same scenario, seed, commands and edits give the same observations bit for bit. reset()
/// starts the scenario anew: obstacles, noise and time as at first. Belongs to one thread.
///
/// The scenario's other robots are not in it: a Fleet keeps a world for each robot and tells it
/// where the others are.
class World final : public algo::Robot, public algo::Editing {
 public:
  /// Throws std::invalid_argument with a sentence when the scenario cannot be run.
  World(const Scenario& scenario, std::uint64_t seed);

  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;

  // reset() and step() in parts, for a robot among others.

  /// The scenario anew; nothing is sensed.
  void restart() {
    if (used_) start();
  }
  /// What the next advance() drives under.
  void write(const algo::Command& command) { command_ = command; }
  /// One period of driving; nothing is sensed.
  void advance();
  /// What the robot senses now. Once after each restart() and advance().
  void read(algo::Observation& observation) { sense(observation); }
  /// Places the others of `robots` where they are now; this one is `self` among them. Those too far
  /// to be sensed or touched are left out. Between restart() or advance() and read().
  void meet(std::span<const Peer> robots, std::size_t self);
  /// Which of `robots` the newest contact is with.
  std::optional<std::size_t> touched() const { return touched_; }
  /// Another robot drove against this one.
  void touch() { bumped_ = true; }
  const algo::Pose2& pose_W() const { return vehicle_->state().pose_W; }
  const Hull& hull() const { return hull_; }

  void stop() noexcept override { vehicle_->halt(); }
  algo::Editing* editing() override { return this; }
  std::optional<std::string> edit(const algo::Request& request) override;
  /// Why edit() would refuse `request`, as a sentence.
  std::optional<std::string> objection(const algo::Request& request) const;
  std::optional<algo::GroundTruth> ground_truth() const override;
  void find_moved(algo::Recycled<algo::Moved>& moved) const override;

 private:
  void check() const;
  void start();
  void start_localization(const algo::Pose2& pose_W);
  std::optional<std::string> objection(const algo::MoveObstacle& move) const;
  std::optional<std::string> refusal(const algo::Obstacle& obstacle) const;
  void insert(const algo::Obstacle& obstacle);
  void remove(std::uint32_t id);
  void follow_paths(double now);
  void place(std::size_t index, const algo::Pose2& pose_W);
  void show(std::uint32_t id, const algo::Pose2& pose_W);
  std::size_t free_slot(const algo::Obstacle& robot);
  void place_peer(std::size_t slot, const algo::Pose2& pose_W);
  void hide_peer(std::size_t slot);
  void find_slots();
  double sight() const;
  void feel_peers();
  bool contact() const { return bumped_ || vehicle_->state().contact; }
  void sense(algo::Observation& observation);
  void sense_motion(algo::Observation& observation);
  void sense_turn(algo::Observation& observation);

  /// An obstacle that stands for one of the robots near, whichever needs it.
  struct Slot {
    std::uint32_t id = 0;   // of the obstacle
    std::size_t index = 0;  // in the ObstacleSet
    bool taken = false;
    bool solid = false;  // so near that the vehicle knows it
  };
  static constexpr std::size_t kNoSlot = std::numeric_limits<std::size_t>::max();

  Scenario scenario_{};
  std::uint64_t seed_ = 0;
  RobotModel robot_{};
  Hull hull_{};
  algo::RobotSpec spec_{};

  ObstacleSet obstacles_{};
  std::unique_ptr<VehicleModel> vehicle_{};
  std::vector<std::unique_ptr<Sensor>> sensors_{};
  std::optional<GyroModel> gyro_{};
  algo::LocalLocalization localization_{};
  std::unique_ptr<PoseTrail> trail_{};
  DriveErrors errors_;
  algo::Odometry odometry_{};  // without the drift
  algo::Pose2 wheels_W_{};     // with it, by the wheels alone
  algo::Pose2 sensed_W_{};     // the true pose at the tick before
  algo::Encoders encoders_{};
  std::uint64_t tick_ = 0;
  algo::Command command_{};

  double sight_ = 0;  // [m] from R to the farthest point that a sensor reaches
  std::vector<Slot> slots_{};
  std::vector<std::size_t> slot_of_{};  // of each robot, or kNoSlot
  std::vector<std::size_t> close_{};    // robots whose slot is solid
  std::optional<std::size_t> touched_{};
  bool bumped_ = false;  // by another robot, within the tick
  bool used_ = false;    // something happened since start()
};

/// `robot` as others see it: its hull, as high as its highest sensor where that is higher.
algo::Obstacle robot_body(const RobotModel& robot, const algo::Pose2& pose_W);

}  // namespace sim
