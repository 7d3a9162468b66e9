// tests/fuzz/block_decode_fuzz.cpp: any bytes decode as a block or are refused; a decoded block
// packs again to the same frames.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "db/block_codec.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  db::BlockDecoder decoder;
  try {
    decoder.decode(std::as_bytes(std::span(data, size)));
  } catch (const db::CodecError&) {
    return 0;
  }
  db::BlockEncoder encoder;
  for (std::size_t i = 0; i < decoder.frames(); ++i) {
    encoder.add(decoder.frame(i), decoder.windows(i));
  }
  db::BlockDecoder again;
  again.decode(encoder.encode());
  if (again.frames() != decoder.frames()) std::abort();
  for (std::size_t i = 0; i < again.frames(); ++i) {
    if (!std::ranges::equal(again.frame(i), decoder.frame(i))) std::abort();
  }
  return 0;
}
