// server/lab/reproduce/robhaz_pictures.cpp: the course from above, and the quantities of Fig. 10
// and 11 over time, as SVG that is readable in light and dark.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "server/experiment/path_picture.hpp"
#include "server/experiment/svg_canvas.hpp"
#include "server/lab/reproduce/robhaz_study.hpp"

namespace server::reproduce {
namespace {

using experiment::SvgCanvas;

constexpr double kWide = 760;    // [px]
constexpr double kHigh = 130;    // [px] of a panel
constexpr double kHeading = 64;  // [px] above the panels
constexpr double kLeftEdge = 56;
constexpr double kRightEdge = 12;
constexpr double kPanelHead = 22;
constexpr double kPanelFoot = 12;
constexpr double kPer_s = 5;  // [s] between vertical lines
using algo::units::kRadiansPerDegree;

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

/// One quantity: its words in the panel's head and its value in the panel's unit.
struct Curve {
  const char* words = "";
  double (*value)(const CourseSample& s) = nullptr;
};

struct PanelPlan {
  const char* title = "";
  double low = 0, high = 1, step = 1;
  std::vector<Curve> curves{};
};

std::vector<PanelPlan> panels() {
  return {
      {"rho' [m]",
       0,
       3,
       1,
       {{"rho'", [](const CourseSample& s) { return s.rho; }},
        {"min D", [](const CourseSample& s) { return s.nearest; }}}},
      {"theta' [deg]",
       -120,
       120,
       60,
       {{"theta'", [](const CourseSample& s) { return s.theta / kRadiansPerDegree; }}}},
      {"v [m/s]",
       0,
       0.4,
       0.1,
       {{"v_sprs", [](const CourseSample& s) { return s.v_sprs; }},
        {"v_cmd", [](const CourseSample& s) { return s.v_cmd; }},
        {"v", [](const CourseSample& s) { return s.v; }}}},
      {"w [deg/s]",
       -30,
       30,
       15,
       {{"w_d", [](const CourseSample& s) { return s.w_d / kRadiansPerDegree; }},
        {"w_cmd", [](const CourseSample& s) { return s.w_cmd / kRadiansPerDegree; }},
        {"w", [](const CourseSample& s) { return s.w / kRadiansPerDegree; }}}},
      {"X / 10000",
       -1,
       1,
       0.5,
       {{"q_offset", [](const CourseSample& s) { return s.q_offset_left; }},
        {"W_DB", [](const CourseSample& s) { return s.dead_band_left; }},
        {"force", [](const CourseSample& s) { return s.force_left; }}}},
      {"Y / 10000",
       -1,
       1,
       0.5,
       {{"q_offset", [](const CourseSample& s) { return s.q_offset_forward; }},
        {"force", [](const CourseSample& s) { return s.force_forward; }}}},
  };
}

constexpr std::array<const char*, 3> kCurveClasses{"one", "two", "three"};

/// Maps time and value of one panel to pixels.
struct Place {
  double top = 0;  // [px]
  double seconds = 30;
  const PanelPlan* plan = nullptr;
  double x(double stamp) const {
    return kLeftEdge + stamp / seconds * (kWide - kLeftEdge - kRightEdge);
  }
  double y(double value) const {
    const double part = (value - plan->low) / (plan->high - plan->low);
    return top + kHigh - kPanelFoot -
           std::clamp(part, 0.0, 1.0) * (kHigh - kPanelHead - kPanelFoot);
  }
};

void draw_curve(const Place& place,
                const Curve& curve,
                const char* style,
                const CourseRun& run,
                SvgCanvas& canvas) {
  std::string steps;
  bool down = false;
  for (const CourseSample& s : run.samples) {
    const double value = curve.value(s);
    if (std::isfinite(value)) {
      steps += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", place.x(s.stamp), place.y(value));
    }
    down = std::isfinite(value);
  }
  canvas.path(steps, fmt::format("class=\"{}\"", style));
}

void draw_panel(const Place& place, const CourseRun& run, SvgCanvas& canvas) {
  const PanelPlan& plan = *place.plan;
  for (double value = plan.low; value <= plan.high + plan.step / 2; value += plan.step) {
    canvas.line(
        {place.x(0), place.y(value)}, {place.x(place.seconds), place.y(value)}, "class=\"grid\"");
    canvas.text({place.x(0) - 5, place.y(value) + 4}, fmt::format("{:g}", value), "class=\"end\"");
  }
  for (double stamp = 0; stamp <= place.seconds; stamp += kPer_s) {
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
    draw_curve(place, plan.curves[k], style, run, canvas);
  }
}

/// A bar for each section, above the panels, on the line of its letter.
void draw_sections(const Place& place,
                   const std::vector<CourseFinding>& findings,
                   SvgCanvas& canvas) {
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const CourseFinding& each = findings[k];
    if (!(each.to > each.from)) continue;
    const double y = 36 + 8 * static_cast<double>(k % 4);
    canvas.line({place.x(each.from), y}, {place.x(each.to), y}, "class=\"section\"");
    canvas.text({place.x(each.from) - 3, y + 4}, each.section, "class=\"end\"");
  }
}

std::string draw_run(const RobhazStudy& study, std::size_t index) {
  const CourseRun& run = study.runs[index];
  const std::vector<PanelPlan> plans = panels();
  const std::string title =
      fmt::format("{}: the quantities of Fig. 10 and 11 over time", run.reading);
  SvgCanvas canvas(kWide, kHeading + static_cast<double>(plans.size()) * kHigh + 20, kPanelStyle);
  canvas.text({kLeftEdge, 20}, title, "class=\"head\"");
  Place place{.seconds = study.course.seconds};
  draw_sections(place, study.findings[index], canvas);
  for (std::size_t k = 0; k < plans.size(); ++k) {
    place.top = kHeading + static_cast<double>(k) * kHigh;
    place.plan = &plans[k];
    draw_panel(place, run, canvas);
  }
  for (double stamp = 0; stamp <= place.seconds; stamp += kPer_s) {
    canvas.text(
        {place.x(stamp), place.top + kHigh + 6}, fmt::format("{:g} s", stamp), "class=\"middle\"");
  }
  return canvas.document(title);
}

std::string draw_course(const RobhazStudy& study) {
  std::vector<experiment::DrawnPath> paths;
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    experiment::DrawnPath& path = paths.emplace_back();
    path.words = study.runs[k].reading;
    path.stroke = k;
    for (const CourseSample& s : study.runs[k].samples) path.track_W.push_back(s.pose_W.position());
  }
  return experiment::draw_paths(
      "The course and the path of each reading", study.course.scenario, 0, paths);
}

}  // namespace

std::string picture_of(const CourseRun& run) {
  std::string name = "robhaz-";
  for (const char c : run.reading) {
    if (c != ',') name += c == ' ' || c == '.' ? '-' : c;
  }
  return name + ".svg";
}

std::vector<Picture> draw(const RobhazStudy& study) {
  std::vector<Picture> out{{.file = std::string(kCoursePicture), .svg = draw_course(study)}};
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    out.push_back({.file = picture_of(study.runs[k]), .svg = draw_run(study, k)});
  }
  return out;
}

}  // namespace server::reproduce
