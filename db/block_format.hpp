// db/block_format.hpp: the outer format of a packed block, shared by encoder and decoder.
//
// Little-endian: "TB", version, 0; u32 frames; u32 bytes of all frames; u64 check; then the streams
// in the order of detail::kLayout .., each u32 raw size, u32 stored size, bytes. A stream is stored
// as it is if both sizes are equal, else as one zstd frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <zstd.h>

#include "db/block_codec.hpp"

namespace db::detail {

constexpr std::uint8_t kFormatVersion = 5;

struct Header {
  std::size_t frames = 0;
  std::size_t bytes = 0;
  std::uint64_t check = 0;
};

/// Owns the compressor's state, so that packing many blocks allocates nothing.
struct Compressor {
  Compressor();

  /// Appends `stream` with its sizes, compressed if that makes it smaller.
  void append(std::vector<std::byte>& out, std::span<const std::uint8_t> stream);

  std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context{ZSTD_createCCtx(), ZSTD_freeCCtx};
  std::vector<std::byte> buffer{};
};

struct Decompressor {
  Decompressor();

  std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context{ZSTD_createDCtx(), ZSTD_freeDCtx};
};

/// The defect of `windows` in a frame of `frame_bytes`, or nullptr.
const char* window_defect(std::span<const Window> windows, std::size_t frame_bytes);

/// 64-bit check value over the frames and their offsets.
std::uint64_t check_of(const FrameTable& table);

void put_header(std::vector<std::byte>& out, const Header& header);
void put_varint(std::vector<std::uint8_t>& out, std::size_t value);
void put_window(std::vector<std::uint8_t>& out, const Window& window);
/// Copies all of `from` to `to`, which has the same length.
void copy_bytes(std::span<const std::byte> from, std::span<std::byte> to);
void append_bytes(std::vector<std::uint8_t>& out, std::span<const std::byte> bytes);

/// Reads the output of put_*. Throws CodecError instead of reading past the end.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::span<const std::byte> take(std::size_t count);
  std::uint8_t byte();
  std::uint32_t u32();
  std::uint64_t u64();
  std::size_t varint();  // at most 2^32 - 1
  Window window();
  bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

/// Throws CodecError if `cursor` is not at a block of our format, or if the block is too large.
Header read_header(Cursor& cursor);

/// Reads the next stream into `out`, which never grows beyond kMaxBlockBytes.
void read_stream(Cursor& cursor, const Decompressor& zstd, std::vector<std::uint8_t>& out);

}  // namespace db::detail
