// algo/pipeline/stick_guard.cpp: the known obstacles around the robot, and the proof that it can
// stop before them.
#include "algo/pipeline/stick_guard.hpp"

#include <algorithm>
#include <cmath>

#include "algo/perceive.hpp"
#include "algo/pipeline/nearest_twist.hpp"
#include "algo/pipeline/reactive.hpp"

namespace algo {
namespace {

// [s] between two scans mapped while nobody holds the stick. The newest scan of the scanner ahead
// is mapped when somebody takes the stick; another scanner's is gone by then.
constexpr double kIdleEvery = 1.0;
constexpr double kIdleBesideEvery = 0.25;
constexpr double kStep = 0.02;  // [s] largest step of a roll-out
constexpr double kActs = 4;  // ticks a command is assumed to act: bases answer up to two ticks late
constexpr double kRounding = 1e-9;     // [m]
constexpr double kNoMotion = 0.015;    // [m/s] so slow that it could back into the unseen unnoticed
constexpr double kSwerve = 1.0;        // [m/s2] a moving obstacle may leave its course by it,
constexpr double kWalk = 1.4;          // [m/s] and a slow one may walk off at once
constexpr double kBlur = 0.05;         // [m] error of a moving obstacle's outline
constexpr double kTowards = 0.02;      // [m/s] a slower motion is no approach
constexpr double kNearestEcho = 0.15;  // [m] a sonar reads nothing nearer
constexpr double kSamePlace = 0.15;    // [m] a sonar does not know its echo's bearing better
constexpr std::uint16_t kMemory = 4500;  // scans: two minutes of an LMS200
constexpr std::size_t kMostBeside = 1024;
constexpr std::size_t kMostMovers = 64;

bool finite(const Observation& seen) {
  return std::isfinite(seen.stamp) && finite(seen.odometry.pose) && finite(seen.odometry.twist);
}

}  // namespace

StickGuard::StickGuard() {
  beside_W_.reserve(kMostBeside);
  movers_.reserve(kMostMovers);
  map_.remember_for(kMemory);
}

void StickGuard::reset(const Pose2& start_W) {
  map_.reset(start_W.position());
  ahead_.reset();
  beside_.reset();
  shove_.reset();
  points_.reset();
  rear_.reset();
  placed_ = false;
  next_look_ = 0;
  next_look_beside_ = 0;
  mapped_.reset();
}

/// `movers` tracks the moving obstacles in this scanner's scans, `shove` notices shoves in them;
/// null: nothing does.
void StickGuard::look(const Resource& in,
                      const LaserScan& scan,
                      MoverWatch* movers,
                      ShoveWatch* shove) {
  // NaN must not enter the map.
  if (scan.size() == 0 || !std::isfinite(scan.stamp) || !all_finite(scan.ranges)) return;
  const Pose2 sensor_W = points_.map(scan);
  if (shove != nullptr && shove->take(scan, sensor_W, points_.points_W())) {
    forget_surroundings(in.observation->odometry.pose);
  }
  if (movers != nullptr) movers->take(scan, sensor_W, points_.points_W());
  map_.insert(scan, sensor_W, points_.points_W(), nothing_moves_);
  // No obstacle can be inside the hull.
  const Pose2& here = in.observation->odometry.pose;
  map_.erase_near(here.position(), in.spec->radius, [&](const Vec2& point_W) {
    return hull_.covers(here, point_W);
  });
}

/// The room to turn in is not known either: no place is taken as at the start.
void StickGuard::forget_surroundings(const Pose2& here_W) {
  map_.reset(here_W.position());
  hull_.stand_on(map_.seen(), here_W);
  ahead_.reset();
  beside_.reset();
}

void StickGuard::sense(const Resource& in) {
  const Observation& seen = *in.observation;
  if (!finite(seen)) return;
  if (!hull_.is_of(*in.spec)) hull_ = HullCheck(*in.spec);
  rear_.take(seen);
  points_.follow(seen.odometry.pose, seen.stamp);
  look_around(in);
  if (in.manual) prepare(in);
}

void StickGuard::look_around(const Resource& in) {
  const Observation& seen = *in.observation;
  const Pose2& here = seen.odometry.pose;
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
    look(in, newest, in.manual ? &ahead_ : nullptr, &shove_);
    mapped_ = newest.stamp;
    next_look_ = seen.stamp + kIdleEvery;
  }
  if (!looks_beside) return;
  MoverWatch* movers = in.manual ? &beside_ : nullptr;
  for (std::size_t i = 0; i < seen.scans.size(); ++i) {
    if (&seen.scans[i] == ahead) continue;
    look(in, seen.scans[i], movers, nullptr);
    movers = nullptr;  // a tracker follows one scanner
  }
  next_look_beside_ = seen.stamp + kIdleBesideEvery;
}

