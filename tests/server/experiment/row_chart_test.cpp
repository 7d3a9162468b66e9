// tests/server/experiment/row_chart_test.cpp: values to pixels, round ticks, cells.
#include "server/experiment/row_chart.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(RowChart, TheAxisHasRoundTicksAndCoversItsRange) {
  const std::string svg = RowChart({"a"}, "time [s]", {52.2, 231.9}).document("Times");
  for (const char* const tick : {">50<", ">100<", ">250<", ">time [s]<"}) {
    EXPECT_THAT(svg, HasSubstr(tick));
  }
  EXPECT_THAT(svg, Not(HasSubstr(">0<")));
  EXPECT_THAT(RowChart({"a"}, "x", {0.1, 0.7}).document("x"), HasSubstr(">0.2<"));
}

TEST(RowChart, ARangeWithoutWidthHasAnAxisToo) {
  const std::string svg = RowChart({"a"}, "x", {3, 3}).document("x");
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(RowChart, ABarEndsAtItsValue) {
  // The label "ab" leaves 30 px; the axis from 0 to 1 ends at 640 - 24 px: 0.5 is at 323.
  RowChart chart({"ab"}, "rate", {0, 1});
  chart.bar(0, 0.5, {0.25, 1});
  const std::string svg = chart.document("Rates");
  EXPECT_THAT(svg, HasSubstr("points=\"30.0,19.0 323.0,19.0 323.0,35.0 30.0,35.0\" class=\"bar\""));
  EXPECT_THAT(svg, HasSubstr("x1=\"176.5\" y1=\"27.0\" x2=\"616.0\""));
}

TEST(RowChart, ABoxHasItsMedianAndWhiskers) {
  RowChart chart({"ab"}, "rate", {0, 1});
  chart.box(0, order_statistics({0, 0.25, 0.5, 0.75, 1}).value());
  const std::string svg = chart.document("Rates");
  EXPECT_THAT(svg, HasSubstr("points=\"176.5,19.0 469.5,19.0"));
  EXPECT_THAT(svg, HasSubstr("x1=\"323.0\" y1=\"19.0\" x2=\"323.0\" y2=\"35.0\""));
  EXPECT_THAT(svg, HasSubstr("x1=\"30.0\" y1=\"27.0\" x2=\"176.5\""));
}

TEST(HeatMap, HasACellForEachKnownValue) {
  const std::string svg = heat_map(
      "Success", "k_r", {"0.2", "0.4"}, "v_max", {"1", "2"}, {{0.25, std::nan("")}, {1, 0}});
  EXPECT_THAT(svg, HasSubstr("fill-opacity=\"0.25\""));
  EXPECT_THAT(svg, HasSubstr("class=\"on\" text-anchor=\"middle\">1.00<"));
  EXPECT_THAT(svg, HasSubstr(">v_max<"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace server::experiment
