// tests/fuzz/frame_fuzz.cpp: any bytes are a telemetry frame or refused; our own frames encode
// again to the same bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "server/record/frame_codec.hpp"

namespace {

std::vector<std::byte> write(const algo::Telemetry& t) {
  server::FrameEncoder encoder;
  const auto bytes = encoder.encode(t);
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> write_again(const std::vector<std::byte>& bytes) {
  algo::Telemetry t;
  server::decode_frame(bytes, t);
  return write(t);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  algo::Telemetry t;
  try {
    server::decode_frame(std::as_bytes(std::span(data, size)), t);
  } catch (const server::WireError&) {
    return 0;
  }
  // A foreign frame may hold forces without a strip, which ours leave out: so compare from the
  // second encoding on.
  const std::vector<std::byte> second = write_again(write(t));
  if (write_again(second) != second) std::abort();
  return 0;
}
