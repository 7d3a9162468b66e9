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
#include "server/lab/reproduce/time_panels.hpp"

namespace server::reproduce {
namespace {

using experiment::SvgCanvas;

constexpr double kPer_s = 5;  // [s] between vertical lines
using algo::units::kRadiansPerDegree;

std::vector<PanelPlan<CourseSample>> panels() {
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

/// A bar for each section, above the panels, on the line of its letter.
void draw_sections(const PanelPlace& place,
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
  const auto plans = panels();
  const std::string title =
      fmt::format("{}: the quantities of Fig. 10 and 11 over time", run.reading);
  SvgCanvas canvas(kWide, picture_height(plans.size()), kPanelStyle);
  canvas.text({kLeftEdge, 20}, title, "class=\"head\"");
  draw_sections({.seconds = study.course.seconds}, study.findings[index], canvas);
  draw_panels(plans, run.samples, study.course.seconds, kPer_s, canvas);
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
  out.push_back({.file = std::string(kTurnoverPicture), .svg = draw(study.turnover)});
  return out;
}

}  // namespace server::reproduce
