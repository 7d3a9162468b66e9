// sim/bullet_vehicle.hpp: a base with mass, friction and contacts, in a Bullet world of its own.
#pragma once

#include <vector>

#include <btBulletDynamicsCommon.h>

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
  void drive(const algo::Twist2& command, const ObstacleSet& obstacles, PoseTrail& trail) override;
  void halt() noexcept override { target_ = {}; }
  const VehicleState& state() const override { return state_; }

  void added(const algo::Obstacle& obstacle) override { physics_.added(obstacle); }
  void moved(std::size_t index, const algo::Obstacle& obstacle) override {
    physics_.moved(index, obstacle);
  }
  void removed(std::size_t index) override { physics_.removed(index); }

 private:
  void take_down();
  void build_chassis();
  void settle();
  void substep();
  void read_contacts();
  void read_state();
  void update_parking();
  algo::Pose2 pose() const;

  RobotModel robot_{};
  Substeps substeps_;
  VehicleState state_{};

  Physics physics_{};
  std::vector<BulletPtr<btCollisionShape>> parts_{};  // of the chassis: hull, supports, casters
  BulletPtr<btCompoundShape> chassis_shape_{};
  BulletPtr<btRigidBody> chassis_{};
  BulletPtr<DriveConstraint> drive_{};

  algo::Twist2 wanted_{};
  algo::Twist2 target_{};  // wanted_ after the acceleration limits
  double left_load_ = 0;   // [N] low-passed
  double right_load_ = 0;
  btVector3 normal_{0, 0, 1};
  double still_for_ = 0;  // [s]
  bool parked_ = false;
};

}  // namespace sim
