// server/lab/soak/contact_witness.cpp: the true world beside what was sensed of it.
#include "server/lab/soak/contact_witness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "algo/sensor_merge.hpp"

namespace server::soak {
namespace {

constexpr double kPatch = 0.05;         // [m]
constexpr int kPatches = 400;           // cells: 20 m
constexpr double kSamePlace = 0.12;     // [m] between the place touched and a return from it
constexpr double kMoverNear = 0.10;     // [m] around a person, where returns are the person's
constexpr double kSightGap = 0.5;       // [s] between two sightings of one person
constexpr double kKnown = 1.0;          // [s] for which a person must have been seen
constexpr double kTowards = 0.05;       // [m/s] towards a person,
constexpr double kTowardsStill = 0.01;  // and towards all else
constexpr double kApart = 0.5;          // [s] without contact, after which the next is another
constexpr double kPush = 0.5;           // [s] after a person's touch, in which the robot was pushed
constexpr double kReaction = 0.3;       // [s] from a person's touch until the robot must stand
constexpr double kLaserMemory = 110;    // [s] a little less than the guard's
constexpr double kSonarMemory = 0.5;    // [s]
constexpr std::size_t kTrail = 12;      // poses
constexpr std::size_t kRecent = 4;      // of which the last give the robot's motion
constexpr double kRimApart = 0.01;      // [m]

int cell_of(double metres) {
  return algo::whole_below(metres / kPatch) + kPatches / 2;
}

std::vector<algo::Vec2> rim_of(const sim::Hull& hull) {
  std::vector<algo::Vec2> rim;
  if (hull.is_disc()) {
    const int count = static_cast<int>(2 * std::numbers::pi * hull.radius / kRimApart);
    for (int k = 0; k < count; ++k) {
      rim.push_back(hull.radius * algo::direction(2 * std::numbers::pi * k / count));
    }
    return rim;
  }
  const algo::Vec2 half(hull.half_length, hull.half_width);
  const auto along = [](double length, const auto& at) {
    const int count = static_cast<int>(std::ceil(2 * length / kRimApart));
    for (int k = 0; k <= count; ++k) at(length * (2.0 * k / count - 1));
  };
  for (const double side : {-1.0, 1.0}) {
    along(half.x(), [&](double x) { rim.emplace_back(x, side * half.y()); });
    along(half.y(), [&](double y) { rim.emplace_back(side * half.x(), y); });
  }
  return rim;
}

}  // namespace

std::string_view name(Touch touch) {
  switch (touch) {
    case Touch::Seen:
      return "seen";
    case Touch::Unseen:
      return "unseen";
    case Touch::Came:
      return "came";
    default:
      return "pushed";
  }
}

ContactWitness::ContactWitness(const sim::Scenario& scenario, const algo::RobotSpec& spec)
    : scenario_(scenario),
      hull_{spec.radius, spec.half_length, spec.half_width},
      memory_(spec.has_laser ? kLaserMemory : kSonarMemory),
      returned_(static_cast<std::size_t>(kPatches) * kPatches,
                -std::numeric_limits<float>::infinity()),
      rim_R_(rim_of(hull_)) {
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    if (obstacle.path) {
      const auto* const round = std::get_if<algo::Cylinder>(&obstacle.shape);
      movers_.push_back({.index = set_.size(), .radius = round != nullptr ? round->radius : 0});
    }
    set_.add(obstacle);
  }
}

void ContactWitness::see(const algo::Observation& observation, const algo::GroundTruth& truth) {
  const double now = observation.stamp;
  for (Mover& mover : movers_) {
    const algo::Pose2 pose_W = sim::pose_at(scenario_.obstacles[mover.index], now);
    mover.at_W = pose_W.position();
    set_.move(mover.index, pose_W);
  }
  trail_.push_back({now, truth.pose, observation.odometry.pose});
  if (trail_.size() > kTrail) trail_.pop_front();
  const bool touches = truth.collided || truth.clearance < 0;
  if (touches) judge(now, truth.pose);
  if (!touches && touching_ && now - free_since_ > kApart) {
    ++counts_.at(static_cast<std::size_t>(worst_));
    touching_ = false;
  }
  if (touches) free_since_ = now;
  take_returns(observation);
}

algo::Pose2 ContactWitness::pose_at(double stamp) const {
  const auto nearest = std::ranges::min_element(
      trail_, {}, [stamp](const Place& place) { return std::abs(place.stamp - stamp); });
  return nearest->pose_W;
}

void ContactWitness::take_returns(const algo::Observation& observation) {
  for (const algo::LaserScan& scan : observation.scans) {
    const algo::Pose2 robot_W = pose_at(scan.stamp - scan.sweep_time() / 2);
    const algo::Pose2 sensor_W = algo::compose(robot_W, scan.mount_R);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.status[i] != algo::Beam::Ok) continue;
      take_return(
          sensor_W.position() + scan.ranges[i] * algo::direction(sensor_W.heading + scan.angle(i)),
          scan.stamp);
    }
  }
  for (const algo::RangeReading& reading : observation.sonar) {
    if (reading.status != algo::Beam::Ok) continue;
    const algo::Pose2 sensor_W = algo::compose(pose_at(reading.stamp), reading.mount_R);
    constexpr int kArc = 6;
    for (int k = -kArc; k <= kArc; ++k) {
      const double turn = algo::SensorMerge::kHalfCone * k / kArc;
      take_return(sensor_W.position() + reading.range * algo::direction(sensor_W.heading + turn),
                  reading.stamp);
    }
  }
}

