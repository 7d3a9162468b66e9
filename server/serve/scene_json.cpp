// server/serve/scene_json.cpp: foxglove.* messages by their published schemas: every property
// there.
#include "server/serve/scene_json.hpp"

#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace server {
namespace {

using nlohmann::json;

struct Colour {
  double r = 0, g = 0, b = 0, a = 1;
};
// The page's own palette (design tokens of the light theme).
constexpr Colour kStrip{0.66, 0.44, 0.0, 1};
constexpr Colour kInternal{0.0, 0.50, 0.42, 1};
constexpr Colour kExternal{0.76, 0.32, 0.05, 1};
constexpr Colour kElastic{0.48, 0.25, 0.71, 1};
constexpr Colour kObstacle{0.55, 0.60, 0.66, 1};

json to_json(const Colour& c) {
  return {{"r", c.r}, {"g", c.g}, {"b", c.b}, {"a", c.a}};
}

json time_json(double stamp) {
  const double whole = std::floor(std::max(0.0, stamp));
  const auto nsec = static_cast<std::int64_t>((std::max(0.0, stamp) - whole) * 1e9);
  return {{"sec", static_cast<std::int64_t>(whole)}, {"nsec", nsec}};
}

json point_json(const algo::Vec2& p, double z = 0) {
  return {{"x", p.x()}, {"y", p.y()}, {"z", z}};
}

json rotation_json(double heading) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(heading / 2)}, {"w", std::cos(heading / 2)}};
}

json pose_json(const algo::Pose2& pose, double z = 0) {
  return {{"position", point_json(pose.position(), z)},
          {"orientation", rotation_json(pose.heading)}};
}

json transform_json(double stamp, const char* parent, const char* child, const algo::Pose2& pose) {
  return {{"timestamp", time_json(stamp)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", point_json(pose.position())},
          {"rotation", rotation_json(pose.heading)}};
}

json entity_json(double stamp, const std::string& id) {
  json entity = {{"timestamp", time_json(stamp)},
                 {"frame_id", "map"},
                 {"id", id},
                 {"lifetime", {{"sec", 0}, {"nsec", 0}}},
                 {"frame_locked", false}};
  for (const char* list : {"metadata",
                           "arrows",
                           "cubes",
                           "spheres",
                           "cylinders",
                           "lines",
                           "triangles",
                           "texts",
                           "models"}) {
    entity[list] = json::array();
  }
  return entity;
}

json scene_json(json entities, json deletions = json::array()) {
  return {{"deletions", std::move(deletions)}, {"entities", std::move(entities)}};
}

json line_json(const std::vector<algo::Vec2>& points, const Colour& colour) {
  json line = {{"type", 0},
               {"pose", pose_json({})},
               {"thickness", 0.03},
               {"scale_invariant", false},
               {"points", json::array()},
               {"color", to_json(colour)},
               {"colors", json::array()},
               {"indices", json::array()}};
  for (const algo::Vec2& p : points) line["points"].push_back(point_json(p, 0.05));
  return line;
}

json arrow_json(const algo::Vec2& from, const algo::Vec2& vector, const Colour& colour) {
  const double length = vector.norm();
  return {{"pose", pose_json({from.x(), from.y(), std::atan2(vector.y(), vector.x())}, 0.1)},
          {"shaft_length", length * 0.8},
          {"shaft_diameter", 0.03},
          {"head_length", length * 0.2},
          {"head_diameter", 0.07},
          {"color", to_json(colour)}};
}

/// A prism over a convex outline: fan for the top, two triangles for each side.
json prism_json(const std::vector<algo::Vec2>& outline, double height) {
  json points = json::array();
  const auto add = [&](const algo::Vec2& p, double z) { points.push_back(point_json(p, z)); };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const algo::Vec2& a = outline[i];
    const algo::Vec2& b = outline[(i + 1) % outline.size()];
    add(outline[0], height), add(a, height), add(b, height);
    add(a, 0), add(b, 0), add(b, height);
    add(a, 0), add(b, height), add(a, height);
  }
  return {{"pose", pose_json({})},
          {"points", std::move(points)},
          {"color", to_json(kObstacle)},
          {"colors", json::array()},
          {"indices", json::array()}};
}

