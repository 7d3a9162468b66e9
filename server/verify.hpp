// server/verify.hpp: a stored run fed back through a fresh pipeline must give the same commands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/run_reader.hpp"

namespace server {

struct Verification {
  std::uint64_t ticks = 0;
  /// First tick whose command, hold or mission differs, with both, as a sentence.
  std::optional<std::string> difference{};
};

/// Throws std::exception with a sentence when the run is not there or does not read.
Verification verify_run(db::RunReader& reader, db::RunId run);

}  // namespace server
