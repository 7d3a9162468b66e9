// algo/arm_spec.cpp: the names of the links.
#include "algo/arm_spec.hpp"

namespace algo {

std::string_view name(BodyLink link) {
  constexpr std::array<std::string_view, kBodyLinks> kNames{
      "base", "mast", "upper_arm", "forearm", "hand"};
  return kNames[static_cast<std::size_t>(link)];
}

std::string_view words(BodyLink link) {
  return link == BodyLink::UpperArm ? "upper arm" : name(link);
}

}  // namespace algo
