// algo/full_strip/steering.cpp: low-pass, hysteresis and ramp of the turn rate.
#include "algo/full_strip/steering.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kTimeConstant = 0.1;  // [s]
constexpr double kOtherSide = 0.15;    // [rad/s] a slower turn to the other side is no turn,
constexpr double kTrim = 0.04;         // [rad/s] but a correction of at most this much
constexpr double kSided = 0.045;       // [rad/s] a slower command has no side
constexpr double kRounding = 1e-9;     // of the jerk, relative

/// `now`, which changed by `rate` a second, one tick nearer to `wanted`.
double eased(double now, double rate, double wanted, double most_rate, double jerk, double dt) {
  if (jerk <= 0) return wanted;
  const double off = std::abs(wanted - now);
  // The rate falls by jerk * dt a tick; until it is 0 it may add up to `off`.
  const double step = 0.5 * jerk * dt;
  const double stops = std::sqrt(step * step + 2 * jerk * off) - step;
  const double best = std::copysign(std::min({off / dt, stops, most_rate}), wanted - now);
  return now + dt * std::clamp(best, rate - jerk * dt, rate + jerk * dt);
}

bool is_hard(double now, double rate, double next, double jerk, double dt) {
  return jerk > 0 && std::abs((next - now) / dt - rate) > jerk * dt * (1 + kRounding);
}

}  // namespace

CommandCourse followed(const CommandCourse& course, const Twist2& command, double dt) {
  const Twist2 rate{(command.v - course.command.v) / dt,
                    (command.omega - course.command.omega) / dt};
  const bool turns = std::abs(command.omega) > kSided;
  return {command, rate, turns ? std::copysign(1.0, command.omega) : course.side};
}

Twist2 steadied(const CommandCourse& course, const Twist2& wanted, double dt) {
  const double last = course.command.omega;
  const double omega = last + (wanted.omega - last) * std::min(1.0, dt / kTimeConstant);
  const bool turns = omega * course.side >= 0 || std::abs(wanted.omega) >= kOtherSide;
  return {wanted.v, turns ? omega : std::clamp(omega, -kTrim, kTrim)};
}

Twist2 ramped_turn(const CommandCourse& course,
                   const Twist2& wanted,
                   const MotionLimits& limits,
                   double dt) {
  const double most = limits.angular_acceleration * dt;
  const double last = course.command.omega;
  return {wanted.v, std::clamp(wanted.omega, last - most, last + most)};
}

Twist2 eased(const CommandCourse& course,
             const Twist2& wanted,
             const MotionLimits& limits,
             double dt) {
  const auto& [now, rate, side] = course;
  return {eased(now.v, rate.v, wanted.v, limits.acceleration, limits.jerk, dt),
          eased(now.omega,
                rate.omega,
                wanted.omega,
                limits.angular_acceleration,
                limits.angular_jerk,
                dt)};
}

bool is_hard(const CommandCourse& course,
             const Twist2& command,
             const MotionLimits& limits,
             double dt) {
  const auto& [now, rate, side] = course;
  return is_hard(now.v, rate.v, command.v, limits.jerk, dt) ||
         is_hard(now.omega, rate.omega, command.omega, limits.angular_jerk, dt);
}

}  // namespace algo
