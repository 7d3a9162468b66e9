#include "algo/arm/arm_inverse.hpp"

#include <cstdio>
#include <numbers>

#include "algo/arm/arm_chain.hpp"
#include "algo/arm/elbow_circle.hpp"

namespace algo {
namespace {

constexpr double kNoDirection = 1e-12;  // a shorter vector leaves its joint free
constexpr int kArmAngles = 72;          // every 5 degrees
constexpr double kSameMargin = 1e-9;    // [rad]

double sign_of(ArmBranch branch, std::uint8_t bit) {
  return (branch.bits & bit) != 0 ? -1.0 : 1.0;
}

Vec3 wrist_of(const ArmGeometry& geometry, const Pose3& hand) {
  return hand.translation() - geometry.hand * hand.linear().col(2);
}

/// Joints 1 and 2 turn the upper arm towards `elbow`, which is at -d3 (s2 c1, s2 s1, c2).
void solve_shoulder(const Vec3& elbow, double sign, ArmJoints& q) {
  const double aside = std::hypot(elbow.x(), elbow.y());
  q[1] = sign * std::atan2(aside, -elbow.z());
  if (aside >= kNoDirection) q[0] = std::atan2(-sign * elbow.y(), -sign * elbow.x());
}

/// Joints 3 and 4 turn the forearm along `to_wrist`, from the elbow, in frame 2.
void solve_elbow(const ArmGeometry& geometry, const Vec3& to_wrist, double sign, ArmJoints& q) {
  const double x = sign * std::hypot(to_wrist.x(), to_wrist.y());
  const double y = to_wrist.z();
  if (std::abs(x) >= kNoDirection) q[2] = std::atan2(sign * to_wrist.y(), sign * to_wrist.x());
  q[3] = std::atan2(geometry.elbow_offset * y - geometry.forearm * x,
                    geometry.elbow_offset * x + geometry.forearm * y);
}

/// Joints 5 to 7 turn the hand to `m`, its attitude in frame 4.
void solve_wrist(const Eigen::Matrix3d& m, double sign, ArmJoints& q) {
  const double aside = std::hypot(m(0, 2), m(1, 2));
  q[5] = sign * std::atan2(aside, m(2, 2));
  if (aside >= kNoDirection) q[4] = std::atan2(-sign * m(1, 2), -sign * m(0, 2));
  // Not from the last row of m: near theta_6 = 0 it is noise.
  const double s = std::sin(q[4]);
  const double c = std::cos(q[4]);
  q[6] = std::atan2(-m(0, 0) * s + m(1, 0) * c, -m(0, 1) * s + m(1, 1) * c);
}

}  // namespace

ArmBranch branch_of(const ArmGeometry& geometry, const ArmJoints& q) {
  const double x = geometry.elbow_offset * std::cos(q[3]) - geometry.forearm * std::sin(q[3]);
  ArmBranch branch;
  if (q[1] < 0) branch.bits |= ArmBranch::kShoulderBack;
  if (x < 0) branch.bits |= ArmBranch::kElbowBack;
  if (q[5] < 0) branch.bits |= ArmBranch::kWristBack;
  return branch;
}

std::optional<std::string> unreachable(const ArmGeometry& geometry, const Pose3& hand) {
  if (geometry.shoulder_offset != 0) {
    return "The closed form knows no shoulder_offset: put the offset into the arm's mount.";
  }
  constexpr double kRotation = 1e-6;
  if (!hand.matrix().allFinite() || !hand.linear().isUnitary(kRotation) ||
      hand.linear().determinant() < 0) {
    return "The pose of the hand is no position and rotation.";
  }
  const Vec3 wrist = wrist_of(geometry, hand);
  if (elbow_circle(geometry, wrist)) return std::nullopt;
  const WristReach reach = wrist_reach(geometry);
  const bool far = wrist.norm() > reach.farthest;
  std::array<char, 160> text{};
  std::snprintf(text.data(),
                text.size(),
                "The wrist would be %.3f m from the shoulder, and %s it can be is %.3f m.",
                wrist.norm(),
                far ? "the farthest" : "the nearest",
                far ? reach.farthest : reach.nearest);
  return text.data();
}

std::optional<ArmJoints> arm_inverse(const ArmGeometry& geometry,
                                     const Pose3& hand,
                                     double psi,
                                     ArmBranch branch,
                                     const ArmJoints& present) {
  if (geometry.shoulder_offset != 0) return std::nullopt;
  const Vec3 wrist = wrist_of(geometry, hand);
  const auto circle = elbow_circle(geometry, wrist);
  if (!circle) return std::nullopt;
  const Vec3 elbow = circle->elbow(psi);
  ArmJoints q = present;
  solve_shoulder(elbow, sign_of(branch, ArmBranch::kShoulderBack), q);
  const Eigen::Matrix3d upper = arm_frames(geometry, q, Pose3::Identity(), 2)[2].linear();
  solve_elbow(
      geometry, upper.transpose() * (wrist - elbow), sign_of(branch, ArmBranch::kElbowBack), q);
  const Eigen::Matrix3d lower = arm_frames(geometry, q, Pose3::Identity(), 4)[4].linear();
  solve_wrist(lower.transpose() * hand.linear(), sign_of(branch, ArmBranch::kWristBack), q);
  return q.unaryExpr([](double angle) { return wrap_angle(angle); });
}

std::optional<ArmSolution> best_arm_solution(const ArmGeometry& geometry,
                                             const Pose3& hand,
                                             const ArmJoints& present,
                                             std::optional<ArmBranch> branch) {
  const double psi_now = arm_angle(geometry, arm_frames(geometry, present)).value_or(0);
  std::optional<ArmSolution> best;
  double best_turn = 0;
  for (int step = 0; step < kArmAngles; ++step) {
    const double turn = wrap_angle(2 * std::numbers::pi * step / kArmAngles);
    for (std::uint8_t bits = 0; bits < ArmBranch::kCount; ++bits) {
      if (branch && branch->bits != bits) continue;
      const auto q = arm_inverse(geometry, hand, psi_now + turn, {bits}, present);
      if (!q) return std::nullopt;
      const double margin = limit_margin(geometry, *q);
      if (margin < 0) continue;
      const bool wider = !best || margin > best->margin + kSameMargin;
      const bool nearer = best && margin > best->margin - kSameMargin && std::abs(turn) < best_turn;
      if (!wider && !nearer) continue;
      best = ArmSolution{*q, wrap_angle(psi_now + turn), {bits}, margin};
      best_turn = std::abs(turn);
    }
  }
  return best;
}

}  // namespace algo