json obstacle_entity(double stamp, const algo::Obstacle& o) {
  json entity = entity_json(stamp, fmt::format("obstacle-{}", o.id));
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&o.shape)) {
    entity["cylinders"].push_back(
        {{"pose", pose_json(o.pose_W, o.height / 2)},
         {"size", {{"x", 2 * cylinder->radius}, {"y", 2 * cylinder->radius}, {"z", o.height}}},
         {"bottom_scale", 1.0},
         {"top_scale", 1.0},
         {"color", to_json(kObstacle)}});
  } else {
    entity["triangles"].push_back(prism_json(algo::outline_W(o), o.height));
  }
  return entity;
}

}  // namespace

std::string laser_scan_json(const algo::Telemetry& t) {
  const algo::LaserScan& scan = t.scene.scan;
  json ranges = json::array();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool ok = scan.status[i] == algo::Beam::Ok;
    ranges.push_back(ok ? std::round(scan.ranges[i] * 1e4) / 1e4 : kNoReading);
  }
  const double end = scan.size() == 0 ? scan.angle_min : scan.angle(scan.size() - 1);
  return json{{"timestamp", time_json(scan.stamp)},
              {"frame_id", "laser"},
              {"pose", pose_json({})},
              {"start_angle", scan.angle_min},
              {"end_angle", end},
              {"ranges", std::move(ranges)},
              {"intensities", json::array()}}
      .dump();
}

std::string transforms_json(const algo::Telemetry& t) {
  const double stamp = t.observation.stamp;
  json transforms = json::array();
  transforms.push_back(transform_json(stamp, "map", "base_link", t.observation.odometry.pose));
  transforms.push_back(transform_json(stamp, "base_link", "laser", t.scene.scan.mount_R));
  return json{{"transforms", std::move(transforms)}}.dump();
}

std::string odometry_json(const algo::Telemetry& t) {
  const algo::Odometry& o = t.observation.odometry;
  return json{{"timestamp", time_json(o.stamp)},
              {"frame_id", "map"},
              {"body_frame_id", "base_link"},
              {"pose", pose_json(o.pose)},
              {"linear_velocity", point_json({o.twist.v, 0})},
              {"angular_velocity", point_json({0, 0}, o.twist.omega)}}
      .dump();
}

std::string strip_json(const algo::Telemetry& t) {
  std::vector<algo::Vec2> points;
  for (const algo::Node& node : t.output.strip) points.push_back(node.position_W);
  json entity = entity_json(t.observation.stamp, "strip");
  if (!points.empty()) entity["lines"].push_back(line_json(points, kStrip));
  return scene_json(json::array({std::move(entity)})).dump();
}

std::string forces_json(const algo::Telemetry& t) {
  json entity = entity_json(t.observation.stamp, "forces");
  if (!t.output.strip.empty()) {
    const algo::Vec2 at = t.observation.odometry.pose.position();
    const auto add = [&](const algo::Vec2& force, const Colour& colour) {
      if (force.norm() > 1e-3) entity["arrows"].push_back(arrow_json(at, force, colour));
    };
    add(t.output.internal_W, kInternal);
    add(t.output.external_left_W, kExternal);
    add(t.output.external_right_W, kExternal);
    add(t.output.elastic_W, kElastic);
  }
  return scene_json(json::array({std::move(entity)})).dump();
}

std::string obstacles_json(double stamp, std::span<const algo::Obstacle> obstacles) {
  json entities = json::array();
  for (const algo::Obstacle& o : obstacles) entities.push_back(obstacle_entity(stamp, o));
  // Type 1 deletes all; the entities of the same update come after it.
  json deletions = json::array({{{"timestamp", time_json(stamp)}, {"type", 1}, {"id", ""}}});
  return scene_json(std::move(entities), std::move(deletions)).dump();
}

std::string goal_json(const algo::Telemetry& t) {
  algo::Pose2 pose = t.observation.odometry.pose;
  if (t.goal) {
    const algo::Vec2& p = t.goal->position_W;
    pose = {p.x(), p.y(), t.goal->heading.value_or(0)};
  }
  return json{
      {"timestamp", time_json(t.observation.stamp)}, {"frame_id", "map"}, {"pose", pose_json(pose)}}
      .dump();
}

std::string time_text(double stamp) {
  return time_json(stamp).dump();
}

std::string log_json(double stamp, LogLevel level, const std::string& message) {
  return json{{"timestamp", time_json(stamp)},
              {"level", static_cast<int>(level)},
              {"message", message},
              {"name", "tautline"},
              {"file", ""},
              {"line", 0}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace server
