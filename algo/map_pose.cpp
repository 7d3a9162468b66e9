// algo/map_pose.cpp: the words of a fix.
#include "algo/map_pose.hpp"

#include <array>
#include <cstddef>

namespace algo {
namespace {

struct FixWords {
  std::string_view name{};
  std::string_view sentence{};
};
constexpr std::array<FixWords, 5> kFixes{
    {{"searching", "It looks for its place on the map."},
     {"nowhere", "Its scan fits nowhere on the map: give its pose, or drive it by hand."},
     {"not_unique",
      "Several places on the map look like this one: give its pose, or drive it by hand."},
     {"unsure",
      "Its scans fit the map too badly to be sure of its place: give its pose, or drive it by "
      "hand."},
     {"located", "It knows its place on the map."}}};

}  // namespace

std::string_view name(MapFix fix) {
  return kFixes.at(static_cast<std::size_t>(fix)).name;
}

std::string_view sentence(MapFix fix) {
  return kFixes.at(static_cast<std::size_t>(fix)).sentence;
}

}  // namespace algo
