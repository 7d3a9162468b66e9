// server/serve/foxglove/schemas.cpp: looks up a schema; the texts are in a generated file.
#include "server/serve/foxglove/schemas.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace server::foxglove {

const Schema& schema(std::string_view name) {
  const std::span<const Schema> all = schemas();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Schema& s) { return s.name == name; });
  if (found == all.end()) throw std::out_of_range("no schema named " + std::string(name));
  return *found;
}

}  // namespace server::foxglove