/// Collects all that the roll-outs of this tick compare with.
void StickGuard::prepare(const Resource& in) {
  const Observation& seen = *in.observation;
  limits_ = limits_of(*in.spec);
  may_back_ = rear_.looks(seen.stamp);
  beside_W_.clear();
  const Pose2& here = seen.odometry.pose;
  in.merge->each_beside(here, seen.stamp, in.scene->scan, [&](const Vec2& point_W) {
    bool mapped = false;  // a scanner has seen it too, and knows better where it is
    map_.each_near(point_W, kSamePlace, [&](const Vec2&) { mapped = true; });
    if (!mapped && beside_W_.size() < kMostBeside) beside_W_.push_back(point_W);
  });
  movers_.clear();
  for (MoverWatch* watch : {&ahead_, &beside_}) {
    watch->each(seen.stamp, [&](const Track& track) {
      if (movers_.size() < kMostMovers) movers_.push_back(track);
    });
  }
}

/// [m] Distance from the hull at `pose_W` to the nearest known obstacle; to an echo, less what a
/// sonar cannot tell.
double StickGuard::room(const Pose2& pose_W) const {
  double least = hull_.clearance(map_, pose_W);
  for (const Vec2& point_W : beside_W_) {
    least = std::min(least, hull_.distance(pose_W, point_W) - kNearestEcho);
  }
  return least;
}

/// True if the step of `step` [s] from one pose to another brings the hull nearer to something that
/// moves and may be within kMargin by then, `after` [s] from now: it may swerve meanwhile, and
/// somebody who has stopped may go on.
bool StickGuard::approaches(const Pose2& from_W,
                            const Pose2& to_W,
                            double after,
                            double step) const {
  for (const Track& track : movers_) {
    const Vec2 then_W = track.position_W + after * track.velocity_W;
    const double far = hull_.distance(to_W, then_W);
    const double swerve = kSwerve * after * after / 2;
    const double start = (kWalk - track.velocity_W.norm()) * after;
    const double reach = kMargin + kBlur + std::max(swerve, start);
    if (far - track.radius > reach) continue;
    if (hull_.distance(from_W, then_W) - far > kTowards * step) return true;
  }
  return false;
}

bool StickGuard::safe(const Resource& in, const Twist2& command, Answer answer) const {
  const double pieces = std::max(1.0, std::ceil(in.dt / kStep));
  const double step = in.dt / pieces;
  const auto on = [&](const MotionState& state, const Twist2& wanted) {
    if (answer == Answer::Ramped) return advanced(state, wanted, limits_, step);
    return MotionState{integrate_arc(state.pose_W, wanted, step, limits_.axle), wanted};
  };
  MotionState state{in.observation->odometry.pose, in.observation->odometry.twist};
  for (const Twist2& given : in.under_way) {
    for (int k = 0; k < pieces; ++k) state = on(state, given);
  }
  double after = step * pieces * static_cast<double>(in.under_way.size());
  Pose2 before_W = state.pose_W;
  // Already too close: no step may lead closer until there is room again.
  double left = room(state.pose_W);
  double margin = std::min(kMargin, left);
  const auto free = [&](const MotionState& next) {
    if (!may_back_ && hull_.enters_unseen(map_.seen(), next.pose_W, next.twist)) return false;
    after += step;
    if (approaches(before_W, next.pose_W, after, step)) return false;
    before_W = next.pose_W;
    // No point of the hull has come nearer than it has moved.
    const double farthest = in.spec->radius + std::abs(limits_.axle);  // of the hull, from the axle
    left -= step * (std::abs(next.twist.v) + std::abs(next.twist.omega) * farthest);
    if (left < kMargin) left = room(next.pose_W);
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

bool StickGuard::admits(const Resource& in, const Twist2& command) const {
  if (command == Twist2{}) return true;
  if (command.v < 0 && command.v > -kNoMotion) return false;
  if (!may_back_ && command.v < -kBlindSpeed) return false;
  return safe(in, command, Answer::AtOnce) && safe(in, command, Answer::Ramped);
}

Twist2 StickGuard::limit(const Resource& in, const Twist2& wanted, double delay) {
  delay_ = delay;
  if (!finite(*in.observation)) return {};
  Twist2 most = wanted;
  if (!may_back_) most.v = std::max(most.v, -kBlindSpeed);
  if (most.v < 0 && most.v > -kNoMotion) most.v = 0;
  return nearest_twist(
      wanted, most, full_stick(in), [&](const Twist2& twist) { return admits(in, twist); });
}

}  // namespace algo
