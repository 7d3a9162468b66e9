// algo/teleop/wall_following.hpp: the turn rate that keeps a wall beside the robot.
//
// Source: Park et al. 2005, Eq. 6-10; equations.md G. xi_1 and xi_2 are the printed zeta_1 and xi_2
// of Eq. 8-10; they are not the votes zeta of Eq. 5.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/parameters.hpp"
#include "algo/teleop/wall_model.hpp"

namespace algo {

// The paper does not give the value.
inline constexpr ParameterInfo kWallDistance{
    .name = "teleop.d_ref",
    .label = "Wall distance D_ref",
    .unit = "m",
    .min = 0.3,
    .max = 3.0,
    .step = 0.05,
    .initial = 0.8,
    .help = "Distance from the robot's centre at which it follows a wall."};

enum class WallLaw : std::uint8_t {
  /// The blend factor of xi_2 is 1 - |D_diff| / D_ref, at least 0, and xi_1 + xi_2 is clamped to
  /// [-1, 1].
  Corrected,
  /// As printed: the blend factor is 1 - D_diff / D_ref, without clamps. The same offset then
  /// weighs
  /// 1 - x on the left and 1 + x on the right, and the turn rate may exceed w_max.
  Literal,
};

inline constexpr ParameterInfo kWallLaw{
    .name = "teleop.wall_law",
    .label = "Wall law",
    .max = 1,
    .step = 1,
    .initial = 0,
    .help =
        "0: Eq. 8-10 of Park et al. corrected, and patience before the followed side changes. 1: "
        "as printed."};
WallLaw wall_law(const Parameters& parameters);

/// Eq. 6-10 for one wall; positive turns to the left.
struct WallTurn {
  double offset = 0;  // [m] D_diff = sign(theta') (rho' - D_ref)
  double aside =
      0;  // [rad] theta_wall = -sign(theta') (90 deg - |theta'|): the wall's bearing error
  double xi_1 = 0;   // D_diff / D_ref
  double xi_2 = 0;   // blend factor times theta_wall / (2/3 theta_sr)
  double omega = 0;  // [rad/s] w_d = (xi_1 + xi_2) w_max
};

/// The turn that keeps `wall` at D_ref beside the robot. `w_max` [rad/s], >= 0. Zero if the wall or
/// w_max is not finite.
WallTurn follow_wall(const WallModel& wall,
                     double w_max,
                     const Parameters& parameters,
                     WallLaw law = WallLaw::Corrected);

/// The condition of Eq. 6-10: the operator drives at more than 0.9 v_max, and rho' <= 2 D_ref.
/// `v_cmd`, `v_max` [m/s].
bool follows_wall(const WallModel& wall, double v_cmd, double v_max, const Parameters& parameters);

/// Keeps to one side (ours): the followed wall changes its side only after kPatience on the other.
/// At a wall dead ahead theta' changes its sign from sample to sample, and w_d would jump between
/// its two limits.
class FollowedSide {
 public:
  static constexpr double kPatience = 0.5;  // [s]

  /// The wall to follow at `stamp` [s, run clock], never decreasing: `seen`, or, while the other
  /// side has to prove itself, the newest wall on the followed side, which is at most kPatience
  /// old. Nothing if neither is there. After kPatience without any wall, both sides are equal
  /// again.
  std::optional<WallModel> follow(const std::optional<WallModel>& seen, double stamp);
  void reset() { *this = {}; }

 private:
  std::optional<WallModel> held_{};      // the newest on the followed side
  double held_stamp_ = 0;                // [s] run clock
  std::optional<double> other_since_{};  // [s] run clock; the other side was seen without a break
};

}  // namespace algo
