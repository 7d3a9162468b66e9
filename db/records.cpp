// db/records.cpp: the names of a run's states.
#include "db/records.hpp"

#include <array>

namespace db {

namespace {
constexpr std::array<std::string_view, 6> kStatusNames = {
    "queued", "recording", "finished", "interrupted", "cancelled", "failed"};
}

std::string_view to_string(RunStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

std::optional<RunStatus> find_status(std::string_view name) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (kStatusNames[i] == name) return static_cast<RunStatus>(i);
  }
  return std::nullopt;
}

}  // namespace db
