// tests/algo/legend_test.cpp: the number depends on the layers and measures, not on their values.
#include "algo/legend.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace algo {
namespace {

constexpr LayerInfo kStrip{.name = "strip", .label = "Strip", .kind = LayerKind::Polyline};
constexpr LayerInfo kForces{.name = "forces", .label = "Forces", .kind = LayerKind::Arrows};

Telemetry shown() {
  Telemetry t;
  put(add_layer(t.layers, kStrip), Vec2{0, 1});
  add_layer(t.output.layers, kForces);
  t.output.measures.push_back({"strip.left", "m", 0.5});
  return t;
}

std::uint32_t fresh(const Telemetry& t) {
  return Legend().of(t);
}

TEST(Legend, DoesNotDependOnValuesOrTextAddresses) {
  Telemetry t = shown();
  const std::uint32_t number = fresh(t);
  put(t.output.layers[0], Vec2{1, 2}, Vec2{3, 4});
  t.layers[0].values.clear();
  t.output.measures[0].value = 7;
  const std::string elsewhere = "strip";
  t.layers[0].name = elsewhere;
  EXPECT_EQ(fresh(t), number);
  EXPECT_EQ(number, 1041979820U) << "the same in every program: records rely on it";
}

TEST(Legend, ChangesWithEverythingElse) {
  const std::vector<std::function<void(Telemetry&)>> changes{
      [](Telemetry& t) { t.layers[0].name = "strap"; },
      [](Telemetry& t) { t.layers[0].label = "strip"; },
      [](Telemetry& t) { t.layers[0].unit = "m"; },
      [](Telemetry& t) { t.layers[0].kind = LayerKind::Points; },
      [](Telemetry& t) { t.layers[0].frame = LayerFrame::Robot; },
      [](Telemetry& t) { t.layers[0].tone = Tone::Plan; },
      [](Telemetry& t) { t.layers[0].style = LayerStyle::Dashed; },
      [](Telemetry& t) { t.layers[0].axes = 3; },
      [](Telemetry& t) { t.layers[0].level = 0.5F; },
      [](Telemetry& t) { t.layers.pop_back(); },
      [](Telemetry& t) { t.output.layers.pop_back(); },
      [](Telemetry& t) { t.output.measures[0].name = "strip.right"; },
      [](Telemetry& t) { t.output.measures[0].unit = "cm"; },
      [](Telemetry& t) { t.output.measures.pop_back(); },
      [](Telemetry& t) {
        t.output.measures.push_back({"", "", 0});
      }};
  Legend kept;
  const std::uint32_t number = kept.of(shown());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Telemetry t = shown();
    changes[i](t);
    EXPECT_NE(fresh(t), number) << i;
    EXPECT_EQ(kept.of(t), fresh(t)) << "after another one, " << i;
    EXPECT_EQ(kept.of(shown()), number) << i;
  }
}

}  // namespace
}  // namespace algo
