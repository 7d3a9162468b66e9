// tests/bench/frame_rows.cpp: a frame's encoding against a JSON document of the same content.
#include <cmath>
#include <cstring>

#include "telemetry_generated.h"
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
json layer_json(const algo::Layer& layer) {
  return {{"name", layer.name},
          {"label", layer.label},
          {"kind", static_cast<int>(layer.kind)},
          {"tone", static_cast<int>(layer.tone)},
          {"style", static_cast<int>(layer.style)},
          {"values", layer.values}};
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

/// The content of a driving tick's frame as a document.
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
  frame["hold"] = algo::name(t.hold);
  frame["mission"] = static_cast<int>(t.mission);
  frame["behaviour"] = t.behaviour.view();
  frame["clearance"] = t.clearance;
  frame["layers"] = json::array();
  for (const auto* list : {&t.layers, &out.layers}) {
    for (const algo::Layer& layer : *list) {
      if (!layer.empty()) frame["layers"].push_back(layer_json(layer));
    }
  }
  frame["measures"] = json::object();
  for (const algo::Measure& each : out.measures) {
    frame["measures"][std::string(each.name)] = {{"unit", each.unit}, {"value", each.value}};
  }
  if (t.words_fresh) {
    frame["what"] = t.words.what;
    frame["why"] = t.words.why;
  }
  return frame;
}

/// Checks that both encodings decode to the same tick.
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
  const auto& frame = *tautline::wire::GetFrame(encoder.encode(t).data());
  const auto& shown = *frame.shown();
  flatbuffers::uoffset_t i = 0;
  std::size_t layers = t.layers.size() + t.output.layers.size() - document.at("layers").size();
  for (const json& layer : document.at("layers")) {
    for (; shown[i] == 0; ++i) --layers;  // of a layer that shows nothing
    same(layer.at("values").size() == static_cast<std::size_t>(shown[i++]),
         "the length of a layer");
    for (const double value : layer.at("values")) {
      same(std::abs(value - shown[i++] / 1024.0) < 1e-3, "a value of a layer");
    }
  }
  for (; layers > 0; --layers) same(shown[i++] == 0, "the number of layers");
  same(document.at("measures").size() == shown.size() - i, "the number of measures");
}

/// Driving ticks, their strip drawn out to `nodes` along the same line (0: as it is).
std::vector<algo::Telemetry> driving_ticks(std::size_t count, std::size_t nodes) {
  Driving driving(room_scenario(20, sim::PhysicsKind::Bullet, {full_laser()}));
  std::vector<algo::Telemetry> ticks;
  while (ticks.size() < count) {
    driving.tick();
    if (driving.t.observation.scans.size() != 1 || !driving.t.requests.empty()) continue;
    algo::Telemetry t = driving.t;
    t.ground_truth = driving.world().ground_truth();
    if (nodes > 0) stretch_strip(t, nodes, 0);
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
