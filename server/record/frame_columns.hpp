// server/record/frame_columns.hpp: the single values of a frame beyond the columns of a tick, as
// columns of the CSV.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "algo/telemetry.hpp"

namespace server {

struct FrameColumn {
  std::string_view name{};
  std::string_view unit{};  // "" for words, counts and flags
  /// Appends the value of `t`; nothing if it has none.
  void (*put)(std::string& out, const algo::Telemetry& t) = nullptr;
};
/// All columns, the same for every run. Flags are 0 or 1.
std::span<const FrameColumn> frame_columns();

}  // namespace server
