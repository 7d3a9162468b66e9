// server/record/filtered_scans.hpp: the scans that the controller of a stored run saw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "algo/pipeline/sensing.hpp"
#include "db/run_reader.hpp"
#include "server/record/frame_codec.hpp"

namespace server {

/// They are in neither frame nor record: algo's own filter and merge make them anew from the stored
/// frames, with the parameters in force at each tick. Of a run whose first ticks are gone, so are
/// the parameters that were set in them.
class FilteredScans {
 public:
  /// Throws std::runtime_error when the run used a filter or parameter that this program has not.
  explicit FilteredScans(const db::RunRow& row);

  /// Whether it can go on with tick `from` of `row` without reading the run from its start.
  bool stands_before(const db::RunRow& row, std::uint64_t from) const {
    return row.id == run_ && row.what.started == started_ && next_ <= from;
  }

  /// A message of FrameEncoder::encode(scan) for each frame of up to `limit` from tick `from` on;
  /// empty where the frame brought no scan that looks ahead. Returns the tick to go on with. Going
  /// on from there costs nothing more; going back reads the run from its start again.
  using Visit = std::function<void(std::uint64_t tick, std::span<const std::byte> scan)>;
  std::optional<std::uint64_t> read(db::RunReader& reader,
                                    std::uint64_t from,
                                    std::size_t limit,
                                    const Visit& visit);

 private:
  void lead_up_to(db::RunReader& reader, std::uint64_t from);
  void take(std::span<const std::byte> frame);

  db::RunId run_ = 0;
  std::string started_{};  // tells it from a run of that number in another file
  algo::Parameters initial_{};
  algo::Parameters parameters_{};
  algo::Sensing sensing_;
  std::uint64_t next_ = 0;  // tick before which everything was taken
  bool fresh_ = false;      // the last frame brought a scan
  algo::Telemetry t_{};
  algo::LaserScan scan_{};
  FrameEncoder encoder_{};
};

}  // namespace server
