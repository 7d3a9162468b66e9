// sim/drive_constraint.hpp: wheels as three velocity constraints on a rigid chassis.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace sim {

static_assert(sizeof(btScalar) == 8, "Tautline needs Bullet built in double precision");

/// Holds a chassis to the speeds of its left and right wheels, and keeps it from sliding sideways,
/// each as far as the load on the wheels allows (physics.md 3). All positions are relative to the
/// centre of mass, in the body's frame.
class DriveConstraint final : public btTypedConstraint {
 public:
  struct Layout {
    btScalar axle_x = 0;      // [m]
    btScalar half_track = 0;  // [m]
    btScalar height = 0;      // [m] of the centre of mass above the contacts
    btScalar friction = 0;
  };
  /// The target of the next step, and the loads available.
  struct Drive {
    btScalar left = 0, right = 0;            // [m/s] wheel speeds over the ground
    btScalar left_load = 0, right_load = 0;  // [N] normal forces
    btVector3 normal{0, 0, 1};               // mean contact normal, W
  };

  DriveConstraint(btRigidBody& chassis, btRigidBody& ground, const Layout& layout);

  void set(const Drive& drive) { drive_ = drive; }

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int /*num*/, btScalar /*value*/, int /*axis*/) override {}
  btScalar getParam(int /*num*/, int /*axis*/) const override { return 0; }

 private:
  Layout layout_{};
  Drive drive_{};
};

}  // namespace sim
