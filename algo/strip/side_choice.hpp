// algo/strip/side_choice.hpp: chooses the side on which to pass an obstacle on the line to the goal
// (equations.md E.4).
//
// Not in the sources. It is needed because every continuous reading of Eq. 13-14 has a balance
// point head-on, at which the robot would stay stuck.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/laser_scan.hpp"
#include "algo/types.hpp"

namespace algo {

enum class Side : std::int8_t { Right = -1, None = 0, Left = 1 };

/// State kept from tick to tick.
struct SideState {
  Side side = Side::None;
  double since = 0;                      // [s] run clock of the choice
  std::optional<double> last_blocked{};  // [s] run clock
};

struct SideInput {
  double stamp = 0;  // [s] run clock
  Pose2 pose_W{};    // of the robot
  Vec2 goal_W{0, 0};
  double reach = 0;                 // [m] d_r = safety distance + robot radius
  double robot_radius = 0;          // [m]
  const LaserScan* scan = nullptr;  // filtered, the same as for the force; never null
};

/// The contribution of the choice to this tick.
struct SidePush {
  Vec2 force_W{0, 0};  // [m] to be added to the external force
  double alpha = 0;    // its share, 0..1
  std::optional<std::size_t> blocked_beam{};
};

class SideChoice {
 public:
  void reset() { state_ = {}; }
  const SideState& state() const { return state_; }

  /// Runs one tick: checks whether the lane to the goal is blocked, chooses or forgets a side, and
  /// turns a share of `force_W` (the external force without a push) sideways.
  SidePush update(const SideInput& in, const Vec2& force_W);

 private:
  std::optional<std::size_t> blocking_beam(const SideInput& in);

  SideState state_{};
  BeamDirections directions_R_{};
};

/// The side on which less of the obstacle lies beyond the goal's bearing. Grows a cluster from
/// `beam` to both sides while the next beam's range is below that of `beam` + 0.8 m (skips beams
/// without a measurement), and takes the end nearer to the goal; left if both are equally near.
Side choose_side(const LaserScan& scan, std::size_t beam, double goal_bearing_R);

/// clamp((c - cos 45) / (cos 15 - cos 45), 0, 1) with c = -F.u / |F|: 1 when the force points
/// straight back from the goal, 0 when it is more than 45 degrees off; 0 without a force.
double side_share(const Vec2& force_W, const Vec2& to_goal_W);

}  // namespace algo
