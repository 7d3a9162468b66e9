// server/record/verify.hpp: a stored run fed back through a fresh pipeline must give the same
// commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/run_reader.hpp"

namespace server {

struct Verification {
  std::uint64_t ticks = 0;     // read
  std::uint64_t compared = 0;  // of them, those whose commands were computed again
  /// First tick whose command, hold or mission differs, with both, or whose row of columns is not
  /// what its frame says, as a sentence.
  std::optional<std::string> difference{};
  /// Why that is not the whole run, as a sentence.
  std::optional<std::string> incomplete{};
};

/// Throws std::exception with a sentence when the run is not there or does not read.
Verification verify_run(db::RunReader& reader, db::RunId run);

/// Why a record of which `ticks` were read is not the whole run: a gap by fault, a beginning that
/// went for newer ticks, a cut, or its deletion meanwhile. `row`: as it was before reading. A pause
/// of the record is none of these.
std::optional<std::string> incompleteness(db::RunReader& reader,
                                          const db::RunRow& row,
                                          std::uint64_t ticks);

}  // namespace server
