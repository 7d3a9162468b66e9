// tests/fuzz/block_roundtrip_fuzz.cpp: any frames and windows come back from a packed block.
//
// Input: frame after frame: length, window count, then per window gap and count, one byte
// each, then the frame's bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "db/block_codec.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> left(data, size);
  const auto next = [&]() -> std::uint8_t {
    if (left.empty()) return 0;
    const std::uint8_t byte = left.front();
    left = left.subspan(1);
    return byte;
  };
  db::BlockEncoder encoder;
  std::vector<std::span<const std::byte>> frames;
  while (!left.empty() && frames.size() < 200) {
    const std::size_t length = next();
    std::vector<db::Window> windows(next() % 8U);
    std::uint32_t at = 0;
    for (db::Window& window : windows) {
      window.offset = at + next();
      window.count = next();
      at = window.offset + static_cast<std::uint32_t>(window.bytes());
    }
    const auto frame = std::as_bytes(left.first(std::min(length, left.size())));
    left = left.subspan(frame.size());
    try {
      encoder.add(frame, windows);
      frames.push_back(frame);
    } catch (const db::CodecError&) {
      continue;  // windows that leave the frame
    }
  }
  if (frames.empty()) return 0;
  db::BlockDecoder decoder;
  decoder.decode(encoder.encode());
  if (decoder.frames() != frames.size()) std::abort();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!std::ranges::equal(decoder.frame(i), frames[i])) std::abort();
  }
  return 0;
}
