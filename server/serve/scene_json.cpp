// server/serve/scene_json.cpp: foxglove.* messages with every property of the published schemas.
#include "server/serve/scene_json.hpp"

#include <cmath>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/serve/scene_shapes.hpp"

namespace server {
namespace {

using nlohmann::json;
using namespace scene;
constexpr Colour kObstacle{0.55, 0.60, 0.66, 1};
constexpr Colour kGround{0.60, 0.56, 0.46, 1};

json transform_json(double stamp, const char* parent, const char* child, const algo::Pose2& pose) {
  return {{"timestamp", time_json(stamp)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", point_json(pose.position())},
          {"rotation", rotation_json(pose.heading)}};
}

/// A solid between the floor and the obstacle's top, or its bottom if it is a trench, over a convex
/// outline: a fan for the top, two triangles for each side.
json prism_json(const algo::Obstacle& o) {
  const std::vector<algo::Vec2> outline = algo::outline_W(o);
  std::vector<Point> points;
  const auto at_top = [&](const algo::Vec2& p) {
    points.push_back({p.x(), p.y(), algo::top_at(o, p)});
  };
  const auto on_floor = [&](const algo::Vec2& p) { points.push_back({p.x(), p.y(), 0}); };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const algo::Vec2& a = outline[i];
    const algo::Vec2& b = outline[(i + 1) % outline.size()];
    at_top(outline[0]), at_top(a), at_top(b);
    on_floor(a), on_floor(b), at_top(b);
    on_floor(a), at_top(b), at_top(a);
  }
  return triangles_json(points, algo::is_ground(o) ? kGround : kObstacle);
}

json obstacle_entity(double stamp, const algo::Obstacle& o) {
  json entity = entity_json(stamp, fmt::format("obstacle-{}", o.id), "map");
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&o.shape)) {
    entity["cylinders"].push_back(
        {{"pose", pose_json(o.pose_W, (o.bottom + o.height) / 2)},
         {"size",
          {{"x", 2 * cylinder->radius}, {"y", 2 * cylinder->radius}, {"z", o.height - o.bottom}}},
         {"bottom_scale", 1.0},
         {"top_scale", 1.0},
         {"color", to_json(kObstacle)}});
  } else {
    entity["triangles"].push_back(prism_json(o));
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

std::string obstacles_json(double stamp, std::span<const algo::Obstacle> obstacles) {
  json entities = json::array();
  for (const algo::Obstacle& o : obstacles) {
    // Sent once, it would stand where it is seldom.
    if (o.path && o.path->comes_and_goes) continue;
    entities.push_back(obstacle_entity(stamp, o));
  }
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
