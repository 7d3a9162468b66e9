// server/record/filtered_scans.hpp: recomputes the scans that the controller of a stored run saw.
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

/// Neither frames nor record hold these scans. algo's own filter and merge recompute them from the
/// stored frames, with the parameters in force at each tick. If a run's first ticks are gone, the
/// parameters set in them are lost too.
class FilteredScans {
 public:
  /// Throws std::runtime_error if this program lacks a filter or parameter of the run.
  explicit FilteredScans(const db::RunRow& row);

  /// True if reading tick `from` of `row` need not start from the run's first tick.
  bool stands_before(const db::RunRow& row, std::uint64_t from) const {
    return row.id == run_ && row.what.started == started_ && next_ <= from;
  }

  /// Calls `visit` for up to `limit` frames from tick `from` on, with the message of
  /// FrameEncoder::encode(scan); empty if the frame brought no scan that looks ahead. Returns the
  /// tick to continue with. Continuing there costs nothing extra; going back reads the run from its
  /// start.
  using Visit = std::function<void(std::uint64_t tick, std::span<const std::byte> scan)>;
  std::optional<std::uint64_t> read(db::RunReader& reader,
                                    std::uint64_t from,
                                    std::size_t limit,
                                    const Visit& visit);

 private:
  void lead_up_to(db::RunReader& reader, std::uint64_t from);
  void take(std::span<const std::byte> frame);

  db::RunId run_ = 0;
  std::string started_{};  // distinguishes it from a run of the same number in another file
  algo::Parameters initial_{};
  algo::Parameters parameters_{};
  algo::Sensing sensing_;
  std::uint64_t next_ = 0;  // all ticks before it were taken
  bool fresh_ = false;      // the last frame brought a scan
  algo::Telemetry t_{};
  algo::LaserScan scan_{};
  FrameEncoder encoder_{};
};

}  // namespace server
