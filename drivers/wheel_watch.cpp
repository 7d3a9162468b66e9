// drivers/wheel_watch.cpp: predicts an interval of each wheel's speed and checks reports by it.
#include "drivers/wheel_watch.hpp"

#include <algorithm>
#include <cmath>

#include "algo/diff_drive.hpp"

namespace drivers {
namespace {

constexpr double kUntilSeen = 0.3;  // [s] from a command to the report that shows its effect
constexpr double kShare = 0.5;      // share of its ramp that a base reaches at least
constexpr double kAtMost = 2;       // times its ramp at most, for early or late reports
// A file may name ramps that no base reaches, so no base is expected to exceed these.
constexpr double kGentleRamp = 0.25;     // [m/s2]
constexpr double kGentleTurn = 1.0;      // [rad/s2]
constexpr double kGentleBraking = 0.35;  // [m/s2] of a wheel in an emergency stop

constexpr double kSlack = 0.02;         // [m/s] for rounding and slight pushes
constexpr double kShareOfSpeed = 0.2;   // for slip and an inexact track
constexpr double kCreep = 0.02;         // [m/s] a wheel that needs no more than this may stand
constexpr double kStill = 0.25;         // share of the least speed below which a wheel stands
constexpr double kSeenToStand = 0.005;  // [m] the least travel while the encoder stood
constexpr double kClearly = 0.03;       // [m/s] of excess: then one checked report is enough
constexpr double kSurely = 1.5;         // times the tolerance: likewise
constexpr unsigned kReports = 2;        // agreeing reports otherwise

}  // namespace

WheelWatch::WheelWatch(const WheelDynamics& dynamics, double half_track)
    : dynamics_(dynamics), half_track_(half_track) {}

void WheelWatch::restart() {
  told_count_ = 0;
  begun_ = false;
  too_fast_ = too_slow_ = {};
}

WheelWatch::Axes WheelWatch::axes_of(const algo::Twist2& twist) const {
  if (!dynamics_.ramp_of_wheels) return {twist.v, twist.omega};
  const algo::SideMotion sides = algo::sides_of(twist, half_track_);
  return {sides.left, sides.right};
}

void WheelWatch::command(double now, const algo::Twist2& twist, bool braking) {
  told_[told_count_ % told_.size()] = {now, axes_of(braking ? algo::Twist2{} : twist), braking};
  ++told_count_;
}

/// Advances the intervals to `until`. They widen towards each command in force by the fastest ramp,
/// and shrink from speeds that no command asks for any more by the slowest ramp.
void WheelWatch::follow(double until) {
  const double dt = until - stamp_;
  std::array<Interval, 2> wanted{};
  bool braking = true;
  bool any = false;
  // Newest first. Each command was in force until the next one.
  const std::size_t kept = std::min(told_count_, told_.size());
  double replaced = until;
  for (std::size_t back = 1; back <= kept && (back == 1 || replaced >= stamp_ - kUntilSeen);
       ++back) {
    const Told& told = told_[(told_count_ - back) % told_.size()];
    for (std::size_t i = 0; i < 2; ++i) {
      wanted[i].low = any ? std::min(wanted[i].low, told.wanted[i]) : told.wanted[i];
      wanted[i].high = any ? std::max(wanted[i].high, told.wanted[i]) : told.wanted[i];
    }
    braking = braking && told.braking;
    any = true;
    replaced = told.time;
  }
  if (!any) return;
  const bool of_wheels = dynamics_.ramp_of_wheels;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool turn = i == 1 && !of_wheels;
    double ramp = std::min(kShare * dynamics_.ramps[i], turn ? kGentleTurn : kGentleRamp);
    if (braking) ramp = std::max(ramp, turn ? kGentleBraking / half_track_ : kGentleBraking);
    Interval& axis = axes_[i];
    // Only for speeding up: the floor or the base's own watchdog may slow a wheel.
    if (dynamics_.ramps[i] > 0) {
      const double gain = kAtMost * dynamics_.ramps[i] * dt;
      wanted[i].high = std::min(wanted[i].high, std::max(axis.high, 0.0) + gain);
      wanted[i].low = std::max(wanted[i].low, std::min(axis.low, 0.0) - gain);
    }
    axis.high = std::max(wanted[i].high, axis.high - ramp * dt);
    axis.low = std::min(wanted[i].low, axis.low + ramp * dt);
  }
}

std::array<WheelWatch::Interval, 2> WheelWatch::wheels() const {
  if (dynamics_.ramp_of_wheels) return axes_;
  const Interval& v = axes_[0];
  const double turn_low = axes_[1].low * half_track_;
  const double turn_high = axes_[1].high * half_track_;
  return {Interval{v.low - turn_high, v.high - turn_low},
          Interval{v.low + turn_low, v.high + turn_high}};
}

bool WheelWatch::report(double stamp, const algo::Twist2& twist) {
  if (begun_ && stamp <= stamp_) return false;
  if (!begun_) {
    // The robot may roll when it is armed; that speed must decay from here on.
    const Axes axes = axes_of(twist);
    for (std::size_t i = 0; i < 2; ++i) {
      axes_[i] = {std::min(axes[i], 0.0), std::max(axes[i], 0.0)};
    }
    begun_ = true;
    stamp_ = stamp;
    return false;
  }
  const double dt = stamp - stamp_;
  follow(stamp);
  stamp_ = stamp;

  const std::array<Interval, 2> allowed = wheels();
  double fastest = 0;
  for (const Interval& wheel : allowed) {
    fastest = std::max({fastest, std::abs(wheel.low), std::abs(wheel.high)});
  }
  const double tolerance = kSlack + dynamics_.resolution + kShareOfSpeed * fastest;
  const double slowest = std::max({kCreep, 4 * dynamics_.resolution, kShareOfSpeed * fastest});
  const double turn = twist.omega * half_track_;
  const std::array<double, 2> speeds{twist.v - turn, twist.v + turn};
  double excess = 0;  // [m/s]
  double stands = 0;  // [m/s] the least speed due of a wheel that stands
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [low, high] = allowed[i];
    excess = std::max({excess, speeds[i] - high, low - speeds[i]});
    const double least = std::max({0.0, low, -high});
    const double along = low > 0 ? speeds[i] : -speeds[i];
    if (least > slowest && along < kStill * least) stands = std::max(stands, least);
  }
  const bool enough = dynamics_.checked;
  too_fast_.reports = excess > tolerance ? too_fast_.reports + 1 : 0;
  if (too_fast_.reports >= kReports) return true;
  if (enough && excess > kSurely * tolerance) return true;
  too_slow_ = stands > 0 ? Doubt{too_slow_.reports + 1, too_slow_.way + stands * dt} : Doubt{};
  if (enough && stands > kClearly) return true;
  return too_slow_.reports >= kReports && too_slow_.way > kSeenToStand;
}

}  // namespace drivers
