// server/record/run_csv.hpp: a stored run as CSV: one line per tick, one column for each value of
// its frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/observation.hpp"
#include "algo/telemetry.hpp"
#include "db/run_reader.hpp"
#include "server/record/arm_columns.hpp"
#include "server/record/frame_measures.hpp"
#include "server/record/scan_slots.hpp"

namespace server {

struct CsvOptions {
  bool units = false;   // "t [s]" in the header rather than "t"
  bool arrays = false;  // also the scans, laser and infrared, and the obstacles that move
};

/// The columns, in this order: those of a tick; the channels of the robot, "NAME" or "NAME[0]",
/// "NAME[1]", or "channel.NAME" if another column has the name; those of a frame; "sonar[0]" and
/// "bumper[0]" in the order of their first readings; the commanded rates of the joints; the arm's;
/// the controller's measures; the arrays.
class RunCsv {
 public:
  /// `run` must have its document. Reads the whole run once, up to a damaged block, to learn which
  /// columns it has. A column that only later ticks of a growing run bring is left out.
  RunCsv(db::RunReader& reader, const db::RunRow& run, CsvOptions options = {});

  /// The first line, with its line end.
  std::string header() const;
  /// Appends up to `limit` lines from tick `from` on to `out`. Each number has its shortest exact
  /// form; a value that the frame does not bring leaves its cell empty. Returns the tick to
  /// continue with, or nothing after the last. Throws db::StoreError.
  std::optional<std::uint64_t> lines(db::RunReader& reader,
                                     std::uint64_t from,
                                     std::size_t limit,
                                     std::string& out) const;

 private:
  using Mounts = std::vector<algo::Pose2>;  // of a ring's sensors

  void learn(const algo::Telemetry& t);
  /// Whether a column other than the channels' has this name.
  bool has_column(std::string_view name) const;
  std::span<const FrameColumn> own_arm() const;
  std::span<const FrameColumn> own_map() const;
  void put_rings(std::string& out, const algo::Observation& o) const;
  void put_arrays(std::string& out, const algo::Telemetry& t) const;

  db::RunId run_ = 0;
  CsvOptions options_{};
  std::vector<algo::ChannelInfo> channels_{};
  Mounts sonar_{}, bumpers_{};
  ScanSlots scanners_{};
  bool infrared_ = false;
  std::size_t joints_ = 0;
  bool arm_ = false;
  bool map_ = false;  // the robot knows a map
  FrameMeasures measures_{};
};

}  // namespace server
