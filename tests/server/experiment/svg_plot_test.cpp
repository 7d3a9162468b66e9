// tests/server/experiment/svg_plot_test.cpp: metres to pixels, and text within XML.
#include "server/experiment/svg_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::experiment {
namespace {

using ::testing::HasSubstr;

TEST(SvgPlot, PutsMetresUpsideUpAndEscapesWords) {
  // 2 m x 1 m on 220 px with 10 px of margin: 100 px a metre; y = 1 is at the top margin.
  SvgPlot plot({0, 0}, {2, 1}, 220, 0);
  plot.circle({1, 1}, 0.5, "fill=\"none\"");
  const std::vector<algo::Vec2> line{{0, 0}, {2, 0.5}};
  plot.polyline(line, "stroke=\"red\"");
  const std::string document = plot.document("a < b & c");
  EXPECT_THAT(document, HasSubstr("<circle cx=\"110.0\" cy=\"10.0\" r=\"50.0\""));
  EXPECT_THAT(document, HasSubstr("points=\"10.0,110.0 210.0,60.0\""));
  EXPECT_THAT(document, HasSubstr("<title>a &lt; b &amp; c</title>"));
}

TEST(SvgCanvas, WritesShapesInPixelsWithClassesOfAStyleSheet) {
  SvgCanvas canvas(100, 50, ".grid{stroke:#eee}");
  canvas.line({0, 1.25}, {99.96, 1}, "class=\"grid\"");
  canvas.path("M0 0L5 5", "class=\"grid\"");
  canvas.text({3, 4}, "N < 3", "class=\"end\"");
  const std::string document = canvas.document("Grid");
  EXPECT_THAT(document, HasSubstr("viewBox=\"0 0 100 50\""));
  EXPECT_THAT(document, HasSubstr("<style>.grid{stroke:#eee}</style>"));
  EXPECT_THAT(document, HasSubstr("<line x1=\"0.0\" y1=\"1.2\" x2=\"100.0\" y2=\"1.0\" class"));
  EXPECT_THAT(document, HasSubstr("<path class=\"grid\" d=\"M0 0L5 5\"/>"));
  EXPECT_THAT(document, HasSubstr("<text x=\"3.0\" y=\"4.0\" class=\"end\">N &lt; 3</text>"));
  EXPECT_THAT(SvgCanvas(1, 1).document("Empty"), testing::Not(HasSubstr("<style>")));
}

}  // namespace
}  // namespace server::experiment
