// server/serve/scene_shapes.cpp: primitives by their published schemas.
#include "server/serve/scene_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace server::scene {
namespace {

using nlohmann::json;

json xyz(const Point& p) {
  return {{"x", p.x}, {"y", p.y}, {"z", p.z}};
}
json pose_at(const Point& p, double heading = 0) {
  return {{"position", xyz(p)}, {"orientation", rotation_json(heading)}};
}
json points_json(std::span<const Point> points) {
  json out = json::array();
  for (const Point& p : points) out.push_back(xyz(p));
  return out;
}

}  // namespace

json to_json(const Colour& c) {
  return {{"r", c.r}, {"g", c.g}, {"b", c.b}, {"a", c.a}};
}

json time_json(double stamp) {
  const double whole = std::floor(std::max(0.0, stamp));
  const auto nsec = static_cast<std::int64_t>((std::max(0.0, stamp) - whole) * 1e9);
  return {{"sec", static_cast<std::int64_t>(whole)}, {"nsec", nsec}};
}

json point_json(const algo::Vec2& p, double z) {
  return xyz({p.x(), p.y(), z});
}

json rotation_json(double heading) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(heading / 2)}, {"w", std::cos(heading / 2)}};
}

json pose_json(const algo::Pose2& pose, double z) {
  return pose_at({pose.x, pose.y, z}, pose.heading);
}

json entity_json(double stamp, const std::string& id, const char* frame_id, double lifetime) {
  json entity = {{"timestamp", time_json(stamp)},
                 {"frame_id", frame_id},
                 {"id", id},
                 {"lifetime", time_json(lifetime)},
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

json scene_json(json entities, json deletions) {
  return {{"deletions", std::move(deletions)}, {"entities", std::move(entities)}};
}

json line_json(LineKind kind,
               std::span<const Point> points,
               const Colour& colour,
               double thickness) {
  return {{"type", static_cast<int>(kind)},
          {"pose", pose_json({})},
          {"thickness", thickness},
          {"scale_invariant", false},
          {"points", points_json(points)},
          {"color", to_json(colour)},
          {"colors", json::array()},
          {"indices", json::array()}};
}

json triangles_json(std::span<const Point> points, const Colour& colour) {
  return {{"pose", pose_json({})},
          {"points", points_json(points)},
          {"color", to_json(colour)},
          {"colors", json::array()},
          {"indices", json::array()}};
}

json arrow_json(const Point& from, const algo::Vec2& vector, const Colour& colour) {
  const double length = vector.norm();
  return {{"pose", pose_at(from, std::atan2(vector.y(), vector.x()))},
          {"shaft_length", length * 0.8},
          {"shaft_diameter", 0.03},
          {"head_length", length * 0.2},
          {"head_diameter", 0.07},
          {"color", to_json(colour)}};
}

json sphere_json(const Point& at, double diameter, const Colour& colour) {
  return {{"pose", pose_at(at)},
          {"size", xyz({diameter, diameter, diameter})},
          {"color", to_json(colour)}};
}

json text_json(const Point& at, const std::string& text, const Colour& colour) {
  return {{"pose", pose_at(at)},
          {"billboard", true},
          {"font_size", 12.0},
          {"scale_invariant", true},
          {"color", to_json(colour)},
          {"text", text}};
}

}  // namespace server::scene
