// algo/pipeline/controllers.cpp: the readings of the elastic strip, then what they
// are compared with.
#include "algo/pipeline/controllers.hpp"

#include <algorithm>
#include <array>
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

namespace algo {
namespace {

using Made = std::unique_ptr<Controller>;

struct Entry {
  ControllerInfo about{};
  Made (*make)() = nullptr;
};

template <ForceLaw law, Sides sides, bool choose_side, bool keep_via = false>
Made strip() {
  return std::make_unique<ElasticStripController>(StripReading{law, sides, choose_side, keep_via});
}

template <typename Type>
Made made() {
  return std::make_unique<Type>();
}

constexpr auto kEntries = std::to_array<Entry>({
    {{"modified",
      "Modified strip with side choice",
      "Both sides push, without a jump, and on a blocked line the strip chooses a side. Keeps the "
      "most clearance; needs about 2 m between obstacles."},
     strip<ForceLaw::C1, Sides::Both, true>},
    {{"original",
      "Original strip",
      "The nearest obstacle point pushes (Eq. 7). Gets stuck head-on and enters the safety "
      "circle."},
     strip<ForceLaw::Original, Sides::Nearest, false>},
    {{"original_side",
      "Original strip with side choice",
      "As the original, and on a blocked line the strip chooses a side. Reaches the most goals, "
      "closest to obstacles."},
     strip<ForceLaw::Original, Sides::Nearest, true>},
    {{"modified_published",
      "Modified strip as published",
      "Both sides push by Eq. 13-14 as printed, limited at its pole."},
     strip<ForceLaw::Published, Sides::Both, false>},
    {{"modified_linear",
      "Modified strip, linear part",
      "Eq. 13-14 without the second branch: nothing pushes beyond the safety distance."},
     strip<ForceLaw::Linear, Sides::Both, false>},
    {{"modified_c1",
      "Modified strip, continuous",
      "Both sides push by a law without a jump, and no side is chosen. Gets stuck head-on."},
     strip<ForceLaw::C1, Sides::Both, false>},
    {{"via_kept",
      "Modified strip, via kept",
      "As the modified strip, and the via point of the tick before is pulled onto the line by "
      "K_c: the only one in which K_c acts."},
     strip<ForceLaw::C1, Sides::Both, true, true>},
    {{"strip",
      "Full elastic strip",
      "Many nodes on a map of the scans, laid anew by a planner where they break, and a velocity "
      "stage that proves every command before it is given. Our extension."},
     [] { return Made(std::make_unique<FullStripController>()); }},
    {{"strip_moving",
      "Full elastic strip among moving things",
      "As the full strip, and what moves is tracked in the scans; a search in space and time gives "
      "way to it. An experiment: of the moving obstacles it is measured on it still meets many."},
     [] { return Made(std::make_unique<FullStripController>(true)); }},
    {{"go_to_goal",
      "Straight to the goal",
      "Sees nothing and drives at the goal: what every other controller must do better than.",
      true},
     made<GoToGoal>},
    {{"edge_detection",
      "Edge detection",
      "Stops before an obstacle, looks for its edges and drives past one of them (as in Borenstein "
      "and Koren 1988)."},
     made<EdgeDetection>},
    {{"potential_field",
      "Potential field",
      "The goal pulls, each obstacle pushes from its nearest point (Khatib 1986). Comes to rest "
      "where they cancel.",
      true},
     made<PotentialField>},
    {{"certainty_grid",
      "Certainty grid with A*",
      "Maps what is surely empty or occupied (Moravec and Elfes 1985) and follows the least-cost "
      "path over the map.",
      true},
     made<CertaintyGridPlanner>},
    {{"vff",
      "Virtual force field",
      "Cells that returned readings push, the goal pulls (Borenstein and Koren 1989). Comes to "
      "rest where they cancel.",
      true},
     made<Vff>},
    {{"vfh",
      "Vector field histogram",
      "Steers through the free valley of a polar histogram nearest to the goal (Borenstein and "
      "Koren 1991).",
      true},
     made<Vfh>},
    {{"dwa",
      "Dynamic window",
      "Of the speeds it can reach and stop, takes the best by heading, clearance and speed (Fox, "
      "Burgard and Thrun 1997). Knows no way but the arc ahead."},
     made<Dwa>},
});

constexpr auto kTable = [] {
  std::array<ControllerInfo, kEntries.size()> table{};
  std::ranges::transform(kEntries, table.begin(), &Entry::about);
  return table;
}();

}  // namespace

std::span<const ControllerInfo> controller_table() {
  return kTable;
}

/// A via point that is kept follows pass' = end + F_ext + K_c (chord - pass): its error changes
/// sign at each tick and shrinks by the factor K_c, with K_c = 1 never.
std::optional<std::string> refusal(std::string_view name, const Parameters& parameters) {
  if (name != "via_kept" || parameters[Parameter::ContractionGain] < 1) return std::nullopt;
  return "k_c must be below 1 with the controller via_kept: at 1 its via point swings from side to "
         "side and never settles";
}

std::unique_ptr<Controller> make_controller(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.about.name == name) return entry.make();
  }
  std::string known;
  for (const ControllerInfo& each : kTable) {
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw std::invalid_argument("no controller is called '" + std::string(name) + "'; there are " +
                              known);
}

}  // namespace algo
