// server/serve/scene_shapes.hpp: building blocks of foxglove.* JSON messages, with every property
// of the published schemas.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "algo/types.hpp"

namespace server::scene {

struct Colour {
  double r = 0, g = 0, b = 0, a = 1;
};
/// foxglove.LinePrimitive's `type`.
enum class LineKind { Strip = 0, Loop = 1, List = 2 };
/// A place [m], z up.
struct Point {
  double x = 0, y = 0, z = 0;
};

nlohmann::json to_json(const Colour& colour);
/// {"sec","nsec"}; a negative `stamp` [s] counts as 0.
nlohmann::json time_json(double stamp);
nlohmann::json point_json(const algo::Vec2& p, double z = 0);
nlohmann::json rotation_json(double heading);
nlohmann::json pose_json(const algo::Pose2& pose, double z = 0);
/// An entity without primitives in the frame `frame_id`; `lifetime` [s], 0: for ever.
nlohmann::json entity_json(double stamp,
                           const std::string& id,
                           const char* frame_id,
                           double lifetime = 0);
nlohmann::json scene_json(nlohmann::json entities,
                          nlohmann::json deletions = nlohmann::json::array());
nlohmann::json line_json(LineKind kind,
                         std::span<const Point> points,
                         const Colour& colour,
                         double thickness);
nlohmann::json triangles_json(std::span<const Point> points, const Colour& colour);
nlohmann::json arrow_json(const Point& from, const algo::Vec2& vector, const Colour& colour);
nlohmann::json sphere_json(const Point& at, double diameter, const Colour& colour);
nlohmann::json text_json(const Point& at, const std::string& text, const Colour& colour);

}  // namespace server::scene
