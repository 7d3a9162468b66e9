// server/cli/command_climbs.cpp: `tautline climbs`: measures what a robot drives over.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/lab/climb/climb_study.hpp"
#include "server/run/robot_library.hpp"

namespace server {
namespace {

/// Prints the field of the robot's file.
int measure_climbs(const std::string& name) {
  const algo::ClimbLimits climbs = climb::measure(own_robots().load_file_or_name(name));
  const double degrees = 180 / std::numbers::pi;
  fmt::print(R"("climbs": {{"step_up": {:.3f}, "step_down": {:.3f}, "trench": {:.3f}, )"
             R"("slope_up_deg": {:.0f}, "slope_down_deg": {:.0f}}})"
             "\n",
             climbs.step_up,
             climbs.step_down,
             climbs.trench,
             climbs.slope_up * degrees,
             climbs.slope_down * degrees);
  return kReached;
}

}  // namespace

void add_climbs_command(Command app, int& status) {
  auto robot = std::make_shared<std::string>();
  const Command command = app.add_subcommand(
      "climbs", "Measure in simulation which steps, trenches and slopes a robot drives over");
  command.add_option("ROBOT", *robot, "Name of a robot model, or path of its .json file")
      .required();
  command.callback([robot, &status] { status = measure_climbs(*robot); });
}

}  // namespace server
