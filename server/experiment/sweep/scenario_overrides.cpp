// server/experiment/sweep/scenario_overrides.cpp: reads each field once, then sets it everywhere.
#include "server/experiment/sweep/scenario_overrides.hpp"

#include <optional>
#include <string>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "server/run/motion_json.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

/// Sets the fields of a scenario's "drive" that `fields` has, at `path` of the document.
void set_drive(const json& fields, const std::string& path, sim::Scenario& scenario) {
  json drive = to_json(scenario.drive);
  drive.update(fields);
  scenario.drive = drive_from_json({drive, path});
}

/// [m] As each scanner's own noise: a standard deviation, or a half width where it is uniform.
void set_laser_noise(double noise, sim::Scenario& scenario) {
  for (sim::LaserConfig& laser : scenario.robot.sensors.lasers) laser.noise = noise;
  for (sim::OtherRobot& other : scenario.robots) {
    if (!other.robot) continue;
    for (sim::LaserConfig& laser : other.robot->sensors.lasers) laser.noise = noise;
  }
}

void override_noise(const JsonReader& in, std::vector<sim::Scenario>& scenarios) {
  if (!in.has("noise")) return;
  const JsonReader noise = in.object("noise");
  noise.only({"laser", "odometry_scale", "odometry_noise", "odometry_slip", "yaw_slip"});
  std::optional<double> laser;
  if (noise.has("laser")) laser = noise.number("laser", {0, 1});
  json drive = noise.raw();
  drive.erase("laser");
  for (sim::Scenario& scenario : scenarios) {
    if (laser) set_laser_noise(*laser, scenario);
    set_drive(drive, in.at("noise"), scenario);
  }
}

void override_limits(const JsonReader& in, std::vector<sim::Scenario>& scenarios) {
  if (!in.has("limits")) return;
  const JsonReader limits = in.object("limits");
  limits.only({"max_v",
               "max_omega",
               "max_acceleration",
               "max_angular_acceleration",
               "ramps",
               "delay_ticks"});
  for (sim::Scenario& scenario : scenarios) set_drive(limits.raw(), in.at("limits"), scenario);
}

void override_time(const JsonReader& in, std::vector<sim::Scenario>& scenarios) {
  if (in.has("time_limit") && in.has("time_factor")) {
    in.fail("time_factor", "cannot stand beside time_limit");
  }
  const double limit = in.number_or("time_limit", 0, {0.1, 1e6});
  const double factor = in.number_or("time_factor", 1, {0.01, 100});
  for (sim::Scenario& scenario : scenarios) {
    if (in.has("time_limit")) scenario.time_limit = limit;
    if (!in.has("time_factor")) continue;
    RunSpec spec;
    spec.scenario = scenario;
    spec.parameters = scenario.parameters;
    scenario.time_limit = factor * time_limit(spec);
  }
}

}  // namespace

void override_scenarios(const JsonReader& in, std::vector<sim::Scenario>& scenarios) {
  const std::optional<sim::PhysicsKind> physics = physics_from_json(in);
  const std::string filter = in.text_or("filter", "");
  if (in.has("filter") && !algo::find_filter(filter)) {
    in.fail("filter",
            fmt::format("'{}' is unknown; known are pseudomedian, median, lulu, none", filter));
  }
  for (sim::Scenario& scenario : scenarios) {
    if (physics) scenario.physics = *physics;
    if (in.has("filter")) scenario.filter = filter;
  }
  override_noise(in, scenarios);
  override_limits(in, scenarios);
  override_time(in, scenarios);
}

}  // namespace server::sweep
