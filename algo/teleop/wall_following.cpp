// algo/teleop/wall_following.cpp: Eq. 6-10 of Park et al. 2005, and the patience with sides.
#include "algo/teleop/wall_following.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace algo {
namespace {

constexpr double kFullSpeed = 0.9;        // of v_max: from here the operator does not steer
constexpr double kNearWall = 2.0;         // of D_ref
constexpr double kPeriodRounding = 1e-9;  // [s] of sums of periods

}  // namespace

WallLaw wall_law(const Parameters& parameters) {
  return static_cast<WallLaw>(parameters[kWallLaw]);
}

WallTurn follow_wall(const WallModel& wall,
                     double w_max,
                     const Parameters& parameters,
                     WallLaw law) {
  if (!std::isfinite(wall.rho) || !std::isfinite(wall.theta) || !std::isfinite(w_max)) return {};
  const double d_ref = parameters[kWallDistance];
  const double side = side_of(wall);
  WallTurn turn;
  turn.offset = side * (wall.rho - d_ref);
  turn.aside = -side * (std::numbers::pi / 2 - std::abs(wall.theta));
  turn.xi_1 = turn.offset / d_ref;
  const bool corrected = law == WallLaw::Corrected;
  const double blend = corrected ? std::max(0.0, 1 - std::abs(turn.xi_1)) : 1 - turn.xi_1;
  turn.xi_2 = blend * turn.aside / (2.0 / 3.0 * parameters[kWallSector]);
  const double sum = turn.xi_1 + turn.xi_2;
  turn.omega = (corrected ? std::clamp(sum, -1.0, 1.0) : sum) * w_max;
  return turn;
}

bool follows_wall(const WallModel& wall, double v_cmd, double v_max, const Parameters& parameters) {
  return v_cmd > kFullSpeed * v_max && wall.rho <= kNearWall * parameters[kWallDistance];
}

std::optional<WallModel> FollowedSide::follow(const std::optional<WallModel>& seen, double stamp) {
  const bool recent = held_ && stamp - held_stamp_ <= kPatience + kPeriodRounding;
  if (!seen) {
    other_since_.reset();
    if (!recent) held_.reset();
    return std::nullopt;
  }
  if (held_ && side_of(*seen) != side_of(*held_)) {
    if (!other_since_) other_since_ = stamp;
    const bool proven = stamp - *other_since_ >= kPatience - kPeriodRounding;
    if (!proven) return recent ? held_ : std::nullopt;
  }
  held_ = seen;
  held_stamp_ = stamp;
  other_since_.reset();
  return seen;
}

}  // namespace algo
