#include "algo/arm/reach_places.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "algo/arm/arm_inverse.hpp"

namespace algo {
namespace {

// Places of the base are tried on circles about the hand.
constexpr std::array<double, 4> kPlaceDistances{0.45, 0.55, 0.65, 0.75};  // [m]
constexpr int kPlaceBearings = 24;
constexpr int kPlaceHeadings = 12;
constexpr double kAmple = 0.05;  // [m] beyond the margins: the base never stands quite on its place
constexpr double kTightCost = 40;   // [m] of way for each metre that is missing to it
constexpr double kLimitCost = 1.0;  // [m] of way for each radian nearer to a joint's limit

/// [m] From the reaching body to the nearest solid.
double reaching_room(const MobileArm& body,
                     const ReachPlace& place,
                     std::span<const Solid> solids) {
  return clearance(body, body_frames(body, body_joints(place.base_W, place.q)), solids).smallest();
}

/// Of the arm angle `psi`.
std::optional<ArmJoints> joints_at_angle(const MobileArm& body,
                                         const Pose2& base_W,
                                         const Pose3& hand_in_shoulder,
                                         std::span<const Solid> solids,
                                         const ArmPlanRules& rules,
                                         double psi) {
  std::optional<ArmJoints> best;
  double best_margin = 0;
  for (std::uint8_t bits = 0; bits < ArmBranch::kCount; ++bits) {
    const auto q = arm_inverse(body.arm, hand_in_shoulder, psi, {bits}, body.folded);
    if (!q || limit_margin(body.arm, *q) < best_margin) continue;
    if (!is_clear(body, body_joints(base_W, *q), solids, rules)) continue;
    best = q;
    best_margin = limit_margin(body.arm, *q);
  }
  return best;
}

double missing(double room, double margin) {
  return std::max(0.0, margin + kAmple - room);
}

}  // namespace

FoldedBody::FoldedBody(const MobileArm& body) : radius_(body.base_radius), height_(0) {
  const BodyFrames frames = body_frames(body, body_joints({}, body.folded));
  for (const Pose3& frame : frames.arm_W) {
    height_ = std::max(height_, frame.translation().z() + body.link_radius);
    radius_ = std::max(radius_, frame.translation().head<2>().norm() + body.link_radius);
  }
}

double FoldedBody::room(const Vec2& p_W, std::span<const Solid> solids) const {
  const Vec3 foot(p_W.x(), p_W.y(), 0);
  const LinkAxis column{
      .from_W = foot, .to_W = foot, .radius = radius_, .height = height_, .joints = 0};
  double room = std::numeric_limits<double>::infinity();
  for (const Solid& solid : solids) room = std::min(room, nearest(column, solid).distance);
  return room;
}

std::optional<ArmJoints> reaching_joints(const MobileArm& body,
                                         const Pose2& base_W,
                                         const Pose3& hand_W,
                                         std::span<const Solid> solids,
                                         const ArmPlanRules& rules,
                                         std::optional<double> arm_angle) {
  const BodyFrames frames = body_frames(body, body_joints(base_W, ArmJoints::Zero()));
  const Pose3 hand_in_shoulder = frames.arm_W.front().inverse() * hand_W;
  if (arm_angle) {
    return joints_at_angle(body, base_W, hand_in_shoulder, solids, rules, *arm_angle);
  }
  const auto best = best_arm_solution(body.arm, hand_in_shoulder, body.folded);
  if (!best) return std::nullopt;
  if (is_clear(body, body_joints(base_W, best->q), solids, rules)) return best->q;
  for (std::uint8_t bits = 0; bits < ArmBranch::kCount; ++bits) {
    if (bits == best->branch.bits) continue;
    const auto other = best_arm_solution(body.arm, hand_in_shoulder, body.folded, ArmBranch{bits});
    if (other && is_clear(body, body_joints(base_W, other->q), solids, rules)) return other->q;
  }
  return std::nullopt;
}

std::vector<ReachPlace> reach_places(const MobileArm& body,
                                     const Vec2& start_W,
                                     const Pose3& hand_W,
                                     std::span<const Solid> solids,
                                     const ReachRules& rules) {
  std::vector<ReachPlace> found;
  const FoldedBody folded(body);
  const Vec2 hand = hand_W.translation().head<2>();
  for (const double distance : kPlaceDistances) {
    for (int b = 0; b < kPlaceBearings; ++b) {
      const Vec2 at = hand + distance * direction(2 * std::numbers::pi * b / kPlaceBearings);
      const double room = folded.room(at, solids);
      if (room < rules.base_margin) continue;
      for (int h = 0; h < kPlaceHeadings; ++h) {
        ReachPlace place;
        place.base_W = {at.x(), at.y(), wrap_angle(2 * std::numbers::pi * h / kPlaceHeadings)};
        const auto q =
            reaching_joints(body, place.base_W, hand_W, solids, rules.arm, rules.arm_angle);
        if (!q) continue;
        place.q = *q;
        const double tight = missing(room, rules.base_margin) +
                             missing(reaching_room(body, place, solids), rules.arm.margin);
        place.cost = (at - start_W).norm() + kTightCost * tight -
                     kLimitCost * limit_margin(body.arm, place.q);
        found.push_back(place);
      }
    }
  }
  std::ranges::stable_sort(found, {}, &ReachPlace::cost);
  return found;
}

}  // namespace algo
