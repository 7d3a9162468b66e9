// tests/fuzz/map_file_fuzz.cpp: any description with any picture is a map with a wall, or a
// sentence. The picture follows a line of dashes.
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "server/run/map_file.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  constexpr const char* kBorder = "\n-----\n";
  const std::size_t border = text.find(kBorder);
  const std::string picture =
      border == std::string::npos ? "" : text.substr(border + std::string(kBorder).size());
  try {
    const algo::OccupancyMap map = server::map_from(
        text.substr(0, border), "map.yaml", [&](const std::string&) { return picture; });
    bool any = false;
    map.each_cell([&](const auto&, const auto& tally) { any = any || tally.occupied(); });
    if (!any) std::abort();
  } catch (const std::runtime_error& error) {
    if (std::string(error.what()).empty()) std::abort();
  }
  return 0;
}
