// db/records.cpp: the names of a run's states and gaps.
#include "db/records.hpp"

#include <array>

namespace db {

namespace {
constexpr std::array<std::string_view, 6> kStatusNames = {
    "queued", "recording", "finished", "interrupted", "cancelled", "failed"};
constexpr std::array<std::string_view, 5> kCauseNames = {
    "pause", "behind", "failed", "full", "dropped"};
}  // namespace

std::string_view to_string(RunStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

std::optional<RunStatus> find_status(std::string_view name) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (kStatusNames[i] == name) return static_cast<RunStatus>(i);
  }
  return std::nullopt;
}

std::string_view to_string(GapCause cause) {
  return kCauseNames[static_cast<std::size_t>(cause)];
}

std::optional<GapCause> find_cause(std::string_view name) {
  for (std::size_t i = 0; i < kCauseNames.size(); ++i) {
    if (kCauseNames[i] == name) return static_cast<GapCause>(i);
  }
  return std::nullopt;
}

}  // namespace db
