#include "algo/arm/mobile_arm.hpp"

#include <algorithm>

namespace algo {
namespace {

/// Squared lengths below this one are points [m2].
constexpr double kPoint = 1e-18;

/// Of `a` to `b`, two rounded links.
NearestOnLink nearest_links(const LinkAxis& a, const LinkAxis& b) {
  const Vec3 u = a.to_W - a.from_W;
  const Vec3 v = b.to_W - b.from_W;
  const Vec3 w = a.from_W - b.from_W;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double area = uu * vv - uv * uv;
  double s = area > kPoint ? std::clamp((uv * v.dot(w) - vv * u.dot(w)) / area, 0.0, 1.0) : 0.0;
  const double t = vv > kPoint ? std::clamp((uv * s + v.dot(w)) / vv, 0.0, 1.0) : 0.0;
  s = uu > kPoint ? std::clamp((uv * t - u.dot(w)) / uu, 0.0, 1.0) : 0.0;
  const Vec3 apart = w + s * u - t * v;
  const double length = apart.norm();
  NearestOnLink found{s, length - a.radius - b.radius, a.from_W + s * u, Vec3::UnitZ()};
  if (length > 0) found.away = apart / length;
  return found;
}

}  // namespace

BodyJoints body_joints(const Pose2& base_W, const ArmJoints& q) {
  BodyJoints body;
  body << base_W.x, base_W.y, base_W.heading, q;
  return body;
}

MobileArm mobile_arm(const ArmSpec& arm, double base_radius) {
  MobileArm body;
  body.arm = {.upper_arm = arm.upper_arm,
              .elbow_offset = arm.elbow_offset,
              .forearm = arm.forearm,
              .hand = arm.hand,
              .limits = joints_of(arm.limits)};
  body.mount_R =
      Eigen::Translation3d(arm.shoulder_R) * Eigen::AngleAxisd(arm.heading, Vec3::UnitZ());
  body.base_radius = base_radius;
  body.base_height = arm.base_height;
  body.mast_radius = arm.mast_radius;
  body.link_radius = arm.link_radius;
  body.folded = joints_of(arm.rest);
  return body;
}

BodyFrames body_frames(const MobileArm& body, const BodyJoints& q) {
  BodyFrames frames;
  frames.base_W = Eigen::Translation3d(q[0], q[1], 0) * Eigen::AngleAxisd(q[2], Vec3::UnitZ());
  frames.arm_W = arm_frames(body.arm, arm_of(q), frames.base_W * body.mount_R);
  return frames;
}

LinkAxis link_axis(const MobileArm& body, const BodyFrames& frames, BodyLink link) {
  const Vec3 base = frames.base_W.translation();
  const Vec3 shoulder = frames.shoulder();
  switch (link) {
    case BodyLink::Base:
      return {base, base, body.base_radius, body.base_height, 0};
    case BodyLink::Mast:
      return {{shoulder.x(), shoulder.y(), body.base_height}, shoulder, body.mast_radius, 0, 0};
    case BodyLink::UpperArm:
      return {shoulder, frames.elbow(), body.link_radius, 0, 2};
    case BodyLink::Forearm:
      return {frames.elbow(), frames.wrist(), body.link_radius, 0, 4};
    case BodyLink::Hand:
      return {frames.wrist(), frames.hand(), body.link_radius, 0, 6};
  }
  return {};
}

void add_force(const BodyFrames& frames,
               std::size_t joints,
               const Vec3& p_W,
               const Vec3& force_W,
               BodyJoints& generalized) {
  const Vec3 arm_of_force = p_W - frames.base_W.translation();
  generalized[0] += force_W.x();
  generalized[1] += force_W.y();
  generalized[2] += arm_of_force.x() * force_W.y() - arm_of_force.y() * force_W.x();
  for (std::size_t i = 0; i < joints; ++i) {
    const Pose3& before = frames.arm_W[i];
    generalized[static_cast<Eigen::Index>(3 + i)] +=
        before.linear().col(2).dot((p_W - before.translation()).cross(force_W));
  }
}

NearestOnLink nearest(const LinkAxis& link, const Solid& solid) {
  if (link.height > 0) {
    // As far from the solid as the cylinder's foot is from the solid grown by the cylinder.
    Solid grown = solid;
    grown.rounding += link.radius;
    grown.bottom -= link.height;
    const SolidDistance there = distance_to(grown, link.from_W);
    return {0, there.distance, link.from_W, there.away};
  }
  NearestOnLink found = nearest_on_link(link.from_W, link.to_W, solid);
  found.distance -= link.radius;
  return found;
}

double BodyClearance::smallest() const {
  return *std::ranges::min_element(of_link);
}

BodyClearance clearance(const MobileArm& body,
                        const BodyFrames& frames,
                        std::span<const Solid> solids) {
  BodyClearance result;
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const LinkAxis link = link_axis(body, frames, static_cast<BodyLink>(k));
    result.of_link[k] = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids) {
      result.of_link[k] = std::min(result.of_link[k], nearest(link, solid).distance);
    }
  }
  return result;
}

std::array<OwnContact, kOwnContacts> own_contacts(const MobileArm& body, const BodyFrames& frames) {
  Solid base;
  base.centre_W = frames.base_W.translation().head<2>();
  base.rounding = body.base_radius;
  base.bottom = 0;
  base.top = body.base_height;
  Solid mast = base;
  mast.centre_W = frames.shoulder().head<2>();
  mast.rounding = body.mast_radius;
  mast.bottom = body.base_height;
  mast.top = frames.shoulder().z();

  const LinkAxis upper = link_axis(body, frames, BodyLink::UpperArm);
  const LinkAxis forearm = link_axis(body, frames, BodyLink::Forearm);
  const LinkAxis hand = link_axis(body, frames, BodyLink::Hand);
  LinkAxis outer = upper;
  outer.from_W = (upper.from_W + upper.to_W) / 2;  // the inner half is in the mast's head
  return {OwnContact{outer, nearest(outer, base)},
          OwnContact{outer, nearest(outer, mast)},
          OwnContact{forearm, nearest(forearm, base)},
          OwnContact{forearm, nearest(forearm, mast)},
          OwnContact{hand, nearest(hand, base)},
          OwnContact{hand, nearest(hand, mast)},
          OwnContact{hand, nearest_links(hand, upper)}};
}

double self_clearance(const MobileArm& body, const BodyFrames& frames) {
  double least = std::numeric_limits<double>::infinity();
  for (const OwnContact& contact : own_contacts(body, frames)) {
    least = std::min(least, contact.nearest.distance);
  }
  return least;
}

}  // namespace algo
