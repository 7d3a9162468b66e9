// server/record/run_csv.hpp: a stored run as CSV: one line per tick, one column per value of each
// channel.
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
  /// `run` must have its document.
  explicit RunCsv(const db::RunRow& run);

  /// The first line, with its line end. Channels come last, as "NAME" or "NAME[0]", "NAME[1]".
  std::string header() const;
  /// Appends up to `limit` lines from tick `from` on to `out`. Each number has its shortest exact
  /// form; a missing reading leaves its cell empty. Returns the tick to continue with, or nothing
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
