// tests/fuzz/roboteq_fuzz.cpp: any bytes are lines or skipped; a line is a reply or is ignored.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/roboteq_protocol.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace drivers;
  roboteq::LineReader reader;
  roboteq::State state;
  reader.feed(ByteView(data, size), [&state](std::string_view line) {
    const roboteq::Reply reply = roboteq::parse_reply(line);
    if (line.empty() || reply.count > roboteq::Reply::kValues) std::abort();
    if (roboteq::update(state, reply) && reply.kind != roboteq::Reply::Kind::Values) std::abort();
  });
  roboteq::fault_text(state.faults.value_or(0));
  return 0;
}
