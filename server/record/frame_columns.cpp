// server/record/frame_columns.cpp: the table of the frame's columns.
#include "server/record/frame_columns.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "server/record/csv_cells.hpp"

namespace server {
namespace {

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

/// Calls `put` with the newest stick that was applied in the tick.
template <typename Put>
void put_stick(Out& out, const T& t, const Put& put) {
  const algo::Joystick* newest = nullptr;
  for (const algo::Request& request : t.requests) {
    if (const auto* stick = std::get_if<algo::Joystick>(&request)) newest = stick;
  }
  if (newest != nullptr) put(out, *newest);
}

/// Appends a number of the simulator's truth, at the frame's precision.
template <typename Get>
void put_truth(Out& out, const T& t, const Get& get) {
  if (t.ground_truth) put_float(out, get(*t.ground_truth));
}
template <typename Get>
void put_tilt(Out& out, const T& t, const Get& get) {
  if (t.ground_truth && t.ground_truth->tilt) put_float(out, get(*t.ground_truth->tilt));
}

/// Appends a distance to the floor; "inf": nothing within range, as in the columns of sonars.
void put_floor(Out& out, const T& t, double algo::FloorRanges::*which) {
  if (!t.observation.floor) return;
  const double range = (*t.observation.floor).*which;
  put_number(out, std::isnan(range) ? std::numeric_limits<double>::infinity() : range);
}

constexpr auto kColumns = std::to_array<FrameColumn>({
    {"odometry.stamp", "s", [](Out& o, const T& t) { put_number(o, t.observation.odometry.stamp); }},
    {"odometry.v",
     "m/s",
     [](Out& o, const T& t) { put_number(o, t.observation.odometry.twist.v); }},
    {"odometry.omega",
     "rad/s",
     [](Out& o, const T& t) { put_number(o, t.observation.odometry.twist.omega); }},
    {"mission", "", [](Out& o, const T& t) { put_text(o, algo::name(t.mission)); }},
    {"halt", "", [](Out& o, const T& t) { put_text(o, algo::name(t.observation.halt)); }},
    {"limit", "", [](Out& o, const T& t) { put_text(o, t.limit.name.view()); }},
    {"waits", "", [](Out& o, const T& t) { put_count(o, t.output.waits ? 1 : 0); }},
    {"state", "", [](Out& o, const T& t) { put_count(o, t.output.state); }},
    {"goal.x",
     "m",
     [](Out& o, const T& t) {
       if (t.goal) put_float(o, t.goal->position_W.x());
     }},
    {"goal.y",
     "m",
     [](Out& o, const T& t) {
       if (t.goal) put_float(o, t.goal->position_W.y());
     }},
    {"goal.heading",
     "rad",
     [](Out& o, const T& t) {
       if (t.goal && t.goal->heading) put_float(o, *t.goal->heading);
     }},
    {"goals_ahead", "", [](Out& o, const T& t) { put_count(o, t.goals_ahead.size()); }},
    {"truth.x",
     "m",
     [](Out& o, const T& t) { put_truth(o, t, [](const auto& g) { return g.pose.x; }); }},
    {"truth.y",
     "m",
     [](Out& o, const T& t) { put_truth(o, t, [](const auto& g) { return g.pose.y; }); }},
    {"truth.heading",
     "rad",
     [](Out& o, const T& t) { put_truth(o, t, [](const auto& g) { return g.pose.heading; }); }},
    {"truth.obstacle_distance",
     "m",
     [](Out& o, const T& t) { put_truth(o, t, [](const auto& g) { return g.obstacle_distance; }); }},
    {"truth.clearance",
     "m",
     [](Out& o, const T& t) { put_truth(o, t, [](const auto& g) { return g.clearance; }); }},
    {"truth.collided",
     "",
     [](Out& o, const T& t) {
       if (t.ground_truth) put_count(o, t.ground_truth->collided ? 1 : 0);
     }},
    {"truth.overturned",
     "",
     [](Out& o, const T& t) {
       if (t.ground_truth) put_count(o, t.ground_truth->overturned ? 1 : 0);
     }},
    {"truth.fallen",
     "",
     [](Out& o, const T& t) {
       if (t.ground_truth) put_count(o, t.ground_truth->fallen ? 1 : 0);
     }},
    {"truth.z", "m", [](Out& o, const T& t) { put_tilt(o, t, [](const auto& g) { return g.z; }); }},
    {"truth.roll",
     "rad",
     [](Out& o, const T& t) { put_tilt(o, t, [](const auto& g) { return g.roll; }); }},
    {"truth.pitch",
     "rad",
     [](Out& o, const T& t) { put_tilt(o, t, [](const auto& g) { return g.pitch; }); }},
    {"gyro.stamp",
     "s",
     [](Out& o, const T& t) {
       if (t.observation.gyro) put_number(o, t.observation.gyro->stamp);
     }},
    {"gyro.rate",
     "rad/s",
     [](Out& o, const T& t) {
       if (t.observation.gyro) put_number(o, t.observation.gyro->rate);
     }},
    {"inclinometer.stamp",
     "s",
     [](Out& o, const T& t) {
       if (t.observation.inclinometer) put_number(o, t.observation.inclinometer->stamp);
     }},
    {"inclinometer.roll",
     "rad",
     [](Out& o, const T& t) {
       if (t.observation.inclinometer) put_number(o, t.observation.inclinometer->roll);
     }},
    {"inclinometer.pitch",
     "rad",
     [](Out& o, const T& t) {
       if (t.observation.inclinometer) put_number(o, t.observation.inclinometer->pitch);
     }},
    {"line.stamp",
     "s",
     [](Out& o, const T& t) {
       if (t.observation.line.fresh) put_number(o, t.observation.line.stamp);
     }},
    {"line.points",
     "",
     [](Out& o, const T& t) {
       if (t.observation.line.fresh) put_count(o, t.observation.line.pixels.size());
     }},
    {"floor.stamp",
     "s",
     [](Out& o, const T& t) {
       if (t.observation.floor) put_number(o, t.observation.floor->stamp);
     }},
    {"floor.far_left",
     "m",
     [](Out& o, const T& t) { put_floor(o, t, &algo::FloorRanges::far_left); }},
    {"floor.far_right",
     "m",
     [](Out& o, const T& t) { put_floor(o, t, &algo::FloorRanges::far_right); }},
    {"floor.near_left",
     "m",
     [](Out& o, const T& t) { put_floor(o, t, &algo::FloorRanges::near_left); }},
    {"floor.near_right",
     "m",
     [](Out& o, const T& t) { put_floor(o, t, &algo::FloorRanges::near_right); }},
    {"encoders.stamp",
     "s",
     [](Out& o, const T& t) {
       if (t.observation.encoders) put_number(o, t.observation.encoders->stamp);
     }},
    {"encoders.left",
     "",
     [](Out& o, const T& t) {
       if (t.observation.encoders) put_count(o, t.observation.encoders->left);
     }},
    {"encoders.right",
     "",
     [](Out& o, const T& t) {
       if (t.observation.encoders) put_count(o, t.observation.encoders->right);
     }},
    {"scans", "", [](Out& o, const T& t) { put_count(o, t.observation.scans.size()); }},
    {"requests", "", put_requests},
    {"stick.forward",
     "",
     [](Out& o, const T& t) {
       put_stick(o, t, [](Out& out, const algo::Joystick& s) { put_number(out, s.forward); });
     }},
    {"stick.turn",
     "",
     [](Out& o, const T& t) {
       put_stick(o, t, [](Out& out, const algo::Joystick& s) { put_number(out, s.turn); });
     }},
    {"stick.mode",
     "",
     [](Out& o, const T& t) {
       put_stick(o, t, [](Out& out, const algo::Joystick& s) { put_text(out, name(s.mode)); });
     }},
    {"stick.round_trip",
     "s",
     [](Out& o, const T& t) {
       put_stick(o, t, [](Out& out, const algo::Joystick& s) { put_number(out, s.round_trip); });
     }},
    {"stick.driver",
     "",
     [](Out& o, const T& t) {
       put_stick(o, t, [](Out& out, const algo::Joystick& s) { put_text(out, s.driver.view()); });
     }},
    {"what",
     "",
     [](Out& o, const T& t) {
       if (t.words_fresh) put_text(o, t.words.what);
     }},
    {"why",
     "",
     [](Out& o, const T& t) {
       if (t.words_fresh) put_text(o, t.words.why);
     }},
});

}  // namespace

std::span<const FrameColumn> frame_columns() {
  return kColumns;
}

}  // namespace server
