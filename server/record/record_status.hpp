// server/record/record_status.hpp: how the record of the live run is doing, for people.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace server {

enum class RecordKind : std::uint8_t {
  Off,        // this server keeps no record
  Recording,  // every tick is kept
  Paused,     // nothing happens; the next request goes on with it
  Full,       // the store is full of finished runs, which are never deleted unasked
  Failed,     // the store cannot be written just now; recording resumes by itself
};

struct RecordStatus {
  RecordKind kind = RecordKind::Off;
  std::string sentence{};   // what `kind` means here and now
  double kept_from = 0;     // [s] run clock of the oldest tick kept of the live run
  std::uint64_t bytes = 0;  // of the store in use, its log included
  std::uint64_t limit = 0;  // [bytes]; 0: none
  std::string deleted{};    // what went for room, as a sentence; empty: nothing
  bool operator==(const RecordStatus&) const = default;
};

/// As `record` in `/state`.
nlohmann::json to_json(const RecordStatus& status);

}  // namespace server
