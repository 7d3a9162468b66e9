// sim/world.hpp: the simulated robot: turns a scenario and a seed into observations.
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
#include "sim/arm_reach.hpp"
#include "sim/drive_errors.hpp"
#include "sim/gyro_model.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/pose_trail.hpp"
#include "sim/scenario.hpp"
#include "sim/sensor.hpp"
#include "sim/solid_caster.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// One of several robots, as the others perceive it.
struct Peer {
  algo::Pose2 pose_W{};
  double radius = 0;                     // [m] of a circle about its centre
  const algo::Obstacle* body = nullptr;  // its shape
};

/// A robot in a world of obstacles, with or without dynamics (Scenario::vehicle).
///
/// The same scenario, seed, commands and edits give the same observations bit for bit. reset()
/// restarts the scenario with the initial obstacles, noise and time. Use from one thread only.
///
/// The scenario's other robots are not part of it: a Fleet keeps a World for each robot and passes
/// it the poses of the others.
class World final : public algo::Robot, public algo::Editing {
 public:
  /// Throws std::invalid_argument with a sentence if the scenario cannot be run.
  World(const Scenario& scenario, std::uint64_t seed);

  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;

  // The parts of reset() and step(), for a robot among others.

  /// Restarts the scenario; senses nothing.
  void restart() {
    if (used_) start();
  }
  /// Sets the command for the next advance().
  void write(const algo::Command& command) { command_ = command; }
  /// Drives for one period; senses nothing.
  void advance();
  /// Reads all sensors now. Call once after each restart() and advance().
  void read(algo::Observation& observation) { sense(observation); }
  /// Places the other robots of `robots` at their present poses; this one has the index `self`.
  /// Leaves out robots too far away to be sensed or touched. Call between restart() or advance()
  /// and read().
  void meet(std::span<const Peer> robots, std::size_t self);
  /// The robot of `robots` in the newest contact.
  std::optional<std::size_t> touched() const { return touched_; }
  /// Records that another robot drove against this one.
  void touch() { bumped_ = true; }
  const algo::Pose2& pose_W() const { return vehicle_->state().pose_W; }
  const Hull& hull() const { return hull_; }
  /// True if the robot lies on its side or its back.
  bool overturned() const { return vehicle_->state().overturned(); }
  const VehicleState& state() const { return vehicle_->state(); }

  void stop() noexcept override { vehicle_->halt(); }
  algo::Editing* editing() override { return this; }
  std::optional<std::string> edit(const algo::Request& request) override;
  /// Why edit() would refuse `request`, as a sentence.
  std::optional<std::string> objection(const algo::Request& request) const;
  std::optional<algo::GroundTruth> ground_truth() const override;
  void find_moved(algo::Recycled<algo::Moved>& moved) const override;

 private:
  /// An obstacle that represents a near robot; reused for any robot.
  struct Slot {
    std::uint32_t id = 0;   // of the obstacle
    std::size_t index = 0;  // in the ObstacleSet
    bool taken = false;
    bool solid = false;  // near enough for the vehicle to know it
  };
  /// An obstacle that follows a path.
  struct Mover {
    std::uint32_t id = 0;
    std::size_t index = 0;  // in the ObstacleSet
    bool there = true;
  };

  void check() const;
  void start();
  void start_localization(const algo::Pose2& pose_W);
  std::optional<std::string> objection(const algo::MoveObstacle& move) const;
  std::optional<std::string> refusal(const algo::Obstacle& obstacle) const;
  std::optional<std::string> carried(std::uint32_t id) const;
  bool under_robot(const algo::Obstacle& obstacle) const;
  void insert(const algo::Obstacle& obstacle);
  void remove(std::uint32_t id);
  double now() const { return static_cast<double>(tick_) * scenario_.period; }  // [s, run clock]
  void follow_paths();
  void hide(Mover& mover);
  void place(std::size_t index, const algo::Pose2& pose_W);
  void show(std::uint32_t id, const algo::Pose2& pose_W);
  std::size_t free_slot(const algo::Obstacle& robot);
  void place_peer(std::size_t slot, const algo::Pose2& pose_W);
  void hide_peer(std::size_t slot);
  void find_indices();
  double sight() const;
  void feel_peers();
  bool contact() const { return bumped_ || vehicle_->state().contact; }
  void sense(algo::Observation& observation);
  void sense_motion(algo::Observation& observation);
  void sense_turn(algo::Observation& observation);
  void add_arm(algo::GroundTruth& truth) const;

  static constexpr std::size_t kNoSlot = std::numeric_limits<std::size_t>::max();

  Scenario scenario_{};
  std::uint64_t seed_ = 0;
  RobotModel robot_{};
  Hull hull_{};
  algo::RobotSpec spec_{};

  ObstacleSet obstacles_;
  std::optional<ArmReach> reach_{};        // of a robot with an arm
  std::unique_ptr<SolidCaster> solids_{};  // all obstacles, while the ground is not level
  std::vector<Mover> movers_{};
  std::unique_ptr<VehicleModel> vehicle_{};
  std::vector<std::unique_ptr<Sensor>> sensors_{};
  std::optional<GyroModel> gyro_{};
  algo::LocalLocalization localization_{};
  std::unique_ptr<PoseTrail> trail_{};
  DriveErrors errors_;
  algo::Odometry odometry_{};  // without drift
  algo::Pose2 wheels_W_{};     // with drift, by the wheels alone
  algo::Pose2 sensed_W_{};     // the true pose at the previous tick
  algo::Encoders encoders_{};
  std::uint64_t tick_ = 0;
  algo::Command command_{};

  double sight_ = 0;  // [m] from R to the farthest point that a sensor reaches
  std::vector<Slot> slots_{};
  std::vector<std::size_t> slot_of_{};  // by robot, or kNoSlot
  std::vector<std::size_t> close_{};    // robots whose slot is solid
  std::optional<std::size_t> touched_{};
  bool bumped_ = false;  // touched by another robot in this tick
  bool used_ = false;    // changed since start()
  bool starting_ = false;
};

/// `robot` as others perceive it: its hull, raised to its highest sensor if that is higher.
algo::Obstacle robot_body(const RobotModel& robot, const algo::Pose2& pose_W);

}  // namespace sim
