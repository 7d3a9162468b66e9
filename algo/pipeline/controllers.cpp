// algo/pipeline/controllers.cpp: the variants of the elastic strip, then the baselines.
#include "algo/pipeline/controllers.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "algo/baselines/certainty_grid.hpp"
#include "algo/baselines/dwa.hpp"
#include "algo/baselines/edge_detection.hpp"
#include "algo/baselines/go_to_goal.hpp"
#include "algo/baselines/potential_field.hpp"
#include "algo/baselines/vff.hpp"
#include "algo/baselines/vfh.hpp"
#include "algo/full_strip/full_strip_controller.hpp"
#include "algo/strip/elastic_strip_controller.hpp"
#include "algo/strip/strip_law.hpp"

namespace algo {
namespace {

std::function<std::unique_ptr<Controller>()> strip(ForceLaw law,
                                                   Sides sides,
                                                   bool choose_side,
                                                   bool keep_via = false) {
  return [reading = StripReading{law, sides, choose_side, keep_via}] {
    return std::make_unique<ElasticStripController>(reading);
  };
}

template <typename Type>
std::unique_ptr<Controller> made() {
  return std::make_unique<Type>();
}

/// A kept via point follows pass' = end + F_ext + K_c (chord - pass). Its error changes sign at
/// each tick and shrinks by the factor K_c; with K_c = 1 it never shrinks.
std::optional<std::string> via_kept_refusal(const Parameters& parameters) {
  if (parameters[kContractionGain] < 1) return std::nullopt;
  return "k_c must be below 1 with the controller via_kept: at 1 its via point swings from side to "
         "side and never settles";
}

std::vector<ControllerInfo> builtin() {
  return {
      {.name = "modified",
       .label = "Modified strip with side choice",
       .help = "Both sides push, without a jump, and on a blocked line the strip chooses a side. "
               "Keeps the most clearance; needs about 2 m between obstacles.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::C1, Sides::Both, true)},
      {.name = "original",
       .label = "Original strip",
       .help = "The nearest obstacle point pushes (Eq. 7). Gets stuck head-on and enters the "
               "safety circle.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::Original, Sides::Nearest, false)},
      {.name = "original_side",
       .label = "Original strip with side choice",
       .help = "As the original, and on a blocked line the strip chooses a side. Reaches the most "
               "goals, closest to obstacles.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::Original, Sides::Nearest, true)},
      {.name = "modified_published",
       .label = "Modified strip as published",
       .help = "Both sides push by Eq. 13-14 as printed, limited at its pole.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::Published, Sides::Both, false)},
      {.name = "modified_linear",
       .label = "Modified strip, linear part",
       .help = "Eq. 13-14 without the second branch: nothing pushes beyond the safety distance.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::Linear, Sides::Both, false)},
      {.name = "modified_c1",
       .label = "Modified strip, continuous",
       .help =
           "Both sides push by a law without a jump, and no side is chosen. Gets stuck head-on.",
       .parameters = kStripParameters,
       .make = strip(ForceLaw::C1, Sides::Both, false)},
      {.name = "via_kept",
       .label = "Modified strip, via kept",
       .help = "As the modified strip, and the via point of the tick before is pulled onto the "
               "line by K_c: the only one in which K_c acts.",
       .parameters = kKeptViaParameters,
       .make = strip(ForceLaw::C1, Sides::Both, true, true),
       .refusal = via_kept_refusal},
      {.name = "strip",
       .label = "Full elastic strip",
       .help = "Many nodes on a map of the scans, laid anew by a planner where they break, and a "
               "velocity stage that proves every command before it is given. Our extension.",
       .keeps_jerk = true,
       .parameters = FullStripController::parameters(),
       .make = made<FullStripController>},
      {.name = "strip_moving",
       .label = "Full elastic strip among moving things",
       .help = "As the full strip, and moving obstacles are tracked in the scans; a search in "
               "space and "
               "time gives way to it. An experiment: of the moving obstacles it is measured on it "
               "still meets many.",
       .keeps_jerk = true,
       .parameters = FullStripController::parameters(),
       .make = [] { return std::make_unique<FullStripController>(true); }},
      {.name = "go_to_goal",
       .label = "Straight to the goal",
       .help =
           "Sees nothing and drives at the goal: what every other controller must do better than.",
       .by_sonar = true,
       .parameters = kDrivingParameters,
       .make = made<GoToGoal>},
      {.name = "edge_detection",
       .label = "Edge detection",
       .help = "Stops before an obstacle, looks for its edges and drives past one of them (as in "
               "Borenstein and Koren 1988).",
       .parameters = EdgeDetection::parameters(),
       .make = made<EdgeDetection>},
      {.name = "potential_field",
       .label = "Potential field",
       .help = "The goal pulls, each obstacle pushes from its nearest point (Khatib 1986). Comes "
               "to rest where they cancel.",
       .by_sonar = true,
       .parameters = PotentialField::parameters(),
       .make = made<PotentialField>},
      {.name = "certainty_grid",
       .label = "Certainty grid with A*",
       .help = "Maps what is surely empty or occupied (Moravec and Elfes 1985) and follows the "
               "least-cost path over the map.",
       .by_sonar = true,
       .parameters = CertaintyGridPlanner::parameters(),
       .make = made<CertaintyGridPlanner>},
      {.name = "vff",
       .label = "Virtual force field",
       .help = "Cells that returned readings push, the goal pulls (Borenstein and Koren 1989). "
               "Comes to rest where they cancel.",
       .by_sonar = true,
       .parameters = Vff::parameters(),
       .make = made<Vff>},
      {.name = "vfh",
       .label = "Vector field histogram",
       .help = "Steers through the free valley of a polar histogram nearest to the goal "
               "(Borenstein and Koren 1991).",
       .by_sonar = true,
       .parameters = Vfh::parameters(),
       .make = made<Vfh>},
      {.name = "dwa",
       .label = "Dynamic window",
       .help = "Of the speeds it can reach and stop, takes the best by heading, clearance and "
               "speed (Fox, Burgard and Thrun 1997). Knows no way but the arc ahead.",
       .parameters = Dwa::parameters(),
       .make = made<Dwa>},
  };
}

}  // namespace

const ControllerInfo* ControllerCatalogue::find(std::string_view name) const {
  const auto found = std::ranges::find(entries_, name, &ControllerInfo::name);
  return found == entries_.end() ? nullptr : &*found;
}

const ControllerInfo& ControllerCatalogue::at(std::string_view name) const {
  if (const ControllerInfo* found = find(name)) return *found;
  std::string known;
  for (const ControllerInfo& each : entries_) {
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw std::invalid_argument("no controller is called '" + std::string(name) + "'; there are " +
                              known);
}

const ControllerCatalogue& builtin_controllers() {
  static const ControllerCatalogue catalogue(builtin());
  return catalogue;
}

}  // namespace algo
