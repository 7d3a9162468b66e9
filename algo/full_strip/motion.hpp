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

/// Room around the hull in the map. Coarse: the hull as equal discs along R's x axis that cover it,
/// one look at the map's distances each. Where that finds little room: the outline itself against
/// the hits in the cells around.
class HullCheck {
 public:
  explicit HullCheck(const RobotSpec& spec = {});
  double half_width() const { return half_width_; }  // [m] of the hull, or the radius of a disc
  /// [m] Free room around the hull at `pose_W`; exact where it is less than kExact, there negative
  /// when something is inside the hull.
  double clearance(const LocalMap& map, const Pose2& pose_W) const;
  /// Whether the hull at `pose_W` stands on `point_W`, by more than what a hit may be off.
  bool covers(const Pose2& pose_W, const Vec2& point_W) const;

 private:
  static constexpr double kExact = 0.12;  // [m]
  static constexpr std::size_t kMost = 7;
  double exact(const LocalMap& map, const Pose2& pose_W) const;
  double outside(const Vec2& d, const Vec2& ahead) const;

  std::array<double, kMost> along_{};  // [m] centres
  std::size_t count_ = 1;
  double disc_ = 0;         // [m] radius of a disc
  double radius_ = 0;       // [m] of the circle about the hull
  double half_length_ = 0;  // [m] 0: the hull is a disc
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
                 const HullCheck& hull,
                 MotionState state,
                 const MotionLimits& limits,
                 double dt,
                 double margin);

}  // namespace algo
