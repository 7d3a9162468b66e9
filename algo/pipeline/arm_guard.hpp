// algo/pipeline/arm_guard.hpp: proves that a command brings no part of a robot with an arm into
// itself or into a known thing, under every driver.
#pragma once

#include <span>

#include "algo/arm/mobile_arm.hpp"
#include "algo/full_strip/motion.hpp"
#include "algo/telemetry.hpp"

namespace algo {

namespace limits {

inline constexpr Limit kArmNear{"arm", "The arm would come too near to something."};

}  // namespace limits

/// Looks at the whole motion under a command: while it acts, and then until base and joints stand.
/// A motion that keeps the margins is passed on. Of one that does not, its arm or its base alone,
/// or nothing: the first that keeps them, or else the one that leaves the most room, so that a
/// robot that is too near already can get away.
class ArmGuard {
 public:
  static constexpr double kMargin = 0.03;      // [m] of mast and arm to things
  static constexpr double kBaseMargin = 0.01;  // [m] of the base to things
  static constexpr double kOwnMargin = 0.005;  // [m] of the arm to the robot itself

  explicit ArmGuard(const RobotSpec& spec);

  /// How a body moves now.
  struct Motion {
    Twist2 base{};
    ArmJoints rates = ArmJoints::Zero();  // [rad/s]
  };
  /// `command` or a part of it, for a body at `now`, among `near`.
  Command limited(const BodyJoints& now,
                  const Motion& motion,
                  std::span<const Solid> near,
                  const Command& command) const;
  /// [m] How far from R a motion of the guard can reach.
  double reach() const { return reach_; }

 private:
  double least_room(const BodyJoints& now,
                    const Motion& motion,
                    std::span<const Solid> near,
                    const Command& command) const;
  double room(const BodyJoints& q, std::span<const Solid> near, double time) const;
  double farthest(const Motion& motion, std::span<const Solid> near, const Command& command) const;

  MobileArm body_;
  MotionLimits limits_;
  double period_ = 0;  // [s]
  double reach_ = 0;   // [m]
};

}  // namespace algo
