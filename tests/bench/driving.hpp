// tests/bench/driving.hpp: a robot in W(20) that never stops driving, tick by tick.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "tests/bench/rooms.hpp"

#include "algo/pipeline/pipeline.hpp"
#include "sim/world.hpp"

namespace bench {

inline sim::Scenario room_scenario(std::uint32_t obstacles,
                                   sim::PhysicsKind physics,
                                   std::vector<sim::LaserConfig> lasers) {
  sim::Scenario scenario;
  scenario.name = "w" + std::to_string(obstacles);
  scenario.physics = physics;
  scenario.period = kTick;
  scenario.obstacles = reference::room(obstacles);
  scenario.robot.sensors.lasers = std::move(lasers);
  return scenario;
}

/// Pipeline of the papers' filter with N = 2.
inline algo::Pipeline make_pipeline(const algo::RobotSpec& spec) {
  algo::PipelineConfig config{.by_hand = false};  // as in a headless run
  config.parameters.set(algo::kFilterHalfWidth, 2);
  return {config, spec};
}

/// Draws the strip of a tick out to `nodes` points, each `step` [m] farther on along the heading.
inline void stretch_strip(algo::Telemetry& t, std::size_t nodes, double step) {
  for (algo::Layer& layer : t.output.layers) {
    if (layer.name != "strip" || layer.empty()) continue;
    const std::vector<float> line = layer.values;
    const std::size_t points = line.size() / layer.axes;
    const algo::Vec2 way = step * algo::direction(t.observation.odometry.pose.heading);
    layer.values.clear();
    for (std::size_t i = 0; i < nodes; ++i) {
      const std::size_t k = 2 * (i * points / nodes);
      put(layer, algo::Vec2(algo::Vec2(line[k], line[k + 1]) + static_cast<double>(i) * way));
    }
  }
}

/// Gives an arrived or stuck robot the next corner of a square about the middle as goal.
class Patrol {
 public:
  void direct(algo::Telemetry& t) {
    t.requests.clear();
    if (t.mission == algo::Mission::Driving) return;
    constexpr std::array<std::array<double, 2>, 4> kCorners{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto& corner = kCorners[next_++ % kCorners.size()];
    t.requests.push_back(algo::SetGoal{{corner[0], corner[1]}, std::nullopt});
  }

 private:
  std::size_t next_ = 0;
};

/// World and pipeline, step by step.
class Driving {
 public:
  explicit Driving(const sim::Scenario& scenario)
      : world_(scenario, 1), pipeline_(make_pipeline(world_.spec())) {
    world_.reset(t.observation);
    pipeline_.reset(t.observation.odometry.pose);
    pipeline_.tick(t);
  }
  /// World, then control.
  void tick() {
    sense();
    pipeline_.tick(t);
  }
  void sense() {
    patrol_.direct(t);
    world_.step(t.command, t.observation);
  }
  void control() { pipeline_.tick(t); }
  algo::Pose2 truth() const { return world_.ground_truth()->pose; }
  const sim::World& world() const { return world_; }

  algo::Telemetry t{};

 private:
  sim::World world_;
  algo::Pipeline pipeline_;
  Patrol patrol_{};
};

}  // namespace bench
