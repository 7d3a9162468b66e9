// server/record/record_status.hpp: state of the live run's record, for people.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace server {

enum class RecordKind : std::uint8_t {
  Off,        // this server keeps no record
  Recording,  // every tick is kept
  Paused,     // nothing happens; the next request resumes it
  Full,       // the store is full of finished runs, which are not deleted without permission
  Failed,     // the store cannot be written now; recording resumes by itself
};

struct RecordStatus {
  RecordKind kind = RecordKind::Off;
  std::string sentence{};   // explains `kind` in this case
  double kept_from = 0;     // [s] run clock of the live run's oldest tick in the record
  std::uint64_t bytes = 0;  // size of the store in use, with its log
  std::uint64_t limit = 0;  // [bytes]; 0: no limit
  std::string deleted{};    // what was deleted to make room, as a sentence; empty: nothing
  bool operator==(const RecordStatus&) const = default;
};

/// The field `record` of `/state`.
nlohmann::json to_json(const RecordStatus& status);

}  // namespace server
