// db/records.cpp: the names of a run's states; the rounding of its columns.
#include "db/records.hpp"

#include <array>
#include <cmath>

namespace db {

namespace {
constexpr std::array<std::string_view, 6> kStatusNames = {
    "queued", "recording", "finished", "interrupted", "cancelled", "failed"};

// As in the view `tick` of db/schema.cpp.
constexpr double kTimeScale = 1e4;
constexpr double kScale = 1e5;
constexpr std::array kColumns = {
    &TickRow::x, &TickRow::y, &TickRow::heading, &TickRow::v, &TickRow::omega, &TickRow::clearance};
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

TickRow scaled(const TickRow& row) {
  TickRow whole = row;
  whole.t = std::round(row.t * kTimeScale);
  for (double TickRow::*column : kColumns) whole.*column = std::round(row.*column * kScale);
  return whole;
}

TickRow rounded(const TickRow& row) {
  TickRow back = scaled(row);
  back.t /= kTimeScale;
  for (double TickRow::*column : kColumns) back.*column /= kScale;
  return back;
}

}  // namespace db
