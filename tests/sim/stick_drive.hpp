// tests/sim/stick_drive.hpp: drives by a random stick and records contacts.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "algo/pipeline/pipeline.hpp"
#include "server/run/robot_library.hpp"
#include "sim/random.hpp"
#include "sim/world.hpp"

namespace stick {

/// A new deflection every 0.3 to 2.5 s: full as often as partial, sometimes none.
class RandomStick {
 public:
  explicit RandomStick(std::uint64_t seed) : random_(seed, 0x5714C) {}

  algo::Joystick operator()(double stamp) {
    if (stamp < until_) return stick_;
    until_ = stamp + random_.uniform(0.3, 2.5);
    stick_ = {axis(), axis()};
    return stick_;
  }

 private:
  double axis() {
    const double kind = random_.uniform();
    if (kind < 0.1) return 0;
    if (kind < 0.5) return random_.uniform() < 0.5 ? -1 : 1;
    return random_.uniform(-1, 1);
  }

  sim::Random random_;
  algo::Joystick stick_{};
  double until_ = 0;  // [s] run clock
};

struct Outcome {
  int contacts = 0;                  // caused by the moving robot
  double driven = 0;                 // [m] of its centre, by its true pose
  double turned = 0;                 // [rad]
  double backed = 0;                 // [m] of those backwards
  double fastest_back = 0;           // [m/s]
  double least = 10;                 // [m] clearance
  std::vector<std::string> where{};  // a text per contact
};

/// Drives `scenario` for `seconds` by `stick(stamp)`, sampled at 10 Hz.
template <typename Stick>
Outcome drive(const sim::Scenario& scenario, std::uint64_t seed, double seconds, Stick&& stick) {
  sim::World world(scenario, seed);
  algo::Pipeline pipeline({.controller = scenario.controller}, world.spec());
  algo::Telemetry t;
  world.reset(t.observation);
  pipeline.reset(t.observation.odometry.pose);
  Outcome outcome;
  algo::GroundTruth before = *world.ground_truth();
  double next_word = 0;
  while (t.observation.stamp < seconds) {
    t.requests.clear();
    if (t.observation.stamp >= next_word) {
      t.requests.push_back(stick(t.observation.stamp));
      next_word = t.observation.stamp + 0.1;
    }
    pipeline.tick(t);
    const algo::Command command = t.command;
    if (!world.step(command, t.observation)) break;
    const algo::GroundTruth now = *world.ground_truth();
    const algo::Vec2 way = now.pose.position() - before.pose.position();
    const double turn = algo::wrap_angle(now.pose.heading - before.pose.heading);
    const double ahead = way.dot(algo::direction(before.pose.heading));
    outcome.driven += way.norm();
    outcome.turned += std::abs(turn);
    if (ahead < 0) {
      outcome.backed -= ahead;
      outcome.fastest_back = std::max(outcome.fastest_back, -ahead / scenario.period);
    }
    outcome.least = std::min(outcome.least, now.clearance);
    const bool moves = way.norm() > 1e-5 || std::abs(turn) > 1e-5 || command != algo::Command{};
    if (now.collided && !before.collided && moves) {
      ++outcome.contacts;
      char text[160];
      std::snprintf(text,
                    sizeof text,
                    "%.2f s at (%.2f, %.2f, %.2f): %.3f m/s, %.2f rad/s, commanded %.3f, %.2f",
                    t.observation.stamp,
                    now.pose.x,
                    now.pose.y,
                    now.pose.heading,
                    ahead / scenario.period,
                    turn / scenario.period,
                    command.base.v,
                    command.base.omega);
      outcome.where.emplace_back(text);
    }
    before = now;
  }
  return outcome;
}

inline void add(sim::Scenario& scenario, const algo::Pose2& pose_W, const algo::Shape& shape) {
  algo::Obstacle obstacle;
  obstacle.id = static_cast<std::uint32_t>(scenario.obstacles.size() + 1);
  obstacle.pose_W = pose_W;
  obstacle.shape = shape;
  scenario.obstacles.push_back(obstacle);
}

inline void add_room(sim::Scenario& scenario, double half_x, double half_y) {
  const double quarter = std::numbers::pi / 2;
  add(scenario, {half_x, 0, quarter}, algo::Wall{2 * half_y + 0.1, 0.1});
  add(scenario, {-half_x, 0, quarter}, algo::Wall{2 * half_y + 0.1, 0.1});
  add(scenario, {0, half_y, 0}, algo::Wall{2 * half_x + 0.1, 0.1});
  add(scenario, {0, -half_y, 0}, algo::Wall{2 * half_x + 0.1, 0.1});
}

/// "room" with boxes and columns, "corridor" with a bend, "slalom" of thin posts, "narrow" all
/// round.
inline constexpr std::array<const char*, 4> kWorlds{"room", "corridor", "slalom", "narrow"};

/// One of kWorlds for `robot`, with the default scanner and no rear sensor.
inline sim::Scenario world(const std::string& name,
                           const std::string& robot,
                           sim::PhysicsKind physics) {
  sim::Scenario s;
  s.name = "stick-" + name;
  s.robot = server::builtin_robot(robot);
  s.physics = physics;
  if (name == "room") {
    add_room(s, 3, 2.5);
    add(s, {1.4, 0.9, 0.3}, algo::Box{0.6, 0.4});
    add(s, {-1.3, 1.2, 0.8}, algo::Box{0.3, 0.9});
    add(s, {1.2, -1.2, 0}, algo::Cylinder{0.25});
    add(s, {-1.5, -1.1, 0}, algo::Cylinder{0.15});
    add(s, {2.3, -0.2, 0}, algo::Cylinder{0.04});
  } else if (name == "corridor") {
    add_room(s, 3, 2.5);
    add(s, {-0.6, 1.65, 0}, algo::Box{4.8, 1.7});   // the corridor is 1.6 m wide and turns
    add(s, {-0.6, -1.65, 0}, algo::Box{4.8, 1.7});  // both ways at its end
  } else if (name == "slalom") {
    add_room(s, 4, 1.8);
    for (int k = 0; k < 5; ++k) {
      add(s, {-2.8 + 1.5 * k, k % 2 == 0 ? 0.65 : -0.65, 0}, algo::Cylinder{0.05});
    }
    add(s, {3.0, 0.9, 0}, algo::Box{0.05, 0.05});
    s.start = {-3.2, -0.6, 0};
  } else {
    add_room(s, 0.9, 0.8);
  }
  return s;
}

}  // namespace stick
