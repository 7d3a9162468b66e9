// algo/arm/body_follower.hpp: drives base and arm along a strip that bends before what comes near.
#pragma once

#include <limits>
#include <span>

#include "algo/arm/body_strip.hpp"

namespace algo {

struct BodyLimits {
  double max_v = 0.5;      // [m/s]
  double max_omega = 0.8;  // [rad/s]
  double max_rate = 1.2;   // [rad/s] of each joint
  // [m/s2] of the base; infinite: it stops at once.
  double max_acceleration = std::numeric_limits<double>::infinity();
};

/// How a body follows its strip.
struct FollowRules {
  int sweeps = 20;            // in one tick
  double lookahead = 0.4;     // [m] the base steers for the strip's point this far ahead
  double margin = 0.05;       // [m] nearer to a solid than this nothing moves on
  double own_margin = 0.01;   // [m] the same of the arm to its body
  double horizon = 0.4;       // [s] the next motion must keep the margins for this long
  double goal_reach = 0.005;  // [rad] joints and heading are at their goal when they are so near,
  double base_reach = 0.05;   // [m] and the base when it is so near across its way
  bool gives_way = true;      // the base gets out of the way of what comes
};

/// Why the body moves as it does.
enum class FollowState : std::uint8_t { Drives, Waits, Arrived };

/// The command of one tick.
struct BodyCommand {
  Twist2 base{};
  ArmJoints rates = ArmJoints::Zero();  // [rad/s]
  // [s] until the joints are where they go, and stop.
  double rates_last = std::numeric_limits<double>::infinity();
  FollowState state = FollowState::Drives;
};

class BodyFollower {
 public:
  BodyFollower(const MobileArm& body,
               const BodyLimits& limits,
               const BodyStripGains& gains = {},
               const FollowRules& rules = {});

  /// A way from the present configuration to the goal; see BodyStrip::lay().
  void begin(std::span<const BodyJoints> nominal);

  /// One tick of `dt` [s] for a body at `now`. Allocates nothing.
  BodyCommand update(const BodyJoints& now, std::span<const Solid> solids, double dt);

  /// `wanted` if it keeps the margin; else its arm or its base alone, unless both must go
  /// `together`, or rest: the first that keeps it, or the one with the most room. Where something
  /// comes, a base may also get out of its way. Allocates nothing.
  BodyCommand kept_clear(const BodyJoints& now,
                         const BodyCommand& wanted,
                         std::span<const Solid> solids,
                         bool together = false) const;

  /// In one tick.
  void set_sweeps(int sweeps) { rules_.sweeps = sweeps; }
  const BodyStrip& strip() const { return strip_; }

 private:
  BodyCommand towards_strip(const BodyJoints& now) const;
  /// Forwards or backwards out of the way of what comes; rest where nothing comes, or where neither
  /// helps.
  BodyCommand out_of_the_way(const BodyJoints& now, std::span<const Solid> solids) const;
  /// Which solids count, for how long [s], and at how many moments.
  struct Look {
    enum class Of : std::uint8_t { All, Present, Moving } of = Of::All;
    double horizon = 0;
    int looks = 0;
  };
  /// [m] Beyond the margins, while `command` goes on.
  double least_room(const BodyJoints& now,
                    const BodyCommand& command,
                    std::span<const Solid> solids,
                    const Look& look) const;

  MobileArm body_;
  BodyLimits limits_;
  FollowRules rules_;
  BodyStrip strip_;
  double speed_ = 0;  // [m/s] of the base, averaged
};

/// The body after `command` for `dt` [s], without slip or limits.
BodyJoints moved(const BodyJoints& body, const BodyCommand& command, double dt);

}  // namespace algo
