// algo/full_strip/motion.hpp: how the base will move under commands, and whether its hull has room
// on the way.
#pragma once

#include <array>
#include <cstddef>

#include "algo/diff_drive.hpp"
#include "algo/full_strip/local_map.hpp"
#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace algo {

/// The hull as equal discs along R's x axis that cover it: one test of the map's distance each.
class HullDiscs {
 public:
  explicit HullDiscs(const RobotSpec& spec = {});
  double radius() const { return radius_; }          // [m] of a disc
  double half_width() const { return half_width_; }  // [m] of the hull
  /// [m] Free room around the hull at `pose_W`, negative when it overlaps an occupied cell.
  double clearance(const LocalMap& map, const Pose2& pose_W) const;

 private:
  static constexpr std::size_t kMost = 7;
  std::array<double, kMost> along_{};  // [m] centres
  std::size_t count_ = 1;
  double radius_ = 0;
  double half_width_ = 0;
};

struct MotionLimits {
  double max_v = 0, max_omega = 0;                    // [m/s], [rad/s]
  double acceleration = 0, angular_acceleration = 0;  // [m/s2], [rad/s2]
};

struct MotionState {
  Pose2 pose_W{};
  Twist2 twist{};
};

/// `state` after `dt` [s] under `command`: the twist moves towards it as fast as the limits allow.
MotionState advanced(const MotionState& state,
                     const Twist2& command,
                     const MotionLimits& limits,
                     double dt);

/// Whether `state` braked to rest, both parts at once, keeps `margin` [m] of room all the way.
bool rests_clear(const LocalMap& map,
                 const HullDiscs& hull,
                 MotionState state,
                 const MotionLimits& limits,
                 double dt,
                 double margin);

}  // namespace algo
