// server/run/robot_json.cpp: one reader and one writer.
#include "server/run/robot_json.hpp"

#include <algorithm>
#include <string>

#include "algo/units.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/library_files.hpp"
#include "server/run/sensor_json.hpp"

namespace server {
namespace {

using nlohmann::json;

constexpr NumberRange kLength{0.01, 20};      // [m]
constexpr NumberRange kHeight{0, 5};          // [m] above the floor
constexpr NumberRange kMassHeight{0.001, 5};  // [m]
constexpr NumberRange kPlace{-10, 10};        // [m] in R
constexpr NumberRange kMass{0.01, 1e5};       // [kg]
constexpr NumberRange kChange{1e-3, 100};     // [m/s2] and [rad/s2]
constexpr NumberRange kJerk{0, 1e4};          // [m/s3] and [rad/s3]

/// [m] Casters on both sides of the drive wheels would carry the load if they were as low as these.
constexpr double kCasterRaised = 0.001;
constexpr Field<sim::Caster> kCaster[] = {
    required("x", &sim::Caster::x, kPlace),
    {"y", &sim::Caster::y, kPlace},
    required("radius", &sim::Caster::radius, {0.001, 1}),
    {"raised", &sim::Caster::raised, {0, 1}},
};

using Model = sim::Machine;
constexpr Field<Model> kLimits[] = {
    required("speed", &Model::max_v, {1e-3, 20}),
    required("turn", &Model::max_omega, {1e-3, 20}),
    {"acceleration", &Model::max_acceleration, kChange},
    {"turn_acceleration", &Model::max_angular_acceleration, kChange},
    {"jerk", &Model::max_jerk, kJerk},
    {"turn_jerk", &Model::max_angular_jerk, kJerk},
};

using algo::units::kRadiansPerDegree;
constexpr NumberRange kSlopeDegrees{0, 60};
using Climbs = algo::ClimbLimits;
constexpr Field<Climbs> kClimbs[] = {
    required("step_up", &Climbs::step_up, {0, 1}),
    required("step_down", &Climbs::step_down, {0, 1}),
    required("trench", &Climbs::trench, {0, 2}),
    {"slope_up_deg", &Climbs::slope_up, kSlopeDegrees, kRadiansPerDegree, true},
    {"slope_down_deg", &Climbs::slope_down, kSlopeDegrees, kRadiansPerDegree, true},
};

void read_hull(const JsonReader& in, sim::RobotModel& robot) {
  in.only({"radius", "length", "width", "low", "high"});
  if (in.has("radius")) {
    for (const char* key : {"length", "width"}) {
      if (in.has(key)) in.fail(key, "cannot stand beside radius: a hull is a disc or a rectangle");
    }
    robot.set_disc(in.number("radius", kLength));
  } else {
    if (!in.has("length")) in.fail("length", "is missing, or radius for a round hull");
    robot.set_box(in.number("length", kLength), in.number("width", kLength));
  }
  robot.hull_low = in.number_or("low", robot.hull_low, kHeight);
  robot.hull_high = in.number_or("high", robot.hull_high, kHeight);
}

/// The default casters, one ahead and one behind, if all wheels lie in one line.
std::vector<sim::Caster> usual_casters(const sim::RobotModel& robot) {
  constexpr double kRadius = 0.04;  // [m] at most
  constexpr double kOfHull = 0.2;   // of half the hull's length
  constexpr double kShare = 0.77;   // of the way from R to the hull
  const double x = kShare * robot.hull_length / 2;
  const double radius = std::min(kRadius, kOfHull * robot.hull_length / 2);
  return {{x, 0, radius, kCasterRaised}, {-x, 0, radius, kCasterRaised}};
}

void read_wheels(const JsonReader& in, sim::RobotModel& robot) {
  robot.half_track = in.number("track", kLength) / 2;
  robot.wheel_radius = in.number("wheel_radius", {0.005, 5});
  if (in.has("wheels")) {
    robot.wheels.clear();
    in.each("wheels", sim::kMostWheels, [&](const json& value, const std::string& at) {
      robot.wheels.push_back(finite_number(value, at, kPlace));
    });
  }
  robot.casters.clear();
  if (in.has("casters")) {
    in.each("casters", sim::kMostCasters, [&](const json& value, const std::string& at) {
      read_only_fields(
          {value, at}, kCaster, robot.casters.emplace_back(sim::Caster{.raised = kCasterRaised}));
    });
  } else if (robot.wheels.size() == 1) {
    robot.casters = usual_casters(robot);
  }
  robot.friction = in.number_or("friction", robot.friction, {0.01, 5});
  robot.counts_per_turn = in.number_or("counts_per_turn", robot.counts_per_turn, {1, 1e7});
}

/// `problem` begins with the name of the wrong field.
[[noreturn]] void refuse(const JsonReader& in, const std::string& problem) {
  const std::size_t colon = problem.find(": ");
  in.fail(problem.substr(0, colon), problem.substr(colon + 2));
}

}  // namespace

sim::RobotModel robot_from_json(const JsonReader& in) {
  in.only({"name",        "title",        "description",   "hull",         "mass",
           "mass_height", "track",        "wheels",        "wheel_radius", "casters",
           "limits",      "friction",     "lasers",        "sonar",        "infrared",
           "sensors",     "gyro",         "bumpers",       "encoders",     "counts_per_turn",
           "line_camera", "inclinometer", "floor_sensors", "climbs",       "arm"});
  sim::RobotModel robot;
  robot.name = in.text("name", 64);
  if (!valid_name(robot.name)) {
    in.fail("name", "must be 1 to 64 of the characters a-z, 0-9, _ and -");
  }
  in.text_or("title", "");
  in.text_or("description", "");
  if (!in.has("hull")) in.fail("hull", "is missing");
  if (!in.has("limits")) in.fail("limits", "is missing");
  read_hull(in.object("hull"), robot);
  robot.mass = in.number("mass", kMass);
  const double middle = (robot.hull_low + robot.hull_high) / 2;
  robot.mass_height = in.number_or(
      "mass_height", std::clamp(middle, kMassHeight.min, kMassHeight.max), kMassHeight);
  read_wheels(in, robot);
  read_only_fields(in.object("limits"), kLimits, robot);
  robot.climbs.reset();
  if (in.has("climbs")) {
    read_only_fields(in.object("climbs"), kClimbs, robot.climbs.emplace());
  }
  robot.arm = arm_from_json(in);
  read_sensors(in, robot.sensors);
  if (const auto problem = sim::defect(robot)) refuse(in, *problem);
  return robot;
}

json to_json(const sim::RobotModel& robot) {
  json hull = {{"low", robot.hull_low}, {"high", robot.hull_high}};
  if (robot.round) {
    hull["radius"] = robot.radius;
  } else {
    hull["length"] = robot.hull_length;
    hull["width"] = robot.hull_width;
  }
  json casters = json::array();
  for (const sim::Caster& caster : robot.casters) casters.push_back(written(kCaster, caster));
  json out = {{"name", robot.name},
              {"hull", std::move(hull)},
              {"mass", robot.mass},
              {"mass_height", robot.mass_height},
              {"track", 2 * robot.half_track},
              {"wheel_radius", robot.wheel_radius},
              {"wheels", robot.wheels},
              {"casters", std::move(casters)},
              {"limits", written(kLimits, robot)},
              {"friction", robot.friction},
              {"counts_per_turn", robot.counts_per_turn}};
  if (robot.climbs) out["climbs"] = written(kClimbs, *robot.climbs);
  if (robot.arm) out["arm"] = to_json(*robot.arm);
  return out;
}

json robot_document(const sim::RobotModel& robot) {
  json document = to_json(robot);
  write_sensors(robot.sensors, document);
  return document;
}

}  // namespace server
