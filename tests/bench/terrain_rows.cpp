// tests/bench/terrain_rows.cpp: whole ticks on uneven ground, with every sensor of the ground.
#include <memory>

#include "tests/algo/allocations.hpp"
#include "tests/bench/rooms.hpp"
#include "tests/bench/rows.hpp"
#include <fmt/format.h>

#include "server/run/run_spec.hpp"
#include "server/run/scenario_library.hpp"

namespace bench {
namespace {

/// A robot that drives to and fro over a scenario's ground.
class OnGround {
 public:
  OnGround(const std::string& scenario, const std::string& robot)
      : spec_(server::make_spec(server::ScenarioLibrary({}, {}).load(scenario), {.robot = robot})),
        robot_(server::make_robot(spec_)),
        pipeline_(server::pipeline_config(spec_), robot_->spec()) {
    robot_->reset(t_.observation);
    pipeline_.reset(t_.observation.odometry.pose);
    pipeline_.tick(t_);
  }

  /// @return allocations of the pipeline's part
  std::size_t tick() {
    t_.requests.clear();
    if (t_.mission != algo::Mission::Driving) {
      there_ = !there_;
      t_.requests.push_back(there_ ? *spec_.scenario.goal : algo::SetGoal{{0, 0}, std::nullopt});
    }
    robot_->step(t_.command, t_.observation);
    const std::size_t before = allocations::count();
    pipeline_.tick(t_);
    return allocations::count() - before;
  }
  double period() const { return robot_->spec().period; }

 private:
  server::RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  algo::Pipeline pipeline_;
  algo::Telemetry t_{};
  bool there_ = false;
};

constexpr int kWarm = 4000;  // ticks: once to the goal and back, so that every sentence was said

void count_allocations(OnGround& robot, int ticks, const std::string& where) {
  for (int k = 0; k < kWarm; ++k) robot.tick();
  std::size_t allocated = 0;
  for (int k = 0; k < ticks; ++k) allocated += robot.tick();
  require(allocated == 0, fmt::format("P25: {} heap allocations {}", allocated, where));
}

}  // namespace

void terrain(Pass& pass) {
  OnGround ramp("ramp", "robhaz_tall");
  OnGround trench("trench", "masuda");
  count_allocations(ramp, pass.count(4000, 200), "on the ramp");
  count_allocations(trench, pass.count(4000, 200), "before the trench");
  const auto times =
      pass.time("P25", {{"ramp", [&] { ramp.tick(); }}, {"trench", [&] { trench.tick(); }}});
  const auto add =
      [&](const char* name, const OnGround& robot, const Timing& time, const char* note) {
        pass.add({.row = "P25",
                  .name = name,
                  .value = robot.period() / time.seconds,
                  .unit = "x",
                  .floor = 100,
                  .stretch = 300,
                  .noise = time.spread,
                  .note = note});
      };
  add("tick over a ramp, times real time",
      ramp,
      times[0],
      "Bullet; laser, sonars, line camera, inclinometer");
  add("tick across trenches, times real time", trench, times[1], "Bullet; laser, floor sensors");
}

}  // namespace bench
