// algo/arm/hand_path.hpp: leads the hand along straight lines; base and arm give way to things as
// far as the hand stays on its path.
#pragma once

#include <span>
#include <vector>

#include "algo/arm/body_follower.hpp"

namespace algo {

/// Docs: equations.md, "Path of the hand".
struct HandPathRules {
  double speed = 0.10;      // [m/s] of the hand along its path
  double correction = 2.0;  // [1/s] by which the hand gets back onto it
  double lag = 0.02;        // [m] the path waits for a hand that is farther behind
  double reach = 0.35;      // [m] things farther from a part of the body push nothing
  double push = 4.0;        // [1/s] by which a part yields
  double own_reach = 0.05;  // [m] the same of the arm and its own robot
  double posture = 0.3;     // [1/s] by which the joints go back to where they began
  double aside = 4.0;       // [rad/s/m] by which a base on wheels turns aside
  double sight = 1.0;       // [m] before a thing in its way it begins to turn
};

/// The hand first, then all else: the rates of base and joints that move the hand, and in their
/// null space the forces of things on base and links, both with weight 1. Khatib 1987; the sibling
/// thesis' second task.
class HandPath {
 public:
  HandPath(const MobileArm& body, const BodyLimits& limits, const HandPathRules& rules = {});

  /// From where the hand of a body at `now` is, straight from point to point, with the attitude
  /// `hand_W` has. `base_stays`: the arm alone moves. Allocates.
  void begin(const BodyJoints& now,
             const Eigen::Matrix3d& hand_W,
             std::span<const Vec3> points_W,
             bool base_stays);

  /// The rates of one tick of `dt` [s]; Waits while the hand does not get on. Allocates nothing.
  BodyCommand update(const BodyJoints& now, std::span<const Solid> solids, double dt);

  void set_speed(double speed) { rules_.speed = speed; }  // [m/s]
  /// [m] Of the hand from where it should be in this tick.
  double off() const { return off_; }

 private:
  /// v [m/s] and omega [rad/s] of the base, then the joints [rad/s].
  using BodyRates = Eigen::Matrix<double, 2 + static_cast<int>(kArmJoints), 1>;
  using HandJacobian = Eigen::Matrix<double, 6, BodyRates::RowsAtCompileTime>;

  /// [m/s] Moves the place where the hand should be, if the hand is near it.
  Vec3 lead(const Vec3& hand_W, double dt);
  HandJacobian jacobian(const BodyFrames& frames) const;
  double turning_aside(const BodyFrames& frames, const Solid& solid) const;
  BodyRates yielding(const BodyJoints& now,
                     const BodyFrames& frames,
                     std::span<const Solid> solids) const;
  BodyRates limited(BodyRates rates) const;

  MobileArm body_;
  BodyLimits limits_;
  HandPathRules rules_;
  std::vector<Vec3> points_W_{};
  std::size_t next_ = 0;  // of the points
  Vec3 place_W_ = Vec3::Zero();
  Eigen::Matrix3d attitude_W_ = Eigen::Matrix3d::Identity();
  ArmJoints posture_ = ArmJoints::Zero();
  bool base_stays_ = false;
  double forward_ = 1;  // -1: the base drives backwards
  double off_ = 0;
};

}  // namespace algo
