// db/block_format.cpp: headers, variable-length numbers and zstd streams of a packed block.
#include "db/block_format.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <string>

namespace db::detail {

namespace {

// The residuals are noise: level 1 packs them as well as level 9 (296 against 295 bytes a scan) in
// a fifth of the time.
constexpr int kZstdLevel = 1;

template <typename T>
void put(std::vector<std::byte>& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(value >> (8U * i))));
  }
}

template <typename T>
T take_number(Cursor& cursor) {
  T value = 0;
  const auto bytes = cursor.take(sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value |= static_cast<T>(static_cast<T>(std::to_integer<std::uint8_t>(bytes[i])) << (8U * i));
  }
  return value;
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15ULL;
  return hash ^ (hash >> 29U);
}

}  // namespace

void FrameTable::clear() {
  bytes.clear();
  windows.clear();
  entries.clear();
}

void FrameTable::append(std::size_t size, std::span<const Window> frame_windows) {
  entries.push_back({bytes.size(), size, windows.size(), frame_windows.size()});
  bytes.resize(bytes.size() + size);
  windows.insert(windows.end(), frame_windows.begin(), frame_windows.end());
}

std::span<const std::byte> NewestSamples::get(const FrameTable& table,
                                              std::size_t ordinal,
                                              std::size_t bytes) const {
  if (ordinal >= found_.size() || found_[ordinal].bytes != bytes) return {};
  return std::span(table.bytes).subspan(found_[ordinal].offset, bytes);
}

void NewestSamples::set(std::size_t ordinal, std::size_t offset, std::size_t bytes) {
  if (ordinal >= found_.size()) found_.resize(ordinal + 1);
  found_[ordinal] = {offset, bytes};
}

void RestOrder::set(std::span<const std::size_t> starts) {
  starts_ = starts;
  frames_.resize(starts.size() - 1);
  for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i] = i;
  groups_.clear();
  // By length, then by number: equals a stable sort, but without its allocation.
  std::ranges::sort(frames_, [&](std::size_t a, std::size_t b) {
    return size(a) != size(b) ? size(a) < size(b) : a < b;
  });
  for (std::size_t j = 0; j < frames_.size(); ++j) {
    const std::size_t length = size(frames_[j]);
    if (groups_.empty() || groups_.back().length != length) groups_.push_back({j, j, length});
    groups_.back().end = j + 1;
  }
}

Compressor::Compressor() {
  if (context == nullptr) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kZstdLevel);
}

Decompressor::Decompressor() {
  if (context == nullptr) throw std::bad_alloc();
}

void Compressor::append(std::vector<std::byte>& out, std::span<const std::uint8_t> stream) {
  buffer.resize(ZSTD_compressBound(stream.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), buffer.data(), buffer.size(), stream.data(), stream.size());
  const bool pays = ZSTD_isError(size) == 0 && size < stream.size();
  put(out, static_cast<std::uint32_t>(stream.size()));
  put(out, static_cast<std::uint32_t>(pays ? size : stream.size()));
  if (pays) {
    out.insert(out.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
  } else {
    const auto bytes = std::as_bytes(stream);
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
}

const char* window_defect(std::span<const Window> windows, std::size_t frame_bytes) {
  if (windows.size() > kMaxFrameWindows) return "it has more than 64 windows";
  std::size_t done = 0;
  for (const Window& window : windows) {
    if (window.offset < done) return "its windows overlap or are out of order";
    done = window.offset + window.bytes();
    if (done > frame_bytes) return "a window reaches beyond the frame's end";
  }
  return nullptr;
}

std::uint64_t check_of(const FrameTable& table) {
  std::uint64_t hash = 0x7461757420212121ULL;
  for (const FrameTable::Entry& entry : table.entries) hash = mix(hash, entry.size);
  const std::size_t whole = table.bytes.size() / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, table.bytes.data() + i, 8);
    hash = mix(hash, word);
  }
  for (std::size_t i = whole; i < table.bytes.size(); ++i) {
    hash = mix(hash, std::to_integer<std::uint64_t>(table.bytes[i]));
  }
  return hash;
}

