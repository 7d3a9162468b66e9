// db/records.cpp: the names of run states, run kinds and gap causes.
#include "db/records.hpp"

#include <algorithm>
#include <array>

namespace db {

namespace {
constexpr std::array<std::string_view, 6> kStatusNames = {
    "queued", "recording", "finished", "interrupted", "cancelled", "failed"};
constexpr std::array<std::string_view, 5> kCauseNames = {
    "pause", "behind", "failed", "full", "dropped"};
constexpr std::array<std::string_view, 2> kKindNames = {"session", "background"};
/// The enumerator with that name.
template <typename Enum, std::size_t N>
std::optional<Enum> find(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto* const found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}
}  // namespace

std::string_view to_string(RunStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

std::optional<RunStatus> find_status(std::string_view name) {
  return find<RunStatus>(kStatusNames, name);
}

std::string_view to_string(RunKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::optional<RunKind> find_kind(std::string_view name) {
  return find<RunKind>(kKindNames, name);
}

std::string_view to_string(GapCause cause) {
  return kCauseNames[static_cast<std::size_t>(cause)];
}

std::optional<GapCause> find_cause(std::string_view name) {
  return find<GapCause>(kCauseNames, name);
}

}  // namespace db
