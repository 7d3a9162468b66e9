// tests/algo/baselines/drive.hpp: drives a controller through a world, with limited accelerations
// and an exact flat-time scan only.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "tests/algo/worlds.hpp"

#include "algo/diff_drive.hpp"
#include "algo/driving.hpp"
#include "algo/perceive.hpp"
#include "algo/pipeline/controllers.hpp"

namespace baselines {

using algo::Vec2;

struct Outcome {
  std::string name{};      // reached, collided or out_of_time
  double time = 0;         // [s]
  double path = 0;         // [m]
  double clearance = 1e9;  // [m] least, hull to surface
  Vec2 end{0, 0};
  double late_path = 0;  // [m] driven in the last 20 s
};

/// The robot's sensors besides its scanner.
using Sense = std::function<void(const algo::Pose2&, const worlds::World&, algo::Observation&)>;

class Drive {
 public:
  Drive(const std::string& controller, worlds::World world, const Vec2& goal)
      : world_(std::move(world)),
        controller_(algo::builtin_controllers().at(controller).make()),
        goal_(goal) {
    controller_->reset(pose_);
  }

  Drive& without_laser(Sense sonar) {
    sonar_ = std::move(sonar);
    return *this;
  }
  Drive& watch(std::function<void(const algo::ControlOutput&)> watch) {
    watch_ = std::move(watch);
    return *this;
  }
  algo::RobotSpec& spec() { return spec_; }
  algo::Parameters& parameters() { return parameters_; }

  Outcome run(double limit = 90) {
    Outcome outcome;
    for (int tick = 0;; ++tick) {
      outcome.time = tick * kPeriod;
      outcome.end = pose_.position();
      const double room = hull_clearance();
      outcome.clearance = std::min(outcome.clearance, room);
      if ((goal_ - pose_.position()).norm() < parameters_[algo::kGoalReach]) {
        return named("reached", outcome);
      }
      if (room < 0) return named("collided", outcome);
      if (outcome.time >= limit) return named("out_of_time", outcome);
      decide(outcome.time);
      const double step = move();
      outcome.path += step;
      if (outcome.time > limit - 20) outcome.late_path += step;
    }
  }

 private:
  static constexpr double kPeriod = 0.05;

  static Outcome named(const char* name, Outcome outcome) {
    outcome.name = name;
    return outcome;
  }

  /// Clearance of the disc, or of points on the rectangle's outline, at most 3 mm from a corner.
  double hull_clearance() const {
    if (!(spec_.half_length > 0)) {
      return worlds::surface_distance(pose_.position(), world_) - spec_.radius;
    }
    constexpr double kTouch = 0.003;
    double least = 1e9;
    const auto look = [&](double x, double y) {
      least = std::min(least, worlds::surface_distance(algo::to_parent(pose_, {x, y}), world_));
    };
    for (int k = -10; k <= 10; ++k) {
      for (const double side : {-1.0, 1.0}) {
        look(0.1 * k * spec_.half_length, side * spec_.half_width);
        look(side * spec_.half_length, 0.1 * k * spec_.half_width);
      }
    }
    return least - kTouch;
  }

  void decide(double stamp) {
    if (sonar_) {
      observation_.sonar.clear();
      sonar_(pose_, world_, observation_);
    } else {
      worlds::scan_world(pose_, world_, 8.0, scene_.scan);
      scene_.scan.stamp = stamp;
      scene_.fresh = true;
      algo::perceive(pose_, scene_);
    }
    algo::ControlInput in;
    in.stamp = stamp;
    in.dt = kPeriod;
    in.odometry = {stamp, pose_, twist_};
    in.scene = &scene_;
    in.observation = &observation_;
    in.goal = algo::SetGoal{goal_, std::nullopt};
    in.spec = &spec_;
    controller_->update(in, parameters_, out_);
    if (watch_) watch_(out_);
  }

  double move() {
    const double dv = spec_.max_acceleration * kPeriod;
    const double dw = spec_.max_angular_acceleration * kPeriod;
    twist_.v += std::clamp(out_.twist.v - twist_.v, -dv, dv);
    twist_.omega += std::clamp(out_.twist.omega - twist_.omega, -dw, dw);
    pose_ = algo::integrate_arc(pose_, twist_, kPeriod);
    return std::abs(twist_.v) * kPeriod;
  }

  worlds::World world_{};
  std::unique_ptr<algo::Controller> controller_{};
  Vec2 goal_{0, 0};
  Sense sonar_{};
  std::function<void(const algo::ControlOutput&)> watch_{};
  algo::Parameters parameters_{};
  algo::RobotSpec spec_{.radius = 0.35,
                        .half_track = 0.25,
                        .period = kPeriod,
                        .max_v = 0.5,
                        .max_omega = 1.0,
                        .max_acceleration = 0.5,
                        .max_angular_acceleration = 4,
                        .drives = true};
  algo::Scene scene_{};
  algo::Observation observation_{};
  algo::ControlOutput out_{};
  algo::Pose2 pose_{};
  algo::Twist2 twist_{};
};

}  // namespace baselines
