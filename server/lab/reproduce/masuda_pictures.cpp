// server/lab/reproduce/masuda_pictures.cpp: readings over the way, raw and after the median, as SVG
// that is readable in light and dark.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"
#include "server/lab/reproduce/masuda_study.hpp"

namespace server::reproduce {
namespace {

using experiment::SvgCanvas;

constexpr double kTraceWide = 760;  // [px]
constexpr double kTraceHigh = 260;  // [px] of a panel
constexpr double kTraceLeft = 48;   // [px] of the margins
constexpr double kTraceRight = 30;
constexpr double kTraceTop = 40;
constexpr double kTraceFoot = 28;
constexpr double kToCm = 100;

constexpr std::string_view kTraceStyle =
    "text{font:12px system-ui,sans-serif;fill:#555}.head{font-size:15px;font-weight:600;fill:#222}"
    ".end{text-anchor:end}.middle{text-anchor:middle}path{fill:none}.raw{stroke-width:0.7;"
    "stroke-opacity:0.7}.smooth{stroke-width:2}.grid{stroke:#e6e6e6}.one{stroke:#d1495b}"
    ".two{stroke:#3f88c5}text.one{fill:#d1495b;stroke:none}text.two{fill:#3f88c5;stroke:none}"
    "rect{fill:#fff}@media(prefers-color-scheme:dark){rect{fill:#12181f}text{fill:#a5b1bc}"
    ".head{fill:#e7edf2}.grid{stroke:#2b3640}}";

/// Readings [m] over the way [m] in one panel, in cm.
struct TracePanel {
  double top = 0;                              // [px]
  double from = 0, to = 1, low = 0, high = 1;  // [cm]
  double x(double way) const {
    return kTraceLeft + (way - from) / (to - from) * (kTraceWide - kTraceLeft - kTraceRight);
  }
  double y(double range) const {
    const double part = std::clamp((range - low) / (high - low), 0.0, 1.0);
    return top + kTraceHigh - kTraceFoot - part * (kTraceHigh - kTraceFoot - kTraceTop);
  }
  void axes(SvgCanvas& canvas, double step) const {
    for (double range = low; range <= high + step / 2; range += step) {
      canvas.line({x(from), y(range)}, {x(to), y(range)}, "class=\"grid\"");
      canvas.text({x(from) - 5, y(range) + 4}, fmt::format("{:g}", range), "class=\"end\"");
    }
    for (double way = from; way <= to + 1; way += 5) {
      canvas.line({x(way), y(low)}, {x(way), y(high)}, "class=\"grid\"");
      canvas.text({x(way), y(low) + 16}, fmt::format("{:g} cm", way), "class=\"middle\"");
    }
  }
  void curve(SvgCanvas& canvas,
             const std::vector<double>& way,
             const std::vector<double>& ranges,
             std::string_view style) const {
    std::string steps;
    bool down = false;
    for (std::size_t k = 0; k < way.size(); ++k) {
      const bool known = std::isfinite(ranges[k]);
      if (known) {
        steps += fmt::format(
            "{}{:.1f} {:.1f}", down ? "L" : "M", x(kToCm * way[k]), y(kToCm * ranges[k]));
      }
      down = known;
    }
    canvas.path(steps, fmt::format("class=\"{}\"", style));
  }
};

/// Both sensors of the left side.
std::string draw_side(const std::string& title, const MasudaTrace& trace, double low, double high) {
  SvgCanvas canvas(kTraceWide, kTraceHigh + 10, kTraceStyle);
  canvas.text({kTraceLeft, 20}, title, "class=\"head\"");
  const TracePanel panel{.from = -25, .to = 10, .low = low, .high = high};
  panel.axes(canvas, 10);
  panel.curve(canvas, trace.way, trace.raw[0], "raw one");
  panel.curve(canvas, trace.way, trace.raw[2], "raw two");
  panel.curve(canvas, trace.way, trace.smooth[0], "smooth one");
  panel.curve(canvas, trace.way, trace.smooth[2], "smooth two");
  canvas.text({kTraceLeft + 8, 36}, "X1 [cm]", "class=\"one\"");
  canvas.text({kTraceLeft + 78, 36}, "X2 [cm]", "class=\"two\"");
  canvas.text({kTraceLeft + 148, 36},
              "thin raw, bold after the median of 5; way of the near "
              "beam past the edge");
  return canvas.document(title);
}

/// The near sensors of both sides, for each angle of the trench.
std::string draw_trenches(const std::vector<MasudaTrace>& traces) {
  const std::string title = "Fig. 10: a trench of 2 cm met at 10, 20 and 30 degrees";
  const double high = kTraceHigh * static_cast<double>(traces.size());
  SvgCanvas canvas(kTraceWide, high + 10, kTraceStyle);
  canvas.text({kTraceLeft, 20}, title, "class=\"head\"");
  for (std::size_t k = 0; k < traces.size(); ++k) {
    TracePanel panel{.from = -25, .to = 15, .low = 18, .high = 24};
    panel.top = kTraceHigh * static_cast<double>(k);
    panel.axes(canvas, 1);
    panel.curve(canvas, traces[k].way, traces[k].smooth[2], "smooth one");
    panel.curve(canvas, traces[k].way, traces[k].smooth[3], "smooth two");
    const double y = panel.top + 36;
    canvas.text({kTraceLeft + 8, y}, "X2 left [cm]", "class=\"one\"");
    canvas.text({kTraceLeft + 98, y}, "X2 right [cm]", "class=\"two\"");
    canvas.text({kTraceLeft + 198, y}, fmt::format("{} degrees, median of 5", 10 * (k + 1)));
  }
  return canvas.document(title);
}

}  // namespace

std::vector<Picture> draw(const MasudaStudy& study) {
  return {{.file = std::string(kMasudaStepPicture),
           .svg = draw_side("Fig. 4: towards a step of 18 mm", study.step, 10, 40)},
          {.file = std::string(kMasudaSlopePicture),
           .svg = draw_side("Fig. 5: towards a slope of -20 degrees", study.slope, 10, 60)},
          {.file = std::string(kMasudaTrenchPicture), .svg = draw_trenches(study.trenches)}};
}

}  // namespace server::reproduce
