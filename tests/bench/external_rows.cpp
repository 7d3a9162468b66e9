// tests/bench/external_rows.cpp: the round trip to a controller outside the program: world, filter,
// question, answer, gate.
#include <memory>
#include <string>

#include "tests/bench/driving.hpp"
#include "tests/bench/rows.hpp"
#include "tests/folders.hpp"
#include <fmt/core.h>

#include "server/external/registration.hpp"

namespace bench {
namespace {

/// World and pipeline of a controller by name.
class Loop {
 public:
  Loop(const std::string& controller, const algo::ControllerCatalogue& catalogue)
      : world_(room_scenario(20, sim::PhysicsKind::Kinematic, {full_laser()}), 1),
        pipeline_({.controller = controller, .by_hand = false}, world_.spec(), catalogue) {
    world_.reset(t_.observation);
    pipeline_.reset(t_.observation.odometry.pose);
    pipeline_.tick(t_);
  }
  void tick() {
    patrol_.direct(t_);
    world_.step(t_.command, t_.observation);
    pipeline_.tick(t_);
  }
  algo::Pose2 pose() const { return t_.observation.odometry.pose; }

 private:
  sim::World world_;
  algo::Pipeline pipeline_;
  Patrol patrol_{};
  algo::Telemetry t_{};
};

/// [1/s] Ticks a second of wall time: the other process counts too.
double rate(const std::string& controller, const algo::ControllerCatalogue& catalogue, int ticks) {
  Loop loop(controller, catalogue);
  Loop again(controller, catalogue);
  for (int i = 0; i < 50; ++i) loop.tick();
  for (int i = 0; i < 50; ++i) again.tick();
  require(loop.pose() == again.pose(), "P23: the same controller drives two ways");
  const double begin = wall();
  for (int i = 0; i < ticks; ++i) loop.tick();
  return ticks / (wall() - begin);
}

}  // namespace

void external(Pass& pass) {
  const std::string examples = (tests::folder().parent_path() / "docs" / "examples").string();
  const algo::ControllerCatalogue catalogue = server::external::catalogue_with(
      {{.name = "object", .command = TAUTLINE_EXAMPLE_CONTROLLER},
       {.name = "python", .command = "python3 -B " + examples + "/go_to_goal.py"}});
  const int ticks = pass.count(20'000, 200);
  std::vector<double> ours;
  std::vector<double> object;
  std::vector<double> python;
  for (int repetition = 0; repetition < pass.count(5, 1); ++repetition) {
    ours.push_back(rate("go_to_goal", catalogue, ticks));
    object.push_back(rate("object", catalogue, ticks));
    python.push_back(rate("python", catalogue, ticks));
  }
  const double inside = median(ours);
  const auto add = [&](const char* name, const std::vector<double>& rates, double floor) {
    pass.add({.row = "P23",
              .name = name,
              .value = median(rates),
              .unit = "1/s",
              .floor = floor,
              .noise = spread(rates),
              .note = fmt::format("{:.2f} of go_to_goal inside the program, {:.0f} ticks/s",
                                  median(rates) / inside,
                                  inside)});
  };
  add("controller as a shared object", object, 20'000);
  add("controller as a Python process", python, 5'000);
}

}  // namespace bench
