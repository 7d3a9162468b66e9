// drivers/robot_file_ground.cpp: the tables of a robot's file that concern the ground.
#include "drivers/robot_file_ground.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "algo/terrain/psd_curve.hpp"
#include "algo/units.hpp"
#include "drivers/published_senses.hpp"

namespace drivers {
namespace {

using algo::units::kRadiansPerDegree;

/// Refuses sensors that would measure nothing on a flat floor.
void check_flat_floor(const Section& in, const algo::FloorSensors& sensors) {
  const double near = sensors.height / std::sin(sensors.angle);
  const double far = near + sensors.separation / std::tan(sensors.angle);
  if (near >= algo::kPsdNearest && far <= algo::kPsdFarthest) return;
  in.fail("height",
          fmt::format("and angle_deg put a flat floor {:.2f} and {:.2f} m ahead of the sensors; "
                      "they measure from {:.2f} to {:.2f} m",
                      near,
                      far,
                      algo::kPsdNearest,
                      algo::kPsdFarthest));
}

psd::Table read_table(Section& in, const char* key) {
  if (!in.has(key)) return {};
  std::vector<psd::TablePoint> points;
  for (const auto& [volts, metres] : in.pairs(key)) points.push_back({volts, metres});
  if (const auto wrong = psd::defect(points)) in.fail(key, *wrong);
  return psd::Table(std::move(points));
}

void read_floor(Section in, RobotFile& robot) {
  FloorEntry& entry = robot.floor.emplace();
  entry.port = in.port();
  entry.setup.baud =
      static_cast<unsigned>(in.one_of<4>("rate", entry.setup.baud, {19200, 38400, 57600, 115'200}));
  entry.setup.full_scale = in.number_or("full_scale", entry.setup.full_scale, {0.5, 10});
  constexpr std::array<const char*, psd::kSensors> kKeys{
      "far_left", "far_right", "near_left", "near_right"};
  for (std::size_t i = 0; i < psd::kSensors; ++i) {
    entry.setup.tables[i] = read_table(in, kKeys[i]);
  }
  algo::FloorSensors& sensors = robot.spec.floor.emplace();
  sensors.x = in.number("x", {-5, 5});
  sensors.height = in.number("height", {0.01, 1});
  sensors.half_spacing = in.number("half_spacing", {0.01, 2});
  sensors.angle = in.number_or("angle_deg", 45, {10, 85}) * kRadiansPerDegree;
  sensors.separation = in.number_or("separation", 0.08, {0.01, 0.5});
  check_flat_floor(in, sensors);
  in.done();
}

void read_climbs(Section in, algo::RobotSpec& spec) {
  algo::ClimbLimits& climbs = spec.climbs.emplace();
  climbs.step_up = in.number("step_up", {0, 1});
  climbs.step_down = in.number("step_down", {0, 1});
  climbs.trench = in.number("trench", {0, 2});
  climbs.slope_up = in.number("slope_up_deg", {0, 60}) * kRadiansPerDegree;
  climbs.slope_down = in.number("slope_down_deg", {0, 60}) * kRadiansPerDegree;
  in.done();
}

/// What the robot stands on, for the guard against turning over.
void read_stance(Section in, RobotFile& robot) {
  algo::Stance& stance = robot.spec.stance.emplace();
  stance.mass_height = in.number("mass_height", {0.01, 3});
  stance.width = in.number_or("width", 2 * robot.spec.half_track, {0.05, 3});
  stance.length = in.number("length", {0.05, 3});
  in.done();
  if (!robot.published.inclinometer) {
    in.fail("mass_height", "needs the robot's inclination: inclinometer = \"published\"");
  }
}

void read_line_camera(Section in, algo::RobotSpec& spec) {
  algo::LineCamera& camera = spec.line.emplace();
  camera.x = in.number("x", {-5, 5});
  camera.height = in.number("height", {0.01, 3});
  camera.pitch = in.number("pitch_deg", {-90, 90}) * kRadiansPerDegree;
  camera.baseline = in.number("baseline", {0.01, 2});
  camera.angle = in.number("angle_deg", {1, 89}) * kRadiansPerDegree;
  camera.focal = in.number("focal", {10, 100'000});
  camera.columns = in.whole_or("columns", 640, {2, PublishedSenses::kMostPixels});
  camera.rows = in.whole_or("rows", 480, {2, PublishedSenses::kMostPixels});
  in.done();
}

/// True if `key` is there. No driver of ours reads such a sensor.
bool is_published(Section& top, const char* key) {
  if (!top.has(key)) return false;
  const std::string source = top.text(key);
  if (source != "published") top.fail(key, "is '" + source + "'; it can be published");
  return true;
}

}  // namespace

void read_ground(Section& top, RobotFile& robot) {
  robot.published = {is_published(top, "inclinometer"), is_published(top, "laser_line")};
  robot.spec.inclinometer = robot.published.inclinometer;
  if (robot.published.line) read_line_camera(top.table("line_camera"), robot.spec);
  if (!robot.published.line && top.has("line_camera")) {
    top.fail("line_camera", "needs laser_line = \"published\": no driver reads a camera");
  }
  if (top.has("psd")) read_floor(top.table("psd"), robot);
  if (top.has("climbs")) read_climbs(top.table("climbs"), robot.spec);
  if (top.has("stance")) read_stance(top.table("stance"), robot);
}

}  // namespace drivers
