// server/run/obstacle_json.cpp: one reader per shape.
#include "server/run/obstacle_json.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "server/run/json_reader.hpp"
#include "server/run/motion_json.hpp"
#include "server/run/pose_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxPolygonPoints = 256;

using Keys = std::initializer_list<std::string_view>;

/// Throws for a field that no obstacle of its kind has: `first` come before the place, `own` after
/// it.
void only_standing(const JsonReader& in, Keys own, Keys first = {}) {
  std::vector<std::string_view> known{"id", "type"};
  for (const Keys& keys : {first,
                           Keys{"x", "y", "heading"},
                           own,
                           Keys{"height", "bottom", "reflectivity", "specular", "path"}}) {
    known.insert(known.end(), keys.begin(), keys.end());
  }
  in.only(known);
}

void read_wall(const JsonReader& in, algo::Obstacle& obstacle) {
  only_standing(in, {"length", "thickness"}, {"from", "to"});
  algo::Wall wall{in.number_or("length", 0), in.number_or("thickness", 0.1)};
  if (in.has("from") || in.has("to")) {
    const algo::Vec2 from = point_from_json(in.array("from", 2), in.at("from"));
    const algo::Vec2 to = point_from_json(in.array("to", 2), in.at("to"));
    const algo::Vec2 along = to - from;
    const algo::Vec2 middle = (from + to) / 2;
    wall.length = along.norm();
    obstacle.pose_W = {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
  } else {
    obstacle.pose_W = pose_from_json(in, 0);
  }
  obstacle.shape = wall;
}

/// Points are given in W. The obstacle's frame is put at their mean, so that it moves by its
/// centre.
void read_polygon(const JsonReader& in, algo::Obstacle& obstacle) {
  only_standing(in, {}, {"points"});
  algo::Polygon polygon;
  algo::Vec2 sum{0, 0};
  in.each("points", kMaxPolygonPoints, [&](const json& point, const std::string& at) {
    polygon.points.push_back(point_from_json(point, at));
    sum += polygon.points.back();
  });
  if (in.has("x") || in.has("y") || in.has("heading")) {
    obstacle.pose_W = pose_from_json(in, 0);  // the points are in the obstacle's own frame
  } else if (!polygon.points.empty()) {
    const algo::Vec2 middle = sum / static_cast<double>(polygon.points.size());
    for (algo::Vec2& p : polygon.points) p -= middle;
    obstacle.pose_W = {middle.x(), middle.y(), 0};
  }
  // A clockwise outline means the same shape: reverse it instead of refusing it.
  double twice_area = 0;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const algo::Vec2& a = polygon.points[i];
    const algo::Vec2& b = polygon.points[(i + 1) % polygon.points.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  if (twice_area < 0) std::reverse(polygon.points.begin(), polygon.points.end());
  obstacle.shape = std::move(polygon);
}

/// A step is a ramp of one height.
void read_ramp(const JsonReader& in, bool step, algo::Obstacle& obstacle) {
  in.only({"id",
           "type",
           "x",
           "y",
           "heading",
           "length",
           "width",
           step ? "height" : "low",
           "height",
           "reflectivity",
           "specular"});
  obstacle.pose_W = pose_from_json(in, 0);
  const double height = in.number("height");
  obstacle.shape =
      algo::Ramp{in.number("length"), in.number("width"), step ? height : in.number_or("low", 0)};
}

void read_trench(const JsonReader& in, algo::Obstacle& obstacle) {
  in.only(
      {"id", "type", "x", "y", "heading", "length", "width", "depth", "reflectivity", "specular"});
  obstacle.pose_W = pose_from_json(in, 0);
  obstacle.shape = algo::Trench{in.number("length"), in.number("width"), in.number("depth")};
}

}  // namespace

algo::Obstacle obstacle_from_json(const json& value, const std::string& path) {
  const JsonReader in(value, path);
  algo::Obstacle obstacle;
  obstacle.id = static_cast<std::uint32_t>(in.whole_or("id", 0, kMaxObstacleId));
  const std::string type = in.text("type");
  if (type == "cylinder") {
    only_standing(in, {"radius"});
    obstacle.pose_W = pose_from_json(in, 0);
    obstacle.shape = algo::Cylinder{in.number("radius")};
  } else if (type == "box") {
    only_standing(in, {"length", "width"});
    obstacle.pose_W = pose_from_json(in, 0);
    obstacle.shape = algo::Box{in.number("length"), in.number("width")};
  } else if (type == "polygon") {
    read_polygon(in, obstacle);
  } else if (type == "wall") {
    read_wall(in, obstacle);
  } else if (type == "ramp" || type == "step") {
    read_ramp(in, type == "step", obstacle);
  } else if (type == "trench") {
    read_trench(in, obstacle);
  } else {
    in.fail(
        "type",
        fmt::format("'{}' is unknown; known are cylinder, box, polygon, wall, ramp, step, trench",
                    type));
  }
  obstacle.height = in.number_or("height", obstacle.height);
  obstacle.bottom = in.number_or("bottom", obstacle.bottom);
  obstacle.reflectivity = in.number_or("reflectivity", obstacle.reflectivity);
  obstacle.specular = in.flag_or("specular", false);
  if (in.has("path")) obstacle.path = path_from_json(in.object("path"));
  if (const auto complaint = algo::defect(obstacle)) throw DocumentError(path, *complaint);
  return obstacle;
}

json to_json(const algo::Obstacle& o) {
  json out = {{"id", o.id},
              {"x", o.pose_W.x},
              {"y", o.pose_W.y},
              {"heading", o.pose_W.heading},
              {"height", o.height},
              {"reflectivity", o.reflectivity},
              {"specular", o.specular}};
  std::visit(
      [&](const auto& shape) {
        using S = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<S, algo::Cylinder>) {
          out["type"] = "cylinder";
          out["radius"] = shape.radius;
        } else if constexpr (std::is_same_v<S, algo::Box>) {
          out["type"] = "box";
          out["length"] = shape.length;
          out["width"] = shape.width;
        } else if constexpr (std::is_same_v<S, algo::Polygon>) {
          out["type"] = "polygon";
          out["points"] = json::array();
          for (const algo::Vec2& p : shape.points) out["points"].push_back({p.x(), p.y()});
        } else if constexpr (std::is_same_v<S, algo::Wall>) {
          out["type"] = "wall";
          out["length"] = shape.length;
          out["thickness"] = shape.thickness;
        } else if constexpr (std::is_same_v<S, algo::Ramp>) {
          const bool step = shape.low == o.height;
          out["type"] = step ? "step" : "ramp";
          out["length"] = shape.length;
          out["width"] = shape.width;
          if (!step) out["low"] = shape.low;
        } else {
          out["type"] = "trench";
          out["length"] = shape.length;
          out["width"] = shape.width;
          out["depth"] = shape.depth;
          out.erase("height");
        }
      },
      o.shape);
  if (o.bottom > 0) out["bottom"] = o.bottom;
  if (o.path) out["path"] = to_json(*o.path);
  return out;
}

}  // namespace server
