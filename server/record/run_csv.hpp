// server/record/run_csv.hpp: a stored run as CSV: a line a tick, a column a value of each channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algo/observation.hpp"
#include "db/run_reader.hpp"

namespace server {

class RunCsv {
 public:
  /// `run` with its document.
  explicit RunCsv(const db::RunRow& run);

  /// The first line, with its end. Channels come last, as "NAME" or "NAME[0]", "NAME[1]".
  std::string header() const;
  /// Appends up to `limit` lines from tick `from` on to `out`; every number in its shortest exact
  /// form, and no cell where a tick has no reading. Returns the tick to go on with, or nothing
  /// after the last. Throws db::StoreError.
  std::optional<std::uint64_t> lines(db::RunReader& reader,
                                     std::uint64_t from,
                                     std::size_t limit,
                                     std::string& out) const;

 private:
  db::RunId run_ = 0;
  std::vector<algo::ChannelInfo> channels_{};
};

}  // namespace server
