// server/lab/reproduce/robhaz_turnover_picture.cpp: Fig. 13, the quantities of the turn on the
// slope.
#include <algorithm>

#include "algo/units.hpp"
#include "server/lab/reproduce/robhaz_turnover.hpp"
#include "server/lab/reproduce/time_panels.hpp"

namespace server::reproduce {
namespace {

using algo::units::kRadiansPerDegree;
using Sample = TurnoverSample;

constexpr double kPerSecond = 1;  // [s] between vertical lines

std::vector<PanelPlan<Sample>> turnover_panels() {
  return {
      {"roll [deg]",
       -15,
       15,
       5,
       {{"measured", [](const Sample& s) { return s.roll / kRadiansPerDegree; }},
        {"predicted", [](const Sample& s) { return s.roll_predicted / kRadiansPerDegree; }}}},
      {"pitch [deg]",
       -15,
       15,
       5,
       {{"measured", [](const Sample& s) { return s.pitch / kRadiansPerDegree; }},
        {"predicted", [](const Sample& s) { return s.pitch_predicted / kRadiansPerDegree; }}}},
      {"bounds [deg/s]",
       -100,
       100,
       50,
       {{"w_lb", [](const Sample& s) { return s.w_lb / kRadiansPerDegree; }},
        {"w_ub", [](const Sample& s) { return s.w_ub / kRadiansPerDegree; }}}},
      {"w [deg/s]",
       -100,
       100,
       50,
       {{"w_cmd", [](const Sample& s) { return s.w_cmd / kRadiansPerDegree; }},
        {"w", [](const Sample& s) { return s.w / kRadiansPerDegree; }}}},
      {"X / 10000",
       -1,
       1,
       0.5,
       {{"q_offset", [](const Sample& s) { return s.q_offset; }},
        {"W_DB", [](const Sample& s) { return s.dead_band; }},
        {"force", [](const Sample& s) { return s.force_left; }}}},
  };
}

}  // namespace

std::string draw(const TurnoverStudy& study) {
  const auto found = std::ranges::find_if(
      study.runs, [](const TurnoverRun& run) { return run.robot == kTallRobot && run.with_guard; });
  const auto plans = turnover_panels();
  const std::string title = "The quantities of Fig. 13 over time, h 0.90 m, with the controller";
  experiment::SvgCanvas canvas(kWide, picture_height(plans.size()), kPanelStyle);
  canvas.text({kLeftEdge, 20}, title, "class=\"head\"");
  if (found != study.runs.end()) {
    draw_panels(plans, found->samples, found->seconds, kPerSecond, canvas);
  }
  return canvas.document(title);
}

}  // namespace server::reproduce