void ContactWitness::take_return(const algo::Vec2& point_W, double stamp) {
  for (Mover& mover : movers_) {
    if ((point_W - mover.at_W).norm() > mover.radius + kMoverNear) continue;
    if (stamp - mover.last > kSightGap || mover.last < 0) mover.since = stamp;
    mover.last = stamp;
    return;
  }
  const int column = cell_of(point_W.x());
  const int row = cell_of(point_W.y());
  if (column < 0 || row < 0 || column >= kPatches || row >= kPatches) return;
  returned_[static_cast<std::size_t>(row) * kPatches + static_cast<std::size_t>(column)] =
      static_cast<float>(stamp);
}

bool ContactWitness::was_seen(const algo::Vec2& point_W, double now) const {
  constexpr int kReach = static_cast<int>(kSamePlace / kPatch) + 1;
  constexpr int kHalf = kPatches / 2;
  const int column = cell_of(point_W.x());
  const int row = cell_of(point_W.y());
  for (int y = row - kReach; y <= row + kReach; ++y) {
    for (int x = column - kReach; x <= column + kReach; ++x) {
      if (x < 0 || y < 0 || x >= kPatches || y >= kPatches) continue;
      const algo::Vec2 middle_W((x - kHalf + 0.5) * kPatch, (y - kHalf + 0.5) * kPatch);
      if ((middle_W - point_W).norm() > kSamePlace) continue;
      const float at =
          returned_[static_cast<std::size_t>(y) * kPatches + static_cast<std::size_t>(x)];
      if (now - static_cast<double>(at) < memory_) return true;
    }
  }
  return false;
}

/// The place of the outline that is deepest in the obstacle, or nearest to it.
algo::Vec2 ContactWitness::touched_point(std::size_t obstacle, const algo::Pose2& pose_W) const {
  algo::Vec2 best_W = pose_W.position();
  double least = std::numeric_limits<double>::infinity();
  for (const algo::Vec2& rim_R : rim_R_) {
    const algo::Vec2 p_W = algo::to_parent(pose_W, rim_R);
    const double far = set_.distance(obstacle, p_W);
    if (far >= least) continue;
    least = far;
    best_W = p_W;
  }
  return best_W;
}

/// [m/s] The fastest at which the place of the hull at `point_W` neared the obstacle, as that
/// stands now, in the last few ticks: by its true motion, or by its wheels alone.
double ContactWitness::approach(std::size_t obstacle,
                                const algo::Vec2& point_W,
                                Motion motion) const {
  double fastest = 0;
  const algo::Vec2 p_R = algo::to_child(trail_.back().pose_W, point_W);
  const std::size_t from = trail_.size() - std::min(trail_.size(), kRecent);
  for (std::size_t i = from; i + 1 < trail_.size(); ++i) {
    const Place& a = trail_[i];
    const Place& b = trail_[i + 1];
    const algo::Pose2 rolled_W =
        algo::compose(a.pose_W, algo::pose_step(a.odometry_W, b.odometry_W));
    const algo::Pose2& to_W = motion == Motion::True ? b.pose_W : rolled_W;
    const algo::Vec2 step_W = algo::to_parent(to_W, p_R) - algo::to_parent(a.pose_W, p_R);
    const double nearer =
        set_.distance(obstacle, point_W) - set_.distance(obstacle, point_W + step_W);
    fastest = std::max(fastest, nearer / (b.stamp - a.stamp));
  }
  return fastest;
}

void ContactWitness::judge(double now, const algo::Pose2& pose_W) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < set_.size(); ++i) {
    if (!set_.may_reach(i, pose_W.position(), hull_.radius + 0.1)) continue;
    const double clearance = set_.clearance(i, hull_, pose_W);
    if (clearance >= least) continue;
    least = clearance;
    nearest = i;
  }
  if (!std::isfinite(least)) return;
  const algo::Vec2 at_W = touched_point(nearest, pose_W);
  if (!touching_) touching_since_ = now;
  // A robot that a person pushes moves towards them by its wheels only, if these do not stop.
  const bool pushed = now - person_touched_ < kPush;
  const double speed = approach(nearest, at_W, pushed ? Motion::OfWheels : Motion::True);
  const bool stopping = pushed && now - touching_since_ < kReaction;
  const auto mover = std::ranges::find(movers_, nearest, &Mover::index);
  Touch touch = Touch::Unseen;
  if (mover != movers_.end()) {
    const bool known = now - mover->last < kSightGap && mover->last - mover->since >= kKnown;
    touch = known && speed > kTowards && !stopping ? Touch::Seen : Touch::Came;
    person_touched_ = now;
  } else if (pushed || speed < kTowardsStill) {
    touch = Touch::Pushed;
  } else if (was_seen(at_W, now)) {
    touch = Touch::Seen;
  }
  if (touch == Touch::Seen && (!touching_ || worst_ != Touch::Seen)) {
    seen_.push_back(
        fmt::format("{:.2f} s at ({:.2f}, {:.2f}, {:.2f}): {} {} at ({:.2f}, {:.2f}), {:.2f} m/s",
                    now,
                    pose_W.x,
                    pose_W.y,
                    pose_W.heading,
                    mover != movers_.end() ? "person" : "obstacle",
                    scenario_.obstacles[nearest].id,
                    at_W.x(),
                    at_W.y(),
                    speed));
  }
  worst_ = touching_ ? std::min(worst_, touch) : touch;
  touching_ = true;
}

}  // namespace server::soak
