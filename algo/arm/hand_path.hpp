// algo/arm/hand_path.hpp: leads the hand along a planned path; base and arm give way to things as
// far as the hand stays on it.
#pragma once

#include <span>
#include <vector>

#include "algo/arm/body_follower.hpp"

namespace algo {

/// Docs: equations.md, "Path of the hand".
struct HandPathRules {
  double speed = 0.10;           // [m/s] of the hand along its path
  double correction = 2.0;       // [1/s] by which the hand gets back onto it
  double lag = 0.02;             // [m] the path waits for a hand that is farther behind
  double reach = 0.35;           // [m] a moving solid pushes the parts nearer to it than this,
  double standing_reach = 0.05;  // [m] a standing one these: the plan keeps clear of it
  double push = 4.0;             // [1/s] by which a part yields
  double own_reach = 0.03;       // [m] the same of the arm and its own robot
  double back = 1.0;             // [1/s] by which base and joints get back to the plan
  double steer = 5.0;            // [rad/m2] by which a base that drives gets back across its way
};

/// The hand first, then all else: the rates of base and joints that move the hand, and in their
/// null space those of the plan and the forces of things on base and links, all with weight 1.
/// Khatib 1987; the sibling thesis' second task.
class HandPath {
 public:
  HandPath(const MobileArm& body, const BodyLimits& limits, const HandPathRules& rules = {});

  /// Forgets the path.
  void reset();
  /// `plan` of plan_hand_path(), for a body that stands at its front. Allocates.
  void begin(std::span<const BodyJoints> plan);

  /// The rates of one tick of `dt` [s]; Waits while the hand does not get on. Allocates nothing.
  BodyCommand update(const BodyJoints& now, std::span<const Solid> solids, double dt);

  void set_speed(double speed) { rules_.speed = speed; }  // [m/s]
  /// [m] Of the path that is behind the hand.
  double done() const { return done_; }

 private:
  /// v [m/s] and omega [rad/s] of the base, then the joints [rad/s].
  using BodyRates = Eigen::Matrix<double, 2 + static_cast<int>(kArmJoints), 1>;
  using HandJacobian = Eigen::Matrix<double, 6, BodyRates::RowsAtCompileTime>;
  /// Of the plan where the hand should be.
  struct Lead {
    BodyJoints q = BodyJoints::Zero();
    BodyJoints rates = BodyJoints::Zero();  // [1/s]
    Vec3 hand_W = Vec3::Zero();
    Vec3 speed_W = Vec3::Zero();  // [m/s]
  };

  /// Goes on, if `hand_W` is near enough to where it should be.
  Lead lead(const Vec3& hand_W, double dt);
  HandJacobian jacobian(const BodyFrames& frames) const;
  /// The plan's rates and back to the plan.
  BodyRates planned(const BodyJoints& now, const Lead& lead) const;
  /// Away from things, from the robot itself and from the joints' limits.
  BodyRates yielding(const BodyJoints& now,
                     const BodyFrames& frames,
                     std::span<const Solid> solids) const;
  BodyRates limited(BodyRates rates) const;

  MobileArm body_;
  BodyLimits limits_;
  HandPathRules rules_;
  std::vector<BodyJoints> plan_{};
  std::vector<Vec3> hands_W_{};  // of the plan's configurations,
  std::vector<double> ways_{};   // [m] and of the path up to there
  Eigen::Matrix3d attitude_W_ = Eigen::Matrix3d::Identity();
  bool base_stays_ = true;  // in the whole plan
  double done_ = 0;
};

}  // namespace algo
