// algo/full_strip/motion.hpp: predicts the base's motion under commands, and checks the room for
// its hull on the way.
#pragma once

#include <array>
#include <cstddef>

#include "algo/diff_drive.hpp"
#include "algo/full_strip/local_map.hpp"
#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace algo {

/// Room around the hull in the map. The coarse check covers the hull by equal discs along R's x
/// axis and reads the map's distance once for each. If that finds little room, the fine check
/// measures from the outline to the hits in the cells around.
class HullCheck {
 public:
  explicit HullCheck(const RobotSpec& spec = {});
  bool is_of(const RobotSpec& spec) const;
  double half_width() const { return half_width_; }  // [m] of the hull, or the radius of a disc
  bool is_round() const { return half_length_ <= 0; }
  /// [m] Free room around the hull at `pose_W`. Exact if less than kExact; negative if something is
  /// inside the hull.
  double clearance(const LocalMap& map, const Pose2& pose_W) const;
  /// [m] Distance from the hull at `pose_W` to one point; negative inside.
  double distance(const Pose2& pose_W, const Vec2& point_W) const;
  /// True if the hull at `pose_W` covers `point_W` by more than a hit's error.
  bool covers(const Pose2& pose_W, const Vec2& point_W) const;
  /// True if the rear half of the hull moves into unseen space under `twist`. The front half moves
  /// into what the scanner looks at.
  bool enters_unseen(const SeenSpace& seen, const Pose2& pose_W, const Twist2& twist) const;
  /// Marks the hull's area as seen.
  void stand_on(SeenSpace& seen, const Pose2& pose_W) const;
  /// Marks as seen the room to turn in at the start, which no sensor could look at otherwise.
  void take_place(SeenSpace& seen, const Pose2& pose_W) const;

 private:
  /// A place on the outline, slightly outside it, and the direction that it faces.
  struct Rim {
    Vec2 point_R{0, 0};
    Vec2 normal_R{0, 0};
  };
  static constexpr std::size_t kRims = 48;
  void add_rim(const Vec2& point_R, const Vec2& normal_R);
  static constexpr double kExact = 0.12;  // [m]
  static constexpr std::size_t kMost = 7;
  double exact(const LocalMap& map, const Pose2& pose_W) const;
  double outside(const Vec2& d, const Vec2& ahead) const;

  std::array<double, kMost> along_{};  // [m] centres of the discs
  std::size_t count_ = 1;
  double disc_ = 0;         // [m] radius of a disc
  double radius_ = 0;       // [m] of the circle about the hull
  double half_length_ = 0;  // [m] 0: the hull is a disc
  double half_width_ = 0;
  double axle_ = 0;                // [m] x of the drive axle in R
  std::array<Rim, kRims> rims_{};  // of the rear half
  std::size_t rim_count_ = 0;
};

struct MotionLimits {
  double max_v = 0, max_omega = 0;                    // [m/s], [rad/s]
  double acceleration = 0, angular_acceleration = 0;  // [m/s2], [rad/s2]
  double axle = 0;                                    // [m] x of the drive axle in R
  double jerk = 0, angular_jerk = 0;                  // [m/s3], [rad/s3] 0: no limit
};
/// Those of the robot itself.
MotionLimits limits_of(const RobotSpec& spec);

struct MotionState {
  Pose2 pose_W{};
  Twist2 twist{};
};

/// `state` after `dt` [s] under `command`: the twist approaches it as fast as the limits allow.
MotionState advanced(const MotionState& state,
                     const Twist2& command,
                     const MotionLimits& limits,
                     double dt);

/// True if `state`, braked to rest in both parts at once, passes only states for which
/// `free(state)` holds.
template <typename Free>
bool rests(MotionState state, const MotionLimits& limits, double dt, Free&& free) {
  constexpr int kMost = 400;  // a base that cannot brake is not proven safe
  for (int k = 0; k < kMost; ++k) {
    if (state.twist == Twist2{}) return true;
    state = advanced(state, {}, limits, dt);
    if (!free(state)) return false;
  }
  return false;
}

/// True if `state`, braked to rest, keeps `margin` [m] of room all the way and never backs into
/// unseen space.
bool rests_clear(const LocalMap& map,
                 const HullCheck& hull,
                 const MotionState& state,
                 const MotionLimits& limits,
                 double dt,
                 double margin);

}  // namespace algo
