// algo/strip/strip.cpp: the strip's forces, equations.md D and E.
#include "algo/strip/strip.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kMetresPerUnit = 1e-3;   // the bare number of Eq. 13 means millimetres
constexpr double kNearestToPole = 0.010;  // [m]
constexpr double kLargestForce = 1.0;     // [m]

}  // namespace

Pose2 get_posi(const Vec2& from_W, const Vec2& target_W, double v_max, double period) {
  const Vec2 way = target_W - from_W;
  const double length = way.norm();
  if (length == 0) return {target_W.x(), target_W.y(), 0.0};
  const double share = std::min(v_max * period, length) / length;
  const Vec2 p = share < 1 ? Vec2(from_W + share * way) : target_W;
  return {p.x(), p.y(), std::atan2(way.y(), way.x())};
}

Vec2 internal_force(const Vec2& previous_W, const Vec2& via_W, const Vec2& next_W, double k_c) {
  const double d1 = (via_W - previous_W).norm();
  const double d2 = (next_W - via_W).norm();
  if (d1 + d2 == 0) return {0, 0};
  return k_c * (d1 / (d1 + d2) * (next_W - previous_W) - (via_W - previous_W));
}

double potential(double distance, double reach, double k_r) {
  if (!(distance < reach)) return 0;
  return k_r * (reach - distance) * (reach - distance) / 2;
}

double original_factor(double distance, double reach, double k_r) {
  return distance < reach ? k_r * (reach - distance) : 0.0;
}

double published_factor(double distance, double reach, double k_r) {
  const double factor = distance < reach ? k_r * (reach - distance)
                                         : kMetresPerUnit * k_r * distance /
                                               std::max(distance - reach, kNearestToPole);
  return std::min(factor, kLargestForce);
}

double linear_factor(double distance, double reach, double k_r) {
  return distance < reach ? published_factor(distance, reach, k_r) : 0.0;
}

double c1_factor(double distance, double reach, double k_r, double step) {
  const double B = step / 2;
  if (distance < reach) return B + k_r * (reach - distance);
  return B * B / (B + k_r * (distance - reach));
}

double force_factor(const ForceSettings& settings, double distance) {
  switch (settings.law) {
    case ForceLaw::Original:
      return original_factor(distance, settings.reach, settings.k_r);
    case ForceLaw::Published:
      return published_factor(distance, settings.reach, settings.k_r);
    case ForceLaw::Linear:
      return linear_factor(distance, settings.reach, settings.k_r);
    case ForceLaw::C1:
      return c1_factor(distance, settings.reach, settings.k_r, settings.step);
  }
  return 0;
}

Vec2 external_force(const ForceSettings& settings, const Vec2& p_W, const Vec2& obstacle_W) {
  const Vec2 away = p_W - obstacle_W;
  const double distance = away.norm();
  if (distance == 0) return {0, 0};
  return force_factor(settings, distance) / distance * away;
}

StripUpdate update_strip(const Pose2& current, const Vec2& next_W, const Vec2& force_W) {
  StripUpdate update;
  update.delta_W = (next_W - current.position()) + force_W;
  const Vec2 p = current.position() + update.delta_W;
  const bool still = update.delta_W.x() == 0 && update.delta_W.y() == 0;
  const double heading =
      still ? current.heading : std::atan2(update.delta_W.y(), update.delta_W.x());
  update.updated = {p.x(), p.y(), heading};
  update.turn = still ? 0.0 : wrap_angle(heading - current.heading);
  return update;
}

}  // namespace algo
