// tests/fuzz/p2os_fuzz.cpp: any bytes, in any pieces, are packets or skipped; a packet is a state,
// an answer or refused.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/p2os_protocol.hpp"

namespace {

using namespace drivers;
using namespace drivers::p2os;

void decode(ByteView body, Odometer& odometer, Handshake& handshake) {
  State state;
  if (decode_state(body, state)) {
    odometer.update(state);
    if (!std::isfinite(odometer.pose().x) || state.sonar_count > State::kSonars) std::abort();
  }
  handshake.receive(body);
}

std::uint64_t read(ByteView bytes, std::size_t piece) {
  PacketReader reader;
  Odometer odometer;
  Handshake handshake;
  const auto on_packet = [&](ByteView packet) { decode(body_of(packet), odometer, handshake); };
  const auto on_stray = [](std::uint8_t) {};
  for (ByteView rest = bytes; !rest.empty();) {
    const std::size_t size = std::min(piece, rest.size());
    reader.feed(rest.first(size), on_packet, on_stray);
    rest = rest.subspan(size);
  }
  reader.expire(on_packet, on_stray);
  if (reader.pending() != 0) std::abort();
  return reader.counters().frames;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  if (read(bytes, size + 1) != read(bytes, 7)) std::abort();
  // The input as a body too, since mutation rarely gives a right check value.
  Odometer odometer;
  Handshake handshake;
  decode(bytes.first(std::min(size, kLongestBody)), odometer, handshake);
  return 0;
}
