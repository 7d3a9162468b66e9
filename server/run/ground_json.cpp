// server/run/ground_json.cpp: tables of the ground's parameters.
#include "server/run/ground_json.hpp"

#include <optional>

#include "server/run/json_fields.hpp"

namespace server {
namespace {

using nlohmann::json;

constexpr Field<algo::Stance> kSpecStance[] = {
    required("mass_height", &algo::Stance::mass_height),
    required("width", &algo::Stance::width),
    required("length", &algo::Stance::length),
};
constexpr Field<algo::LineCamera> kSpecCamera[] = {
    required("x", &algo::LineCamera::x),
    required("height", &algo::LineCamera::height),
    required("pitch", &algo::LineCamera::pitch),
    required("baseline", &algo::LineCamera::baseline),
    required("angle", &algo::LineCamera::angle),
    required("focal", &algo::LineCamera::focal),
    {"columns"},
    {"rows"},
};
constexpr Field<algo::FloorSensors> kSpecFloor[] = {
    required("x", &algo::FloorSensors::x),
    required("height", &algo::FloorSensors::height),
    required("half_spacing", &algo::FloorSensors::half_spacing),
    required("angle", &algo::FloorSensors::angle),
    required("separation", &algo::FloorSensors::separation),
};
constexpr Field<algo::ClimbLimits> kSpecClimbs[] = {
    required("step_up", &algo::ClimbLimits::step_up),
    required("step_down", &algo::ClimbLimits::step_down),
    required("trench", &algo::ClimbLimits::trench),
    required("slope_up", &algo::ClimbLimits::slope_up),
    required("slope_down", &algo::ClimbLimits::slope_down),
};

template <typename T, std::size_t N>
void put_part(const Field<T> (&table)[N],
              const std::optional<T>& part,
              const char* key,
              json& out) {
  if (part) out[key] = written(table, *part);
}

template <typename T, std::size_t N>
void read_part(const JsonReader& in,
               const char* key,
               const Field<T> (&table)[N],
               std::optional<T>& part) {
  if (in.has(key)) read_fields(in.object(key), table, part.emplace());
}

}  // namespace

void write_ground(const algo::RobotSpec& robot, json& out) {
  if (robot.axle != 0) out["axle"] = robot.axle;
  if (robot.inclinometer) out["inclinometer"] = true;
  put_part(kSpecStance, robot.stance, "stance", out);
  put_part(kSpecCamera, robot.line, "line_camera", out);
  if (robot.line) {
    out["line_camera"]["columns"] = robot.line->columns;
    out["line_camera"]["rows"] = robot.line->rows;
  }
  put_part(kSpecFloor, robot.floor, "floor_sensors", out);
  put_part(kSpecClimbs, robot.climbs, "climbs", out);
}

void read_ground(const JsonReader& in, algo::RobotSpec& robot) {
  constexpr std::uint64_t kMostPixels = 65536;
  robot.axle = in.number_or("axle", 0);
  robot.inclinometer = in.flag_or("inclinometer", false);
  read_part(in, "stance", kSpecStance, robot.stance);
  read_part(in, "line_camera", kSpecCamera, robot.line);
  if (robot.line) {
    const JsonReader camera = in.object("line_camera");
    robot.line->columns = static_cast<int>(camera.whole_or("columns", 0, kMostPixels));
    robot.line->rows = static_cast<int>(camera.whole_or("rows", 0, kMostPixels));
  }
  read_part(in, "floor_sensors", kSpecFloor, robot.floor);
  read_part(in, "climbs", kSpecClimbs, robot.climbs);
}

}  // namespace server
