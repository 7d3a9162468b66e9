// algo/pipeline/shared_control.cpp: samples the laws, and applies them to the stick.
#include "algo/pipeline/shared_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/geometry.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/teleop/reflected_force.hpp"
#include "algo/teleop/teleop_parameters.hpp"

namespace algo {
namespace {

constexpr double kOldestEcho = 0.1;  // [s] all sonars of the ring have measured within this time
constexpr double kSlack = 1e-9;      // [s], [m/s] of sums
constexpr double kAsGood = 0.99;     // of a speed; Eq. 4 never gives all of it, even in the open

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

Twist2 full_stick(const Resource& in) {
  const Parameters& p = *in.parameters;
  return {std::min(in.spec->max_v, p[kStickSpeed]),
          std::min(in.spec->max_omega, p[kStickTurnRate])};
}

Twist2 SharedControl::share(const Resource& in, const Twist2& wanted, Limit& limit) {
  const Parameters& p = *in.parameters;
  const Twist2 full = full_stick(in);
  if (!next_ || in.stamp >= *next_ - kSlack) sample(in, full.v);

  Twist2 out = wanted;
  out.v = slowed_speed(wanted.v, step_.speed, ring_.distances, full.v, p);
  turn_.reset();
  if (wall_ && follows_wall(*wall_, wanted.v, full.v, p)) {
    turn_ = follow_wall(*wall_, full.omega, p);
    out.omega = turn_->omega;
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

void SharedControl::sample(const Resource& in, double v_max) {
  const Parameters& p = *in.parameters;
  next_ = (next_ && in.stamp < *next_ + kTeleopPeriod ? *next_ : in.stamp) + kTeleopPeriod;
  ring_ = listen(in);
  step_ = sparseness_step(sparseness_, ring_.distances, v_max, p);
  sparseness_ = step_.next;
  wall_ = side_.follow(wall_of_ring(ring_, p), in.stamp);
}

/// Of the laser, or, for a robot without one, of its sonars.
Ring SharedControl::listen(const Resource& in) {
  const Parameters& p = *in.parameters;
  if (in.spec->has_laser) return virtual_sonars(in.scene->scan, p);
  constexpr std::array<double, kRingSonars> kBearings = ring_bearings();
  Ring ring;
  RingReadings& out = ring.distances;
  out.fill(p[kRingReach]);
  for (const Echo& echo : in.scene->echoes) {
    const double bearing = echo.mount_R.heading;
    for (std::size_t n = 0; n < kRingSonars; ++n) {
      if (std::abs(wrap_angle(bearing - kBearings[n])) > kRingHalfCone) continue;
      const bool old = in.stamp - echo.stamp > kOldestEcho + kSlack;
      const double d = (echo.point_W - in.odometry.pose.position()).norm();
      if (old) out[n] = std::numeric_limits<double>::quiet_NaN();
      if (!old && echo.hit) out[n] = std::min(out[n], d);  // NaN stays
    }
  }
  return ring;
}

void SharedControl::reflect(const Resource& in, const Twist2& wanted, const Twist2& full) {
  const Parameters& p = *in.parameters;
  const auto force = [&p](double q, const ForceBand& band, const ForceLevels& levels) {
    return reflected_force(q, band, levels, p[kForceRamp]) / kFullStick;
  };
  const double v_limit = forward_limit(wanted.v, step_.speed, ring_.distances, full.v, p);
  force_forward_ =
      force(kFullStick * wanted.v / full.v, forward_band(v_limit, full.v), kForwardLevels);
  force_left_ = 0;
  if (!turn_) return;
  force_left_ =
      force(kFullStick * wanted.omega / full.omega, wall_band(turn_->omega, full.omega), {});
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
  out.push_back({"teleop.v_sprs", "m/s", step_.speed});
  out.push_back({"teleop.nearest", "m", nearest});
  out.push_back({"teleop.wall_rho", "m", wall_ ? wall_->rho : kNone});
  out.push_back({"teleop.wall_theta", "rad", wall_ ? wall_->theta : kNone});
  out.push_back({"teleop.w_d", "rad/s", turn_ ? turn_->omega : kNone});
  out.push_back({"teleop.force_forward", "", force_forward_});
  out.push_back({"teleop.force_left", "", force_left_});
}

}  // namespace algo
