// algo/controller.cpp: the table of controllers: the readings of the elastic strip.
#include "algo/controller.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "algo/elastic_strip_controller.hpp"
#include "algo/full_strip/full_strip_controller.hpp"

namespace algo {
namespace {

constexpr std::size_t kReadingCount = 7;
constexpr std::size_t kCount = kReadingCount + 1;

constexpr std::array<ControllerInfo, kCount> kTable{{
    {"modified",
     "Modified strip with side choice",
     "Both sides push, without a jump, and on a blocked line the strip chooses a side. Keeps the "
     "most clearance; needs about 2 m between obstacles."},
    {"original",
     "Original strip",
     "The nearest obstacle point pushes (Eq. 7). Gets stuck head-on and enters the safety circle."},
    {"original_side",
     "Original strip with side choice",
     "As the original, and on a blocked line the strip chooses a side. Reaches the most goals, "
     "closest to obstacles."},
    {"modified_published",
     "Modified strip as published",
     "Both sides push by Eq. 13-14 as printed, limited at its pole."},
    {"modified_linear",
     "Modified strip, linear part",
     "Eq. 13-14 without the second branch: nothing pushes beyond the safety distance."},
    {"modified_c1",
     "Modified strip, continuous",
     "Both sides push by a law without a jump, and no side is chosen. Gets stuck head-on."},
    {"via_kept",
     "Modified strip, via kept",
     "As the modified strip, and the via point of the tick before is pulled onto the line by "
     "K_c: the only one in which K_c acts."},
    {"strip",
     "Full elastic strip",
     "Many nodes on a map of the scans, laid anew by a planner where they break, and a velocity "
     "stage that proves every command before it is given. Our extension."},
}};

constexpr std::array<StripReading, kReadingCount> kReadings{{
    {ForceLaw::C1, Sides::Both, true, false},
    {ForceLaw::Original, Sides::Nearest, false, false},
    {ForceLaw::Original, Sides::Nearest, true, false},
    {ForceLaw::Published, Sides::Both, false, false},
    {ForceLaw::Linear, Sides::Both, false, false},
    {ForceLaw::C1, Sides::Both, false, false},
    {ForceLaw::C1, Sides::Both, true, true},
}};

}  // namespace

std::span<const ControllerInfo> controller_table() {
  return kTable;
}

std::unique_ptr<Controller> make_controller(std::string_view name) {
  if (name == "strip") return std::make_unique<FullStripController>();
  for (std::size_t i = 0; i < kReadingCount; ++i) {
    if (kTable[i].name == name) return std::make_unique<ElasticStripController>(kReadings[i]);
  }
  std::string known;
  for (const ControllerInfo& each : kTable) {
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw std::invalid_argument("no controller is called '" + std::string(name) + "'; there are " +
                              known);
}

}  // namespace algo
