// server/record/verify.hpp: replays a stored run through a fresh pipeline, which must give the same
// commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/run_reader.hpp"

namespace server {

struct Verification {
  std::uint64_t ticks = 0;     // read
  std::uint64_t compared = 0;  // read ticks whose commands were computed again
  /// The first tick whose command, hold or mission differs, with both values, or whose row of
  /// columns does not match its frame; as a sentence.
  std::optional<std::string> difference{};
  /// Why the ticks read are not the whole run, as a sentence.
  std::optional<std::string> incomplete{};
};

/// Throws std::exception with a sentence if the run does not exist or cannot be read.
Verification verify_run(db::RunReader& reader, db::RunId run);

/// Why a record of which `ticks` were read is not the whole run: a gap caused by a fault, early
/// ticks dropped for newer ones, a cut, or deletion during the reading. A pause of the record does
/// not count. `row`: the row before reading.
std::optional<std::string> incompleteness(db::RunReader& reader,
                                          const db::RunRow& row,
                                          std::uint64_t ticks);

}  // namespace server
