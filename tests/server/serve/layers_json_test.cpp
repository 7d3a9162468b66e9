// tests/server/serve/layers_json_test.cpp: every kind of layer as Foxglove primitives.
#include "server/serve/layers_json.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace server {
namespace {

using algo::Layer;
using algo::LayerInfo;
using algo::LayerKind;
using nlohmann::json;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The entity of one layer of a robot at (1, 2).
json drawn(const LayerInfo& info,
           std::vector<float> values,
           std::vector<std::uint8_t> cells = {},
           const std::string& text = "") {
  algo::Telemetry t;
  t.observation.odometry.pose = {1, 2, 0.5};
  Layer& layer = add_layer(t.output.layers, info);
  layer.values = std::move(values);
  layer.cells = std::move(cells);
  layer.text = text;
  layer.level = 10;
  const json update = json::parse(layers_json(t));
  EXPECT_EQ(update.at("entities").size(), 1U);
  return update.at("entities").at(0);
}

double number(const json& point, const char* axis) {
  return point.at(axis).get<double>();
}

TEST(LayersJson, AnEntityIsNamedAsItsLayerAndExpires) {
  const json entity = drawn({.name = "strip", .kind = LayerKind::Polyline}, {0, 0, 1, 0});
  EXPECT_EQ(entity.at("id"), "strip");
  EXPECT_EQ(entity.at("frame_id"), "map");
  EXPECT_EQ(entity.at("lifetime").at("nsec"), 500'000'000);
}

TEST(LayersJson, EmptyLayersAreNotDrawn) {
  algo::Telemetry t;
  add_layer(t.output.layers, {.name = "strip"});
  EXPECT_TRUE(json::parse(layers_json(t)).at("entities").empty());
}

TEST(LayersJson, LayersOfThePipelineAreDrawnToo) {
  algo::Telemetry t;
  put(add_layer(t.layers, {.name = "scan.nearest"}), 1.0, 2.0);
  EXPECT_EQ(json::parse(layers_json(t)).at("entities").at(0).at("id"), "scan.nearest");
}

TEST(LayersJson, DashedPointsAreTiedToTheRobot) {
  LayerInfo info{.name = "points", .kind = LayerKind::Points};
  EXPECT_TRUE(drawn(info, {3, 4, 5, 6}).at("lines").empty());
  info.style = algo::LayerStyle::Dashed;
  const json entity = drawn(info, {3, 4, 5, 6});
  EXPECT_EQ(entity.at("spheres").size(), 2U);
  const json& ties = entity.at("lines").at(0).at("points");
  ASSERT_EQ(ties.size(), 4U);
  EXPECT_EQ(number(ties[0], "x"), 1);
  EXPECT_EQ(number(ties[0], "y"), 2);
  EXPECT_EQ(number(ties[3], "x"), 5);
}

TEST(LayersJson, ANanPositionStartsANewLine) {
  const json entity = drawn({.name = "plan", .kind = LayerKind::Polyline},
                            {0, 0, 1, 0, 2, 0, kNan, kNan, 5, 5, 6, 6});
  ASSERT_EQ(entity.at("lines").size(), 2U);
  EXPECT_EQ(entity.at("lines").at(0).at("points").size(), 3U);
  EXPECT_EQ(entity.at("lines").at(1).at("points").size(), 2U);
}

TEST(LayersJson, ArrowsPointAlongTheirVectors) {
  const json entity =
      drawn({.name = "force", .kind = LayerKind::Arrows}, {1, 2, 0, 0.5, 3, 4, 0, 0});
  ASSERT_EQ(entity.at("arrows").size(), 1U);  // no force, no arrow
  const json& arrow = entity.at("arrows").at(0);
  EXPECT_EQ(number(arrow.at("pose").at("position"), "y"), 2);
  EXPECT_NEAR(number(arrow.at("pose").at("orientation"), "z"), 0.70710678, 1e-6);
  EXPECT_NEAR(number(arrow, "shaft_length") + number(arrow, "head_length"), 0.5, 1e-9);
}

TEST(LayersJson, PositionsInSpaceKeepTheirHeight) {
  const LayerInfo info{.name = "arm", .kind = LayerKind::Circles, .axes = 3};
  const json corners = drawn(info, {1, 2, 0.7F, 0.25F}).at("lines").at(0).at("points");
  for (const json& corner : corners) {
    EXPECT_NEAR(number(corner, "z"), 0.7, 1e-6);
    EXPECT_NEAR(std::hypot(number(corner, "x") - 1, number(corner, "y") - 2), 0.25, 1e-9);
  }
}

TEST(LayersJson, ArcsLeaveTheRobot) {
  const LayerInfo info{.name = "window", .kind = LayerKind::Arcs, .frame = algo::LayerFrame::Robot};
  const json entity = drawn(info, {1, 0, 0.5F, 1.5F});
  EXPECT_EQ(entity.at("frame_id"), "base_link");
  ASSERT_EQ(entity.at("lines").size(), 2U);
  const json straight = entity.at("lines").at(0).at("points");
  EXPECT_EQ(number(straight.front(), "x"), 0);
  EXPECT_NEAR(number(straight.back(), "x"), 1, 1e-9);
  EXPECT_NEAR(number(straight.back(), "y"), 0, 1e-9);
  EXPECT_GT(number(entity.at("lines").at(1).at("points").back(), "y"), 0);
}

TEST(LayersJson, AGridShowsARectangleForEachRunOfOccupiedCells) {
  const json entity = drawn({.name = "grid", .kind = LayerKind::Grid},
                            {10, 20, 0.5F, 4},
                            {0, 254, 254, 255, 200, 127, 0, 254});
  const json& points = entity.at("triangles").at(0).at("points");
  ASSERT_EQ(points.size(), 18U);  // three runs
  EXPECT_EQ(number(points[0], "x"), 10.5);
  EXPECT_EQ(number(points[2], "x"), 11.5);
  EXPECT_EQ(number(points[2], "y"), 20.5);
  EXPECT_EQ(entity.at("lifetime").at("sec"), 6);
}

TEST(LayersJson, APolarStandsAboutTheRobot) {
  const json entity = drawn({.name = "histogram", .kind = LayerKind::Polar}, {20, 0, 5, 1000});
  const json& spokes = entity.at("lines").at(0).at("points");
  ASSERT_EQ(spokes.size(), 6U);  // nothing for the empty sector
  const auto height = [&](std::size_t k) {
    const auto distance = [&](const json& p) {
      return std::hypot(number(p, "x") - 1, number(p, "y") - 2);
    };
    return distance(spokes[2 * k + 1]) - distance(spokes[2 * k]);
  };
  EXPECT_NEAR(height(0), 0.5, 1e-9);
  EXPECT_NEAR(height(1), 0.125, 1e-9);
  EXPECT_NEAR(height(2), 0.5, 1e-9);
}

TEST(LayersJson, TextHasOneLinePerPosition) {
  const json entity =
      drawn({.name = "names", .kind = LayerKind::Text}, {0, 0, 1, 1, 2, 2}, {}, "one\ntwo");
  ASSERT_EQ(entity.at("texts").size(), 2U);
  EXPECT_EQ(entity.at("texts").at(0).at("text"), "one");
  EXPECT_EQ(entity.at("texts").at(1).at("text"), "two");
}

}  // namespace
}  // namespace server
