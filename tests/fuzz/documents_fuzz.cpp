// tests/fuzz/documents_fuzz.cpp: any text is a scenario, a request, both or neither; a valid
// scenario gives the same document after writing and reading.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/request_json.hpp"
#include "server/run/scenario_json.hpp"

namespace {

void read_scenario(const nlohmann::json& document) {
  nlohmann::json first;
  try {
    first = server::to_json(server::scenario_from_json(document));
  } catch (const server::DocumentError&) {
    return;
  }
  // An accepted document must be accepted again: a throw here is a finding.
  const nlohmann::json second = server::to_json(server::scenario_from_json(first));
  const nlohmann::json third = server::to_json(server::scenario_from_json(second));
  if (server::dump_json(second) != server::dump_json(third)) std::abort();
}

void read_request(const nlohmann::json& document) {
  try {
    server::request_from_json(document);
  } catch (const server::DocumentError&) {
    return;
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nlohmann::json document;
  try {
    document = server::parse_json({reinterpret_cast<const char*>(data), size});
  } catch (const server::JsonError&) {
    return 0;
  }
  read_scenario(document);
  read_request(document);
  return 0;
}
