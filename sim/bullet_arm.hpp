// sim/bullet_arm.hpp: the arm as a Bullet multibody on a moving base, with a motor in each joint.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "algo/arm/mobile_arm.hpp"
#include "sim/arm_model.hpp"
#include "sim/bullet_ptr.hpp"
#include "sim/physics.hpp"

namespace sim {

/// Seven links with masses, whose base follows the chassis: the arm puts no load on the vehicle,
/// which carries its mass (physics.md 7). Each motor turns its joint to a target that moves at the
/// commanded rate, as far as its torque suffices. Touches obstacles, not its own robot.
class BulletArm {
 public:
  /// Adds the arm, at its rest pose, to the world of `physics`, which must be a multibody's.
  BulletArm(const ArmModel& arm, double mass_height, Physics& physics);
  ~BulletArm();
  BulletArm(const BulletArm&) = delete;
  BulletArm& operator=(const BulletArm&) = delete;

  /// Before a physics step of `dt` [s]: follows the chassis and turns the motors at `rates`
  /// [rad/s].
  void prepare(const btRigidBody& chassis, const algo::JointValues& rates, double dt);
  /// Places the arm on the chassis at once, where it stands still.
  void place(const btRigidBody& chassis);

  algo::JointValues position() const;  // [rad]
  /// The link that touches an obstacle or the floor after a step.
  std::optional<algo::BodyLink> touched() const;
  /// Frame `joints` of the arm in W, by Bullet.
  algo::Pose3 frame_W(std::size_t joints) const;
  /// True if all joints are where they should be and stand.
  bool settled() const;

 private:
  void build();
  void add_collider(std::size_t joints,
                    const btVector3& from,
                    const btVector3& to,
                    algo::BodyLink link);
  btTransform shoulder_W(const btRigidBody& chassis) const;

  ArmModel arm_;
  btVector3 shoulder_{0, 0, 0};  // in the chassis' frame
  Physics& physics_;
  BulletPtr<btMultiBody> body_{};
  std::array<btVector3, algo::kArmJoints> centre_{};  // of mass of each link, in its own DH frame
  std::array<BulletPtr<btMultiBodyJointMotor>, algo::kArmJoints> motors_{};
  std::vector<BulletPtr<btCollisionShape>> shapes_{};
  std::vector<BulletPtr<btMultiBodyLinkCollider>> colliders_{};
  algo::JointValues target_{};  // [rad]
};

}  // namespace sim
