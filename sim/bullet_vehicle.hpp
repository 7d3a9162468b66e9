// sim/bullet_vehicle.hpp: a base with mass, friction and contacts, in a Bullet world of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "sim/bullet_arm.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/drive_constraint.hpp"
#include "sim/physics.hpp"
#include "sim/vehicle.hpp"

namespace sim {

/// A rigid chassis on frictionless support balls; all traction comes from a DriveConstraint
/// (physics.md 3). Commands pass through the acceleration limits. A standing vehicle is parked: no
/// step is computed and its state stays the same bit for bit.
class BulletVehicle final : public VehicleModel {
 public:
  static constexpr double kNear = 1.0;  // [m] beyond the hull: obstacles in the dynamics

  BulletVehicle(const RobotModel& robot, double period);
  ~BulletVehicle() override;

  void reset(const algo::Pose2& start) override;
  void stand_on(const ObstacleSet& ground) override;
  void drive(const algo::Twist2& command, const ObstacleSet& obstacles, PoseTrail& trail) override;
  void turn_joints(const algo::JointValues& rates) override { joint_rates_ = rates; }
  void halt() noexcept override {
    joint_rates_ = {};
    if (!robot_.sensors.inclinometer) target_ = {};
  }
  /// Null for a robot without an arm.
  const BulletArm* arm() const { return arm_.get(); }
  const btTransform& chassis_W() const { return chassis_->getWorldTransform(); }
  /// Turns gravity with the robot so that a level floor acts as a slope: at each heading the robot
  /// feels the roll `roll` [rad]. For experiments.
  void lean(double roll) { lean_ = roll; }
  const VehicleState& state() const override { return state_; }

  void added(const algo::Obstacle& obstacle) override { physics_.added(obstacle); }
  void moved(std::size_t index, const algo::Obstacle& obstacle) override {
    physics_.moved(index, obstacle);
  }
  void removed(std::size_t index) override { physics_.removed(index); }

 private:
  /// A wheel or caster, and the ground that it has passed.
  struct Support {
    btVector3 centre{0, 0, 0};     // in the body's frame
    double radius = 0;             // [m]
    double ground = 0;             // [m] height of the ground under it
    std::optional<double> edge{};  // [m] of the ground before a drop that it has not come back from
  };

  void take_down();
  void build_chassis();
  void settle();
  void substep();
  void read_arm(const algo::JointValues& before);
  bool arm_rests() const;
  void read_contacts();
  void read_state();
  void update_parking();
  void watch_falls(const ObstacleSet& obstacles);
  void set_on(const algo::Pose2& pose_W, const btVector3& normal, double height);
  algo::Pose2 pose() const;

  RobotModel robot_{};
  Substeps substeps_;
  VehicleState state_{};

  Physics physics_;
  std::vector<BulletPtr<btCollisionShape>> parts_{};  // of the chassis: hull, supports, casters
  BulletPtr<btCompoundShape> chassis_shape_{};
  BulletPtr<btRigidBody> chassis_{};
  BulletPtr<DriveConstraint> drive_{};
  std::unique_ptr<BulletArm> arm_{};
  algo::JointValues joint_rates_{};

  algo::Twist2 wanted_{};
  algo::Twist2 target_{};  // wanted_ after the acceleration limits
  double left_load_ = 0;   // [N] low-passed
  double right_load_ = 0;
  btVector3 normal_{0, 0, 1};
  double still_for_ = 0;  // [s]
  bool parked_ = false;
  double lean_ = 0;                  // [rad]
  bool level_ = true;                // no ramp or trench is in the world
  std::vector<Support> supports_{};  // wheels, then casters
};

}  // namespace sim
