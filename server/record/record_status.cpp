// server/record/record_status.cpp: the record's state as a document.
#include "server/record/record_status.hpp"

#include <array>
#include <string_view>

namespace server {

namespace {
constexpr std::array<std::string_view, 5> kNames = {"off", "recording", "paused", "full", "failed"};
}

nlohmann::json to_json(const RecordStatus& status) {
  nlohmann::json out = {{"status", kNames[static_cast<std::size_t>(status.kind)]},
                        {"sentence", status.sentence},
                        {"kept_from", status.kept_from},
                        {"bytes", status.bytes},
                        {"limit", status.limit},
                        {"deleted", nullptr}};
  if (!status.deleted.empty()) out["deleted"] = status.deleted;
  return out;
}

}  // namespace server
