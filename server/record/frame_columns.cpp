// server/record/frame_columns.cpp: the table of the frame's columns.
#include "server/record/frame_columns.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "server/record/csv_cells.hpp"

namespace server {
namespace {

using algo::Encoders;
using algo::Explanation;
using algo::FloorRanges;
using algo::GroundTruth;
using algo::Inclinometer;
using algo::Joystick;
using algo::Observation;
using algo::Odometry;
using algo::Pose2;
using algo::Tilt;
using algo::Twist2;
using algo::YawGyro;
using T = algo::Telemetry;
using Out = std::string;

void put_count(Out& out, std::uint64_t count) {
  out += std::to_string(count);
}

/// As a request spells its type.
std::string_view type_of(const algo::Request& request) {
  static constexpr std::array<std::string_view, std::variant_size_v<algo::Request>> kTypes = {
      "set_goal",
      "clear_goal",
      "add_obstacle",
      "move_obstacle",
      "remove_obstacle",
      "joystick",
      "stop",
      "set_parameter",
      "add_goal",
      "set_goals",
      "change_obstacle",
      "set_joints",
      "set_hand_goal",
      "carry",
      "take_plan",
      "set_initial_pose"};
  static_assert(!kTypes.back().empty(), "every kind of request has its name");
  return kTypes[request.index()];
}

void put_requests(Out& out, const T& t) {
  for (const algo::Request& request : t.requests) {
    if (&request != t.requests.begin()) out += ' ';
    out += type_of(request);
  }
}

/// The newest stick that was applied in the tick; null if there was none.
const Joystick* newest_stick(const T& t) {
  const Joystick* newest = nullptr;
  for (const algo::Request& request : t.requests) {
    if (const auto* stick = std::get_if<Joystick>(&request)) newest = stick;
  }
  return newest;
}
template <double Joystick::*Value>
void put_stick(Out& out, const T& t) {
  if (const Joystick* stick = newest_stick(t)) put_number(out, stick->*Value);
}
void put_stick_mode(Out& out, const T& t) {
  if (const Joystick* stick = newest_stick(t)) put_text(out, name(stick->mode));
}
void put_stick_driver(Out& out, const T& t) {
  if (const Joystick* stick = newest_stick(t)) put_text(out, stick->driver.view());
}

template <int Axis>
void put_goal(Out& out, const T& t) {
  if (t.goal) put_float(out, t.goal->position_W[Axis]);
}
void put_goal_heading(Out& out, const T& t) {
  if (t.goal && t.goal->heading) put_float(out, *t.goal->heading);
}

// The simulator's truth, at the frame's precision.
template <double Pose2::*Part>
void put_pose(Out& out, const T& t) {
  if (t.ground_truth) put_float(out, t.ground_truth->pose.*Part);
}
template <double GroundTruth::*Value>
void put_truth(Out& out, const T& t) {
  if (t.ground_truth) put_float(out, (*t.ground_truth).*Value);
}
template <bool GroundTruth::*Flag>
void put_truth(Out& out, const T& t) {
  if (t.ground_truth) put_count(out, (*t.ground_truth).*Flag ? 1 : 0);
}
template <double Tilt::*Value>
void put_tilt(Out& out, const T& t) {
  if (t.ground_truth && t.ground_truth->tilt) put_float(out, (*t.ground_truth->tilt).*Value);
}

/// Appends a value of a sense that the robot may lack.
template <auto Sense, auto Value>
void put_sense(Out& out, const T& t) {
  if (t.observation.*Sense) put_number(out, (*(t.observation.*Sense)).*Value);
}
template <std::uint32_t Encoders::*Wheel>
void put_encoder(Out& out, const T& t) {
  if (t.observation.encoders) put_count(out, (*t.observation.encoders).*Wheel);
}
void put_line_stamp(Out& out, const T& t) {
  if (t.observation.line.fresh) put_number(out, t.observation.line.stamp);
}
void put_line_points(Out& out, const T& t) {
  if (t.observation.line.fresh) put_count(out, t.observation.line.pixels.size());
}
/// Appends a distance to the floor; "inf": nothing within range, as in the columns of sonars.
template <double FloorRanges::*Which>
void put_floor(Out& out, const T& t) {
  if (!t.observation.floor) return;
  const double range = (*t.observation.floor).*Which;
  put_number(out, std::isnan(range) ? std::numeric_limits<double>::infinity() : range);
}

template <double Odometry::*Value>
void put_odometry(Out& out, const T& t) {
  put_number(out, t.observation.odometry.*Value);
}
template <double Twist2::*Part>
void put_twist(Out& out, const T& t) {
  put_number(out, t.observation.odometry.twist.*Part);
}
/// Appends the newest words in the tick that made them.
template <auto Words>
void put_words(Out& out, const T& t) {
  if (t.words_fresh) put_text(out, t.words.*Words);
}

constexpr auto kColumns = std::to_array<FrameColumn>({
    {"odometry.stamp", "s", put_odometry<&Odometry::stamp>},
    {"odometry.v", "m/s", put_twist<&Twist2::v>},
    {"odometry.omega", "rad/s", put_twist<&Twist2::omega>},
    {"mission", "", [](Out& o, const T& t) { put_text(o, algo::name(t.mission)); }},
    {"halt", "", [](Out& o, const T& t) { put_text(o, algo::name(t.observation.halt)); }},
    {"limit", "", [](Out& o, const T& t) { put_text(o, t.limit.name.view()); }},
    {"waits", "", [](Out& o, const T& t) { put_count(o, t.output.waits ? 1 : 0); }},
    {"state", "", [](Out& o, const T& t) { put_count(o, t.output.state); }},
    {"goal.x", "m", put_goal<0>},
    {"goal.y", "m", put_goal<1>},
    {"goal.heading", "rad", put_goal_heading},
    {"goals_ahead", "", [](Out& o, const T& t) { put_count(o, t.goals_ahead.size()); }},
    {"truth.x", "m", put_pose<&Pose2::x>},
    {"truth.y", "m", put_pose<&Pose2::y>},
    {"truth.heading", "rad", put_pose<&Pose2::heading>},
    {"truth.obstacle_distance", "m", put_truth<&GroundTruth::obstacle_distance>},
    {"truth.clearance", "m", put_truth<&GroundTruth::clearance>},
    {"truth.collided", "", put_truth<&GroundTruth::collided>},
    {"truth.overturned", "", put_truth<&GroundTruth::overturned>},
    {"truth.fallen", "", put_truth<&GroundTruth::fallen>},
    {"truth.z", "m", put_tilt<&Tilt::z>},
    {"truth.roll", "rad", put_tilt<&Tilt::roll>},
    {"truth.pitch", "rad", put_tilt<&Tilt::pitch>},
    {"gyro.stamp", "s", put_sense<&Observation::gyro, &YawGyro::stamp>},
    {"gyro.rate", "rad/s", put_sense<&Observation::gyro, &YawGyro::rate>},
    {"inclinometer.stamp", "s", put_sense<&Observation::inclinometer, &Inclinometer::stamp>},
    {"inclinometer.roll", "rad", put_sense<&Observation::inclinometer, &Inclinometer::roll>},
    {"inclinometer.pitch", "rad", put_sense<&Observation::inclinometer, &Inclinometer::pitch>},
    {"line.stamp", "s", put_line_stamp},
    {"line.points", "", put_line_points},
    {"floor.stamp", "s", put_sense<&Observation::floor, &FloorRanges::stamp>},
    {"floor.far_left", "m", put_floor<&FloorRanges::far_left>},
    {"floor.far_right", "m", put_floor<&FloorRanges::far_right>},
    {"floor.near_left", "m", put_floor<&FloorRanges::near_left>},
    {"floor.near_right", "m", put_floor<&FloorRanges::near_right>},
    {"encoders.stamp", "s", put_sense<&Observation::encoders, &Encoders::stamp>},
    {"encoders.left", "", put_encoder<&Encoders::left>},
    {"encoders.right", "", put_encoder<&Encoders::right>},
    {"scans", "", [](Out& o, const T& t) { put_count(o, t.observation.scans.size()); }},
    {"requests", "", put_requests},
    {"stick.forward", "", put_stick<&Joystick::forward>},
    {"stick.turn", "", put_stick<&Joystick::turn>},
    {"stick.mode", "", put_stick_mode},
    {"stick.round_trip", "s", put_stick<&Joystick::round_trip>},
    {"stick.driver", "", put_stick_driver},
    {"what", "", put_words<&Explanation::what>},
    {"why", "", put_words<&Explanation::why>},
});

}  // namespace

std::span<const FrameColumn> frame_columns() {
  return kColumns;
}

}  // namespace server
