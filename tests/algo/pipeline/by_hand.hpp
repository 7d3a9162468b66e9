// tests/algo/pipeline/by_hand.hpp: a robot that a person drives, in a world without a simulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/algo/worlds.hpp"

#include "algo/diff_drive.hpp"
#include "algo/pipeline/pipeline.hpp"

namespace by_hand {

using algo::Joystick;
using algo::Pose2;
using algo::Vec2;

/// A robot driven by hand through the whole pipeline. It answers within its limits, or at once.
struct ByHand {
  explicit ByHand(bool rectangle = false, unsigned delay = 0, bool at_once_ = false)
      : at_once(at_once_), late(delay) {
    spec = {.radius = 0.35,
            .half_track = 0.25,
            .period = 0.025,
            .max_v = 0.5,
            .max_omega = 1.0,
            .max_acceleration = 0.5,
            .max_angular_acceleration = 4,
            .command_delay = 0.025 * delay,
            .drives = true};
    if (rectangle) {
      spec.half_length = 0.254;
      spec.half_width = 0.215;
      spec.radius = std::hypot(0.254, 0.215);
      spec.max_v = 2.0;
      spec.max_omega = 2.5;
      spec.max_acceleration = 3;
      spec.max_angular_acceleration = 8;
    }
  }

  void start() {
    pipeline = std::make_unique<algo::Pipeline>(algo::PipelineConfig{}, spec);
    odometry = pose;
    pipeline->reset(pose);
  }

  void sense() {
    t.observation.clear_sensors();
    t.observation.stamp = stamp;
    t.observation.odometry = {stamp, odometry, twist};
    if (scans) add_scan({});
    if (rear_scanner) add_scan({0, 0, std::numbers::pi});
    for (const double bearing : sonars) {
      const Pose2 mount{0.35 * std::cos(bearing), 0.35 * std::sin(bearing), bearing};
      const Pose2 at_W = compose(pose, mount);
      const double range = worlds::cast(at_W.position(), algo::direction(at_W.heading), world);
      const bool hit = range < 5;
      t.observation.sonar.push_back(
          {mount, stamp, hit ? range : 5, 5, hit ? algo::Beam::Ok : algo::Beam::Free});
    }
  }
  void add_scan(const Pose2& mount) {
    algo::LaserScan& scan = t.observation.scans.append();
    scan.mount_R = mount;
    scan.stamp = stamp;
    worlds::scan_world(compose(pose, mount), world, 8, scan);
  }

  /// Nobody touches the stick.
  void idle(double seconds) {
    const double end = stamp + seconds;
    while (stamp < end - 1e-9) {
      sense();
      t.requests.clear();
      pipeline->tick(t);
      stamp += spec.period;
    }
  }

  void tick(const Joystick& stick) {
    sense();
    t.requests.clear();
    t.requests.push_back(stick);
    pipeline->tick(t);
    algo::Twist2 wanted = t.command.base;
    if (!late.empty()) {
      std::rotate(late.begin(), late.begin() + 1, late.end());
      std::swap(wanted, late.back());
    }
    const double dv = spec.max_acceleration * spec.period;
    const double dw = spec.max_angular_acceleration * spec.period;
    if (at_once) {
      twist = wanted;
    } else {
      twist = {twist.v + std::clamp(wanted.v - twist.v, -dv, dv),
               twist.omega + std::clamp(wanted.omega - twist.omega, -dw, dw)};
    }
    pose = integrate_arc(pose, twist, spec.period);
    odometry = integrate_arc(odometry, twist, spec.period);
    stamp += spec.period;
    least = std::min(least, clearance());
    fastest_back = std::max(fastest_back, -twist.v);
  }
  void hold(const Joystick& stick, double seconds) {
    const double end = stamp + seconds;
    while (stamp < end - 1e-9) tick(stick);
  }

  /// [m] From the hull's outline, sampled every centimetre.
  double clearance() const {
    if (spec.half_length <= 0) {
      return worlds::surface_distance(pose.position(), world) - spec.radius;
    }
    double nearest = 10;
    for (double s = -1; s <= 1; s += 0.04) {
      for (const double side : {-1.0, 1.0}) {
        const Vec2 along(s * spec.half_length, side * spec.half_width);
        const Vec2 across(side * spec.half_length, s * spec.half_width);
        nearest = std::min({nearest,
                            worlds::surface_distance(to_parent(pose, along), world),
                            worlds::surface_distance(to_parent(pose, across), world)});
      }
    }
    return nearest;
  }

  algo::RobotSpec spec{};
  bool at_once = false;
  bool scans = true;
  bool rear_scanner = false;
  std::vector<double> sonars{};  // [rad] axes of a ring on the hull
  std::vector<algo::Twist2> late{};
  worlds::World world{};
  std::unique_ptr<algo::Pipeline> pipeline{};
  algo::Telemetry t{};
  Pose2 pose{};
  Pose2 odometry{};  // the same, until somebody moves the robot
  algo::Twist2 twist{};
  double stamp = 0;
  double least = 10;        // [m]
  double fastest_back = 0;  // [m/s]
};

inline std::vector<Vec2> box(const Vec2& low, const Vec2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

}  // namespace by_hand