void put_header(std::vector<std::byte>& out, const Header& header) {
  for (const std::uint8_t byte :
       {std::uint8_t{'T'}, std::uint8_t{'B'}, kFormatVersion, std::uint8_t{0}}) {
    out.push_back(static_cast<std::byte>(byte));
  }
  put(out, static_cast<std::uint32_t>(header.frames));
  put(out, static_cast<std::uint32_t>(header.bytes));
  put(out, header.check);
}

void put_varint(std::vector<std::uint8_t>& out, std::size_t value) {
  while (value >= 0x80U) {
    out.push_back(static_cast<std::uint8_t>((value & 0x7FU) | 0x80U));
    value >>= 7U;
  }
  out.push_back(static_cast<std::uint8_t>(value));
}

void put_window(std::vector<std::uint8_t>& out, const Window& window) {
  put_varint(out, window.offset);
  put_varint(out, window.count);
}

// Not std::ranges::copy(): g++ 12 turns it into a copy byte by byte.
void copy_bytes(std::span<const std::byte> from, std::span<std::byte> to) {
  if (!from.empty()) std::memcpy(to.data(), from.data(), from.size());
}

void append_bytes(std::vector<std::uint8_t>& out, std::span<const std::byte> bytes) {
  const std::size_t before = out.size();
  out.resize(before + bytes.size());
  if (!bytes.empty()) std::memcpy(out.data() + before, bytes.data(), bytes.size());
}

std::span<const std::byte> Cursor::take(std::size_t count) {
  if (count > bytes_.size()) throw CodecError("the block is cut off");
  const auto taken = bytes_.first(count);
  bytes_ = bytes_.subspan(count);
  return taken;
}

std::uint8_t Cursor::byte() {
  return std::to_integer<std::uint8_t>(take(1)[0]);
}
std::uint32_t Cursor::u32() {
  return take_number<std::uint32_t>(*this);
}
std::uint64_t Cursor::u64() {
  return take_number<std::uint64_t>(*this);
}

std::size_t Cursor::varint() {
  std::size_t value = 0;
  for (unsigned shift = 0; shift < 35; shift += 7) {
    const std::uint8_t next = byte();
    value |= std::size_t{next & 0x7FU} << shift;
    if ((next & 0x80U) == 0 && value <= std::numeric_limits<std::uint32_t>::max()) return value;
  }
  throw CodecError("the block holds a number that is too large");
}

Window Cursor::window() {
  Window window{};
  window.offset = static_cast<std::uint32_t>(varint());
  window.count = static_cast<std::uint32_t>(varint());
  return window;
}

Header read_header(Cursor& cursor) {
  if (cursor.byte() != 'T' || cursor.byte() != 'B') throw CodecError("these bytes are not a block");
  const std::uint8_t version = cursor.byte();
  if (version != kFormatVersion) {
    throw CodecError("the block has format " + std::to_string(version) +
                     ", this program reads format " + std::to_string(kFormatVersion));
  }
  if (cursor.byte() != 0) throw CodecError("the block's header is damaged");
  Header header{};
  header.frames = cursor.u32();
  header.bytes = cursor.u32();
  header.check = cursor.u64();
  if (header.frames == 0 || header.frames > kMaxBlockFrames || header.bytes > kMaxBlockBytes) {
    throw CodecError("the block claims " + std::to_string(header.frames) + " frames and " +
                     std::to_string(header.bytes) + " bytes, beyond what a block holds");
  }
  return header;
}

void read_stream(Cursor& cursor, const Decompressor& zstd, std::vector<std::uint8_t>& out) {
  const std::size_t raw = cursor.u32();
  const std::size_t stored = cursor.u32();
  if (raw > kMaxBlockBytes || stored > raw) throw CodecError("a stream of the block is damaged");
  const auto bytes = cursor.take(stored);
  out.clear();
  if (stored == raw) {
    append_bytes(out, bytes);
    return;
  }
  // A forged size must not cost memory before zstd confirms it.
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != raw) {
    throw CodecError("a stream of the block is damaged");
  }
  out.resize(raw);
  if (ZSTD_decompressDCtx(zstd.context.get(), out.data(), raw, bytes.data(), bytes.size()) != raw) {
    throw CodecError("a stream of the block is damaged");
  }
}

}  // namespace db::detail
