// algo/pipeline/stick_guard.cpp: the known obstacles around the robot, and the proof that it can
// stop before them.
#include "algo/pipeline/stick_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/perceive.hpp"
#include "algo/pipeline/reactive.hpp"

namespace algo {
namespace {

// [s] between two scans mapped while nobody holds the stick. The newest scan of the scanner ahead
// is mapped when somebody takes the stick; another scanner's is gone by then.
constexpr double kIdleEvery = 1.0;
constexpr double kIdleBesideEvery = 0.25;
constexpr double kStep = 0.02;  // [s] largest step of a roll-out
constexpr double kActs = 4;  // ticks a command is assumed to act: bases answer up to two ticks late
constexpr double kRounding = 1e-9;   // [m]
constexpr double kBack = 0.5;        // of the stick's travel: this far back, the driver insists,
constexpr double kStraight = 0.2;    // and at most this far aside
constexpr double kNoMotion = 0.015;  // [m/s] so slow that it could back into the unseen unnoticed
constexpr std::uint16_t kMemory = 4500;  // scans: two minutes of an LMS200
constexpr std::size_t kMostBeside = 1024;

bool finite(const Observation& seen) {
  return std::isfinite(seen.stamp) && finite(seen.odometry.pose) && finite(seen.odometry.twist);
}

/// Shares of the stick's two components, in the order in which a driver would miss them least:
/// slower in the wanted direction, then slower in both, then turning alone.
struct Shares {
  double v = 1, omega = 1;
};
constexpr std::array<Shares, 20> kShares{
    {{1, 1},    {0.8, 1},     {0.6, 1},   {0.45, 1},    {0.3, 1},   {0.2, 1}, {0.1, 1},
     {0.05, 1}, {0.75, 0.75}, {0.5, 0.5}, {0.25, 0.25}, {0.1, 0.1}, {0, 1},   {0.5, 0},
     {0.25, 0}, {0.1, 0},     {0.05, 0},  {0, 0.5},     {0, 0.2},   {0, 0.05}}};

}  // namespace

StickGuard::StickGuard() {
  beside_W_.reserve(kMostBeside);
  map_.remember_for(kMemory);
}

void StickGuard::reset(const Pose2& start_W) {
  map_.reset(start_W.position());
  points_.reset();
  rear_.reset();
  placed_ = false;
  next_look_ = 0;
  next_look_beside_ = 0;
  mapped_.reset();
  straight_back_since_.reset();
}

void StickGuard::look(const Resource& in, const LaserScan& scan) {
  // NaN must not enter the map.
  if (scan.size() == 0 || !std::isfinite(scan.stamp) || !all_finite(scan.ranges)) return;
  const Pose2 sensor_W = points_.map(scan);
  map_.insert(scan, sensor_W, points_.points_W(), nothing_moves_);
  // No obstacle can be inside the hull.
  const Pose2& here = in.observation->odometry.pose;
  map_.erase_near(here.position(), in.spec->radius, [&](const Vec2& point_W) {
    return hull_.covers(here, point_W);
  });
}

void StickGuard::sense(const Resource& in) {
  const Observation& seen = *in.observation;
  if (!finite(seen)) return;
  const Pose2& here = seen.odometry.pose;
  if (!hull_.is_of(*in.spec)) hull_ = HullCheck(*in.spec);
  rear_.take(seen);
  points_.follow(here, seen.stamp);
  watch_insistence(in);
  const LaserScan* ahead = front_scan(seen);
  const LaserScan& newest = in.scene->scan;  // of the scanner ahead, filtered
  const bool others = seen.scans.size() > (ahead != nullptr ? 1U : 0U);
  const bool looks = newest.size() > 0 && mapped_ != newest.stamp &&
                     (in.manual || (ahead != nullptr && seen.stamp >= next_look_));
  const bool looks_beside = others && (in.manual || seen.stamp >= next_look_beside_);
  if (placed_ && !in.manual && !looks && !looks_beside) return;
  map_.follow(here.position());
  if (!placed_) hull_.take_place(map_.seen(), here);
  placed_ = true;
  hull_.stand_on(map_.seen(), here);
  if (looks) {
    look(in, newest);
    mapped_ = newest.stamp;
    next_look_ = seen.stamp + kIdleEvery;
  }
  if (!looks_beside) return;
  for (const LaserScan& scan : seen.scans) {
    if (&scan != ahead) look(in, scan);
  }
  next_look_beside_ = seen.stamp + kIdleBesideEvery;
}

/// A robot may stand where it can neither turn to look nor has seen what is behind it.
void StickGuard::watch_insistence(const Resource& in) {
  const double now = in.observation->stamp;
  const bool straight_back =
      in.manual && in.joystick.forward <= -kBack && std::abs(in.joystick.turn) <= kStraight;
  if (!straight_back) straight_back_since_.reset();
  if (straight_back && !straight_back_since_) straight_back_since_ = now;
  insists_ = straight_back && now - *straight_back_since_ >= kInsist;
}

/// [m] Distance from the hull at `pose_W` to the nearest known obstacle.
double StickGuard::room(const Pose2& pose_W) const {
  double least = hull_.clearance(map_, pose_W);
  for (const Vec2& point_W : beside_W_) least = std::min(least, hull_.distance(pose_W, point_W));
  return least;
}

bool StickGuard::safe(const Resource& in, const Twist2& command, Answer answer) const {
  const double pieces = std::max(1.0, std::ceil(in.dt / kStep));
  const double step = in.dt / pieces;
  const auto on = [&](const MotionState& state, const Twist2& wanted) {
    if (answer == Answer::Ramped) return advanced(state, wanted, limits_, step);
    return MotionState{integrate_arc(state.pose_W, wanted, step), wanted};
  };
  MotionState state{in.observation->odometry.pose, in.observation->odometry.twist};
  for (const Twist2& given : in.under_way) {
    for (int k = 0; k < pieces; ++k) state = on(state, given);
  }
  // Already too close: no step may lead closer until there is room again.
  double margin = std::min(kMargin, room(state.pose_W));
  const auto free = [&](const MotionState& next) {
    if (!may_back_ && hull_.enters_unseen(map_.seen(), next.pose_W, next.twist)) return false;
    const double left = room(next.pose_W);
    if (left < margin - kRounding) return false;
    margin = std::max(margin, std::min(kMargin, left));
    return true;
  };
  const double acts = kActs * pieces + std::ceil(delay_ / step);
  for (int k = 0; k < acts; ++k) {
    state = on(state, command);
    if (!free(state)) return false;
  }
  return rests(state, limits_, step, free);
}

bool StickGuard::safe(const Resource& in, const Twist2& command) const {
  return safe(in, command, Answer::AtOnce) && safe(in, command, Answer::Ramped);
}

Twist2 StickGuard::limit(const Resource& in, const Twist2& wanted, double delay) {
  const Observation& seen = *in.observation;
  if (wanted == Twist2{} || !finite(seen)) return {};
  delay_ = delay;
  limits_ = {in.spec->max_v,
             in.spec->max_omega,
             in.spec->max_acceleration,
             in.spec->max_angular_acceleration};
  const Pose2& here = seen.odometry.pose;
  beside_W_.clear();
  in.merge->each_beside(here, seen.stamp, in.scene->scan, [&](const Vec2& point_W) {
    if (beside_W_.size() < kMostBeside) beside_W_.push_back(point_W);
  });
  Twist2 asked = wanted;
  const bool looks_back = rear_.looks(seen.stamp);
  if (!looks_back) asked.v = std::max(asked.v, -kBlindSpeed);
  may_back_ = looks_back || insists_;
  for (const Shares& share : kShares) {
    Twist2 command{share.v * asked.v, share.omega * asked.omega};
    if (command.v < 0 && command.v > -kNoMotion) command.v = 0;
    if (safe(in, command)) return command;
  }
  return {};
}

}  // namespace algo
