// algo/pipeline/shared_control.hpp: the robot's part in a driver's motion: slower in a crowded
// place and before an obstacle, and along a wall; and the force that tells the driver's hand.
//
// Source: Park et al. 2005, sections 2.1 and 2.3; equations.md G. The paper computes this at the
// operator's station, from data that came over the link. Ours is the robot's side, so a lost link
// keeps it.
#pragma once

#include <array>
#include <optional>

#include "algo/telemetry.hpp"
#include "algo/teleop/own_ring.hpp"
#include "algo/teleop/reflected_force.hpp"
#include "algo/teleop/sonar_ring.hpp"
#include "algo/teleop/speed_limit.hpp"
#include "algo/teleop/wall_following.hpp"
#include "algo/teleop/wall_model.hpp"

namespace algo {

struct Resource;

namespace limits {

inline constexpr Limit kCrowded{"crowded", "The place is crowded: less speed ahead is allowed."};
inline constexpr Limit kAhead{"obstacle_ahead", "An obstacle is near ahead."};
inline constexpr Limit kWallBeside{"wall", "The robot keeps its distance to the wall beside it."};
inline constexpr Limit kGuard{"guard", "The robot could not stop before what it sees."};
inline constexpr Limit kLink{"link",
                             "The link is slow: the driver's answer would come too late for more."};
inline constexpr Limit kPulled{"elastic", "The robot finds its own way to where the stick pulls."};

}  // namespace limits

/// [m/s, rad/s] At full stick: the smaller of the robot's limit and the parameter.
Twist2 full_stick(const RobotSpec& spec, const Parameters& parameters);
Twist2 full_stick(const Resource& in);

/// The laws of Park et al. for one driver. They are sampled every kTeleopPeriod, since the
/// sparseness changes by one factor a sample; between samples readings, wall and sparseness hold,
/// and Eq. 4 follows the stick.
class SharedControl {
 public:
  void reset() { *this = {}; }
  /// The motion made of the driver's `wanted`, both within full_stick(). A robot with a ring of its
  /// own (RobotSpec::has_ring), or without a laser, is heard by `own_ring`; for any other, virtual
  /// sonars are made of its scan. `limit` gets the reason if they differ; where there are several,
  /// the stronger one.
  Twist2 share(const Resource& in, const OwnRing& own_ring, const Twist2& wanted, Limit& limit);
  /// Adds the readings, the wall and the force of this tick to `t`.
  void show(Telemetry& t) const;

 private:
  /// One axis of the stick.
  struct Axis {
    ForceBand band{};
    double force = 0;  // positive pushes ahead or to the left
  };
  void sample(const Resource& in, const OwnRing& own_ring, double v_max);
  void reflect(const Resource& in, const Twist2& wanted, const Twist2& full);

  std::optional<double> next_{};  // [s] run clock; of the next sample
  Ring ring_{};
  double sparseness_ = 1;
  SparsenessStep step_{};
  FollowedSide side_{};
  std::optional<WallModel> seen_{};  // of the newest sample
  std::optional<WallModel> wall_{};  // the followed one
  std::optional<WallTurn> turn_{};   // while it is followed
  Axis forward_{};
  Axis left_{};
};

}  // namespace algo
