// algo/pipeline/shared_control.cpp: samples the laws, and applies them to the stick.
#include "algo/pipeline/shared_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/geometry.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/teleop/teleop_parameters.hpp"

namespace algo {
namespace {

constexpr double kSlack = 1e-9;   // [s], [m/s] of sums
constexpr double kAsGood = 0.99;  // of a speed; Eq. 4 never gives all of it, even in the open

constexpr LayerInfo kRing{.name = "teleop.ring",
                          .label = "Nearest in each sonar's sector",
                          .kind = LayerKind::Arrows,
                          .tone = Tone::External,
                          .style = LayerStyle::Dashed};
constexpr LayerInfo kWallLine{.name = "teleop.wall",
                              .label = "Wall model",
                              .kind = LayerKind::Polyline,
                              .tone = Tone::Internal};
constexpr double kHalfWall = 1.5;  // [m] drawn to either side of its foot

}  // namespace

Twist2 full_stick(const RobotSpec& spec, const Parameters& parameters) {
  return {std::min(spec.max_v, parameters[kStickSpeed]),
          std::min(spec.max_omega, parameters[kStickTurnRate])};
}

Twist2 full_stick(const Resource& in) {
  return full_stick(*in.spec, *in.parameters);
}

Twist2 SharedControl::share(const Resource& in,
                            const OwnRing& own_ring,
                            const Twist2& wanted,
                            Limit& limit) {
  const Parameters& p = *in.parameters;
  const Twist2 full = full_stick(in);
  if (!next_ || in.stamp >= *next_ - kSlack) sample(in, own_ring, full.v);

  Twist2 out = wanted;
  out.v = slowed_speed(wanted.v, step_.speed, ring_.distances, full.v, p);
  turn_.reset();
  if (wall_ && follows_wall(*wall_, wanted.v, full.v, p)) {
    turn_ = follow_wall(*wall_, full.omega, p, wall_law(p));
    out.omega = std::clamp(turn_->omega, -full.omega, full.omega);
    if (std::abs(out.omega - wanted.omega) > kSlack) limit = limits::kWallBeside;
  }
  if (out.v < kAsGood * wanted.v) {
    // Of the two factors of Eq. 4, the smaller one.
    const double sparse = std::min(wanted.v, step_.speed);
    limit = sparse * sparse < out.v * wanted.v ? limits::kCrowded : limits::kAhead;
  }
  reflect(in, wanted, full);
  return out;
}

void SharedControl::sample(const Resource& in, const OwnRing& own_ring, double v_max) {
  const Parameters& p = *in.parameters;
  next_ = (next_ && in.stamp < *next_ + kTeleopPeriod ? *next_ : in.stamp) + kTeleopPeriod;
  const bool virtual_ring = in.spec->has_laser && !in.spec->has_ring;
  ring_ = virtual_ring ? virtual_sonars(in.scene->scan, p)
                       : own_ring.read(in.odometry.pose, in.stamp, p);
  step_ = sparseness_step(sparseness_, ring_.distances, v_max, p);
  sparseness_ = step_.next;
  seen_ = wall_of_ring(ring_, p);
  wall_ = wall_law(p) == WallLaw::Corrected ? side_.follow(seen_, in.stamp) : seen_;
}

void SharedControl::reflect(const Resource& in, const Twist2& wanted, const Twist2& full) {
  const Parameters& p = *in.parameters;
  const double v_limit =
      forward_limit(wanted.v, step_.speed, ring_.distances, full.v, p, forward_force(p));
  forward_.band = forward_band(v_limit, full.v);
  left_.band = turn_ ? wall_band(turn_->omega, full.omega) : ForceBand{};
  const auto push = [ramp = p[kForceRamp]](Axis& axis, double q, const ForceLevels& levels) {
    axis.force = reflected_force(q, axis.band, levels, ramp);
  };
  push(forward_, kFullStick * wanted.v / full.v, kForwardLevels);
  push(left_, kFullStick * wanted.omega / full.omega, {});
}

void SharedControl::show(Telemetry& t) const {
  if (!next_) return;
  const Pose2& pose_W = t.observation.odometry.pose;
  Layer& ring = add_layer(t.layers, kRing, 4 * kRingSonars);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    if (!std::isfinite(ring_.distances[n])) continue;
    nearest = std::min(nearest, ring_.distances[n]);
    put(ring,
        pose_W.position(),
        ring_.distances[n] * direction(pose_W.heading + ring_.bearings[n]));
  }
  Layer& line = add_layer(t.layers, kWallLine, 4);
  if (wall_) {
    const Vec2 foot_R = wall_->rho * direction(wall_->theta);
    const Vec2 along_R = kHalfWall * direction(wall_->theta + std::numbers::pi / 2);
    put(line, to_parent(pose_W, foot_R - along_R), to_parent(pose_W, foot_R + along_R));
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  auto& out = t.output.measures;
  const auto put_wall =
      [&out](const std::optional<WallModel>& wall, std::string_view rho, std::string_view theta) {
        out.push_back({rho, "m", wall ? wall->rho : kNone});
        out.push_back({theta, "rad", wall ? wall->theta : kNone});
      };
  const auto put_share = [&out](std::string_view name, double of_full_stick) {
    out.push_back({name, "", of_full_stick / kFullStick});
  };
  out.push_back({"teleop.v_sprs", "m/s", step_.speed});
  out.push_back({"teleop.nearest", "m", nearest});
  put_wall(seen_, "teleop.seen_rho", "teleop.seen_theta");
  put_wall(wall_, "teleop.wall_rho", "teleop.wall_theta");
  out.push_back({"teleop.w_d", "rad/s", turn_ ? turn_->omega : kNone});
  put_share("teleop.q_offset_forward", forward_.band.offset);
  put_share("teleop.q_offset_left", left_.band.offset);
  put_share("teleop.dead_band_left", left_.band.half_width);
  put_share("teleop.force_forward", forward_.force);
  put_share("teleop.force_left", left_.force);
}

}  // namespace algo
