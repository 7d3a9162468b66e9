// sim/drive_constraint.cpp: fills the solver's rows.
#include "sim/drive_constraint.hpp"

namespace sim {
namespace {

constexpr btScalar kUpright = 1e-6;  // square of the x axis along the ground

}  // namespace

DriveConstraint::DriveConstraint(btRigidBody& chassis, btRigidBody& ground, const Layout& layout)
    : btTypedConstraint(D6_CONSTRAINT_TYPE, chassis, ground), layout_(layout) {}

void DriveConstraint::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 3;
  info->nub = 3;
}

/// | row     | along              | at                | target | impulse limit       |
/// | left    | t_x                | (x_d, +l, -h)     | left   | mu N_left dt        |
/// | right   | t_x                | (x_d, -l, -h)     | right  | mu N_right dt       |
/// | lateral | t_y = n x t_x      | (x_d, y_N, -h)    | 0      | mu (N_l + N_r) dt   |
///
/// t_x is the body's x axis projected on the contact plane, y_N the load-weighted lateral position.
void DriveConstraint::getInfo2(btConstraintInfo2* info) {
  const btMatrix3x3& basis = getRigidBodyA().getWorldTransform().getBasis();
  const btVector3& n = drive_.normal;
  const btVector3 ahead = basis.getColumn(0);
  btVector3 forward = ahead - n * n.dot(ahead);
  const bool on_its_nose = forward.length2() < kUpright;  // its wheels drive it nowhere
  if (on_its_nose) forward = basis.getColumn(2);
  const btScalar friction = on_its_nose ? 0 : layout_.friction;
  forward.normalize();
  const btVector3 lateral = n.cross(forward);
  const btScalar load = drive_.left_load + drive_.right_load;
  const btScalar balance = load > 0 ? (drive_.left_load - drive_.right_load) / load : 0;

  const auto row = [&](int index, const btVector3& along, btScalar y, btScalar target, btScalar N) {
    const btVector3 r = basis * btVector3(layout_.axle_x, y, -layout_.height);
    const btVector3 lever = r.cross(along);
    const int at = index * info->rowskip;
    for (int axis = 0; axis < 3; ++axis) {
      info->m_J1linearAxis[at + axis] = along[axis];
      info->m_J1angularAxis[at + axis] = lever[axis];
      info->m_J2linearAxis[at + axis] = -along[axis];
      info->m_J2angularAxis[at + axis] = 0;
    }
    const btScalar limit = friction * N / info->fps;
    info->m_constraintError[at] = target;
    info->cfm[at] = 0;
    info->m_lowerLimit[at] = -limit;
    info->m_upperLimit[at] = limit;
  };
  row(0, forward, layout_.half_track, drive_.left, drive_.left_load);
  row(1, forward, -layout_.half_track, drive_.right, drive_.right_load);
  row(2, lateral, layout_.half_track * balance, 0, load);
}

}  // namespace sim
