// server/record/filtered_scans.cpp: the first steps of the pipeline over stored frames.
#include "server/record/filtered_scans.hpp"

#include <algorithm>
#include <variant>

#include "server/record/run_json.hpp"

namespace server {
namespace {

constexpr std::uint64_t kAtOnce = 1000;  // frames

}  // namespace

FilteredScans::FilteredScans(const db::RunRow& row)
    : run_(row.id),
      started_(row.what.started),
      initial_(stored_parameters(row)),
      parameters_(initial_),
      sensing_(stored_filter(row)) {}

void FilteredScans::take(std::span<const std::byte> frame) {
  decode_frame(frame, t_);
  for (const algo::Request& request : t_.requests) {
    const auto* set = std::get_if<algo::SetParameter>(&request);
    if (set != nullptr) parameters_.set(*set->parameter, set->value);
  }
  fresh_ = sensing_.take(t_.observation, parameters_, scan_) != nullptr;
  next_ = t_.tick + 1;
}

/// Reads every tick before `from`: parameters and echoes carry over from tick to tick.
void FilteredScans::lead_up_to(db::RunReader& reader, std::uint64_t from) {
  if (from < next_) {
    parameters_ = initial_;
    sensing_.reset();
    next_ = 0;
  }
  std::optional<std::uint64_t> next = next_;
  while (next && *next < from) {
    const auto limit = static_cast<std::size_t>(std::min(from - *next, kAtOnce));
    next = reader.frames(
        run_, *next, limit, [&](std::uint64_t tick, std::span<const std::byte> frame) {
          if (tick < from) take(frame);
        });
  }
}

std::optional<std::uint64_t> FilteredScans::read(db::RunReader& reader,
                                                 std::uint64_t from,
                                                 std::size_t limit,
                                                 const Visit& visit) {
  lead_up_to(reader, from);
  return reader.frames(
      run_, from, limit, [&](std::uint64_t tick, std::span<const std::byte> frame) {
        take(frame);
        visit(tick, fresh_ ? encoder_.encode(scan_) : std::span<const std::byte>{});
      });
}

}  // namespace server
