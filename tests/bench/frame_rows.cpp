// tests/bench/frame_rows.cpp: a frame's encoding against a JSON document of the same content.
#include <cmath>
#include <cstring>

#include "tests/bench/driving.hpp"
#include "tests/bench/rows.hpp"
#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "server/record/frame_codec.hpp"

namespace bench {
namespace {

using nlohmann::json;

json point(const algo::Vec2& v) {
  return {{"x", v.x()}, {"y", v.y()}};
}
json pose(const algo::Pose2& p) {
  return {{"x", p.x}, {"y", p.y}, {"heading", p.heading}};
}
json twist(const algo::Twist2& t) {
  return {{"v", t.v}, {"omega", t.omega}};
}
json nearest(const algo::Nearest& n) {
  return {{"point", point(n.point_W)}, {"distance", n.distance}, {"beam", n.beam}};
}

json scan_json(const algo::LaserScan& scan) {
  json ranges = json::array();
  for (std::size_t i = 0; i < scan.size(); ++i) ranges.push_back(algo::pack_beam(scan, i));
  return {{"mount", pose(scan.mount_R)},
          {"stamp", scan.stamp},
          {"angle_min", scan.angle_min},
          {"angle_increment", scan.angle_increment},
          {"range_max", scan.range_max},
          {"turn_period", scan.turn_period},
          {"turns", scan.turns},
          {"ranges", std::move(ranges)}};
}

json sensors_json(const algo::Observation& o) {
  json out = json::object();
  out["scans"] = json::array();
  for (const algo::LaserScan& scan : o.scans) out["scans"].push_back(scan_json(scan));
  out["bumpers"] = json::array();
  for (const algo::BumperReading& b : o.bumpers) {
    out["bumpers"].push_back(
        {{"mount", pose(b.mount_R)}, {"stamp", b.stamp}, {"pressed", b.pressed}});
  }
  if (o.gyro) out["gyro"] = {{"stamp", o.gyro->stamp}, {"rate", o.gyro->rate}};
  if (o.encoders) {
    out["encoders"] = {
        {"stamp", o.encoders->stamp}, {"left", o.encoders->left}, {"right", o.encoders->right}};
  }
  return out;
}

/// What a driving tick's frame holds, as a document.
json frame_json(const algo::Telemetry& t) {
  const algo::ControlOutput& out = t.output;
  json frame = sensors_json(t.observation);
  frame["tick"] = t.tick;
  frame["stamp"] = t.observation.stamp;
  frame["odometry"] = {{"stamp", t.observation.odometry.stamp},
                       {"pose", pose(t.observation.odometry.pose)},
                       {"twist", twist(t.observation.odometry.twist)}};
  frame["command"] = twist(t.command.base);
  if (t.ground_truth) {
    frame["truth"] = {{"pose", pose(t.ground_truth->pose)},
                      {"obstacle_distance", t.ground_truth->obstacle_distance},
                      {"collided", t.ground_truth->collided}};
  }
  if (t.goal) frame["goal"] = point(t.goal->position_W);
  frame["hold"] = static_cast<int>(t.hold);
  frame["mission"] = static_cast<int>(t.mission);
  frame["behaviour"] = static_cast<int>(t.behaviour);
  frame["clearance"] = t.clearance;
  frame["strip"] = json::array();
  for (const algo::Node& node : out.strip) frame["strip"].push_back(point(node.position_W));
  frame["internal"] = point(out.internal_W);
  if (t.scene.left) frame["left"] = nearest(*t.scene.left);
  if (t.scene.right) frame["right"] = nearest(*t.scene.right);
  frame["external_left"] = point(out.external_left_W);
  frame["external_right"] = point(out.external_right_W);
  frame["side"] = static_cast<int>(out.side);
  frame["side_since"] = out.side_since;
  return frame;
}

/// What comes out of both encodings is the same tick.
void check_frame(const algo::Telemetry& t, server::FrameEncoder& encoder) {
  algo::Telemetry back;
  server::decode_frame(encoder.encode(t), back);
  const json document = json::parse(frame_json(t).dump());
  const auto same = [&](bool holds, const char* what) {
    require(holds, fmt::format("P18: frame and document differ in {}", what));
  };
  same(document.at("tick") == back.tick, "tick");
  const json& odometry = document.at("odometry").at("pose");
  same(odometry == pose(back.observation.odometry.pose), "odometry");
  same(document.at("command") == twist(back.command.base), "command");
  same(document.at("scans").size() == back.observation.scans.size(), "the number of scans");
  for (std::size_t k = 0; k < back.observation.scans.size(); ++k) {
    same(document.at("scans")[k] == scan_json(back.observation.scans[k]), "a scan");
  }
  same(document.at("strip").size() == back.output.strip.size(), "the strip");
  for (std::size_t k = 0; k < back.output.strip.size(); ++k) {
    const double x = document.at("strip")[k].at("x");
    same(std::abs(x - back.output.strip[k].position_W.x()) < 1e-5, "a strip node");
  }
}

/// Driving ticks, their strip drawn out to `nodes` along the same line (0: as it is).
std::vector<algo::Telemetry> driving_ticks(std::size_t count, std::size_t nodes) {
  Driving driving(room_scenario(20, sim::Vehicle::Bullet, {full_laser()}));
  std::vector<algo::Telemetry> ticks;
  while (ticks.size() < count) {
    driving.tick();
    if (driving.t.observation.scans.size() != 1 || !driving.t.requests.empty()) continue;
    algo::Telemetry t = driving.t;
    t.ground_truth = driving.world().ground_truth();
    const auto strip = t.output.strip;
    if (nodes > 0 && strip.size() > 0) t.output.strip.clear();
    for (std::size_t i = 0; i < nodes && strip.size() > 0; ++i) {
      t.output.strip.push_back(strip[i * strip.size() / nodes]);
    }
    ticks.push_back(std::move(t));
  }
  return ticks;
}

void time_frame(Pass& pass, std::size_t nodes, Figure ratio, Figure size) {
  const auto ticks = driving_ticks(pass.count<std::size_t>(256, 16), nodes);
  server::FrameEncoder encoder;
  double bytes = 0;
  for (const algo::Telemetry& t : ticks) {
    check_frame(t, encoder);
    bytes += static_cast<double>(encoder.encode(t).size()) / static_cast<double>(ticks.size());
  }
  std::size_t i = 0;
  const auto next = [&]() -> const algo::Telemetry& { return ticks[i = (i + 1) % ticks.size()]; };
  const auto times =
      pass.time(ratio.name,
                {{"ours", [&] { benchmark::DoNotOptimize(encoder.encode(next())); }},
                 {"json", [&] { benchmark::DoNotOptimize(frame_json(next()).dump()); }}});
  pass.add_ratio(std::move(ratio), times[0], times[1]);
  size.value = bytes;
  size.note = fmt::format("{} of them ranges", 2 * kBeams);
  size.unit = "bytes";
  size.better = Better::Lower;
  pass.add(std::move(size));
}

}  // namespace

void frames(Pass& pass) {
  time_frame(pass,
             0,
             {.row = "P18", .name = "encode a frame", .floor = 40, .stretch = 80},
             {.row = "P18", .name = "frame size", .floor = 1100});
  time_frame(pass,
             50,
             {.row = "P18", .name = "encode a frame, strip of 50"},
             {.row = "P18", .name = "frame size, strip of 50"});
}

}  // namespace bench
