// algo/arm/mobile_arm.hpp: an arm on a mobile base: where its links are, how near they come to
// things, and how a force at one of them moves base and joints.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "algo/arm/arm_chain.hpp"
#include "algo/arm/solid.hpp"

namespace algo {

/// x [m], y [m] and yaw [rad] of R in W, then the joints [rad].
using BodyJoints = Eigen::Matrix<double, 3 + static_cast<int>(kArmJoints), 1>;

BodyJoints body_joints(const Pose2& base_W, const ArmJoints& q);
inline Pose2 base_of(const BodyJoints& body) {
  return {body[0], body[1], wrap_angle(body[2])};
}
inline ArmJoints arm_of(const BodyJoints& body) {
  return body.tail<static_cast<int>(kArmJoints)>();
}

/// The arm folded over the base: nothing of it stands out beyond the base's circle.
inline ArmJoints folded_arm() {
  return joints_of(ArmSpec{}.rest);
}

/// Like the Silvermate. Its lengths are chosen.
struct MobileArm {
  ArmGeometry arm{};
  Pose3 mount_R{Eigen::Translation3d(ArmSpec{}.shoulder_R)};  // frame 0 of the arm
  double base_radius = 0.35;                                  // [m] of an upright cylinder about R
  double base_height = ArmSpec{}.base_height;                 // [m]
  double mast_radius = ArmSpec{}.mast_radius;  // [m] of the post from the base to the shoulder
  double link_radius = ArmSpec{}.link_radius;  // [m] of the arm's links
  ArmJoints folded = folded_arm();             // for driving
};
/// `arm` on a base of `base_radius` [m].
MobileArm mobile_arm(const ArmSpec& arm, double base_radius);

struct BodyFrames {
  Pose3 base_W = Pose3::Identity();
  ArmFrames arm_W{};

  Vec3 shoulder() const { return arm_W.shoulder(); }
  Vec3 elbow() const { return arm_W.elbow(); }
  Vec3 wrist() const { return arm_W.wrist(); }
  Vec3 hand() const { return arm_W.hand().translation(); }
};
BodyFrames body_frames(const MobileArm& body, const BodyJoints& q);

/// A link in W: a rounded straight piece, or the upright cylinder of the base, whose axis is its
/// foot.
struct LinkAxis {
  Vec3 from_W = Vec3::Zero();
  Vec3 to_W = Vec3::Zero();
  double radius = 0;  // [m]
  double height = 0;  // [m] of an upright cylinder; 0: rounded
  /// Number of joints that move the link, counted from the shoulder.
  std::size_t joints = 0;
};
LinkAxis link_axis(const MobileArm& body, const BodyFrames& frames, BodyLink link);

/// The place of a link that is nearest to `solid`; its distance counts from the link's surface.
NearestOnLink nearest(const LinkAxis& link, const Solid& solid);

/// Adds J^T f to `generalized`, with J the Jacobian of point `p_W` of a link that the first
/// `joints` joints move, and f a force in W.
void add_force(const BodyFrames& frames,
               std::size_t joints,
               const Vec3& p_W,
               const Vec3& force_W,
               BodyJoints& generalized);

/// Distances [m] from each link's surface to the nearest solid; infinite without one.
struct BodyClearance {
  std::array<double, kBodyLinks> of_link{};
  double smallest() const;
};
BodyClearance clearance(const MobileArm& body,
                        const BodyFrames& frames,
                        std::span<const Solid> solids);

/// A link of the arm and a part of the body, or another link, that it must not touch.
struct OwnContact {
  LinkAxis link{};
  NearestOnLink nearest{};  // of the link to the other part, from surface to surface
};
/// Forearm and hand against base and mast, the upper arm's outer half against both, and the hand
/// against the upper arm; neighbours in the chain touch always.
inline constexpr std::size_t kOwnContacts = 7;
std::array<OwnContact, kOwnContacts> own_contacts(const MobileArm& body, const BodyFrames& frames);

/// Smallest distance [m] of own_contacts().
double self_clearance(const MobileArm& body, const BodyFrames& frames);

}  // namespace algo
