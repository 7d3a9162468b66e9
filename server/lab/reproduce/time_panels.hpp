// server/lab/reproduce/time_panels.hpp: quantities over time, in panels below each other, as SVG
// that is readable in light and dark.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"

namespace server::reproduce {

constexpr double kWide = 760;    // [px]
constexpr double kHigh = 130;    // [px] of a panel
constexpr double kHeading = 64;  // [px] above the panels
constexpr double kLeftEdge = 56;
constexpr double kRightEdge = 12;
constexpr double kPanelHead = 22;
constexpr double kPanelFoot = 12;

constexpr std::string_view kPanelStyle =
    "text{font:12px system-ui,sans-serif;fill:#555}.head{font-size:15px;font-weight:600;fill:#222}"
    ".end{text-anchor:end}.middle{text-anchor:middle}path{fill:none;stroke-width:1.5}"
    ".grid{stroke:#e6e6e6}.one{stroke:#d1495b;fill:none}.two{stroke:#3f88c5;fill:none}"
    ".three{stroke:#2e8b47;fill:none}text.one{fill:#d1495b;stroke:none}text.two{fill:#3f88c5;"
    "stroke:"
    "none}text.three{fill:#2e8b47;stroke:none}.section{stroke:#84897a;stroke-width:2}rect{fill:#"
    "fff}"
    "@media(prefers-color-scheme:dark){rect{fill:#12181f}text{fill:#a5b1bc}.head{fill:#e7edf2}"
    ".grid{stroke:#2b3640}}";

/// One quantity of a sample: its words in the panel's head and its value in the panel's unit.
template <typename Sample>
struct Curve {
  const char* words = "";
  double (*value)(const Sample& s) = nullptr;
};

template <typename Sample>
struct PanelPlan {
  const char* title = "";
  double low = 0, high = 1, step = 1;
  std::vector<Curve<Sample>> curves{};
};

constexpr std::array<const char*, 3> kCurveClasses{"one", "two", "three"};

/// Maps time and value of one panel to pixels.
struct PanelPlace {
  double top = 0;  // [px]
  double seconds = 30;
  double low = 0, high = 1;
  double x(double stamp) const {
    return kLeftEdge + stamp / seconds * (kWide - kLeftEdge - kRightEdge);
  }
  double y(double value) const {
    const double part = (value - low) / (high - low);
    return top + kHigh - kPanelFoot -
           std::clamp(part, 0.0, 1.0) * (kHigh - kPanelHead - kPanelFoot);
  }
};

template <typename Sample>
void draw_curve(const PanelPlace& place,
                const Curve<Sample>& curve,
                const char* style,
                const std::vector<Sample>& samples,
                experiment::SvgCanvas& canvas) {
  std::string steps;
  bool down = false;
  for (const Sample& s : samples) {
    const double value = curve.value(s);
    if (std::isfinite(value)) {
      steps += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", place.x(s.stamp), place.y(value));
    }
    down = std::isfinite(value);
  }
  canvas.path(steps, fmt::format("class=\"{}\"", style));
}

template <typename Sample>
void draw_panel(const PanelPlace& place,
                const PanelPlan<Sample>& plan,
                double every,
                const std::vector<Sample>& samples,
                experiment::SvgCanvas& canvas) {
  for (double value = plan.low; value <= plan.high + plan.step / 2; value += plan.step) {
    canvas.line(
        {place.x(0), place.y(value)}, {place.x(place.seconds), place.y(value)}, "class=\"grid\"");
    canvas.text({place.x(0) - 5, place.y(value) + 4}, fmt::format("{:g}", value), "class=\"end\"");
  }
  for (double stamp = 0; stamp <= place.seconds; stamp += every) {
    canvas.line({place.x(stamp), place.y(plan.low)},
                {place.x(stamp), place.y(plan.high)},
                "class=\"grid\"");
  }
  canvas.text({place.x(0), place.top + kPanelHead - 8}, plan.title);
  for (std::size_t k = 0; k < plan.curves.size(); ++k) {
    const char* const style = kCurveClasses.at(k);
    canvas.text({place.x(0) + 90 + 80 * static_cast<double>(k), place.top + kPanelHead - 8},
                plan.curves[k].words,
                fmt::format("class=\"{}\"", style));
    draw_curve(place, plan.curves[k], style, samples, canvas);
  }
}

/// [px] Height of a picture with `panels` panels.
inline double picture_height(std::size_t panels) {
  return kHeading + static_cast<double>(panels) * kHigh + 20;
}

/// The panels with a vertical line every `every` [s], and the seconds under the last.
template <typename Sample>
void draw_panels(const std::vector<PanelPlan<Sample>>& plans,
                 const std::vector<Sample>& samples,
                 double seconds,
                 double every,
                 experiment::SvgCanvas& canvas) {
  PanelPlace place{.seconds = seconds};
  for (std::size_t k = 0; k < plans.size(); ++k) {
    place.top = kHeading + static_cast<double>(k) * kHigh;
    place.low = plans[k].low;
    place.high = plans[k].high;
    draw_panel(place, plans[k], every, samples, canvas);
  }
  for (double stamp = 0; stamp <= seconds; stamp += every) {
    canvas.text(
        {place.x(stamp), place.top + kHigh + 6}, fmt::format("{:g} s", stamp), "class=\"middle\"");
  }
}

}  // namespace server::reproduce
