// db/block_codec.hpp: lossless packing of a block of recorded frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace db {

/// A frame cannot be packed or a block cannot be read; what() is a sentence.
class CodecError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of a frame that holds little-endian samples of 16 bits with similar neighbours: the
/// ranges of a scan. A window never changes what is stored: a frame packed without windows, or with
/// wrong ones, only takes more room.
struct Window {
  std::uint32_t offset = 0;  // [bytes] from the start of the frame
  std::uint32_t count = 0;   // samples
  std::size_t bytes() const { return std::size_t{count} * sizeof(std::uint16_t); }
  bool operator==(const Window&) const = default;
};

constexpr std::size_t kMaxBlockFrames = 1024;
constexpr std::size_t kMaxFrameWindows = 64;
constexpr std::size_t kMaxBlockBytes = std::size_t{16} << 20;  // [bytes] of all frames, unpacked

namespace detail {

/// Frames end to end with their windows. Its buffers survive clear().
struct FrameTable {
  struct Entry {
    std::size_t offset = 0;  // into bytes
    std::size_t size = 0;
    std::size_t first_window = 0;  // into windows
    std::size_t window_count = 0;
  };
  std::vector<std::byte> bytes{};
  std::vector<Window> windows{};
  std::vector<Entry> entries{};

  void clear();
  /// Adds a frame of `size` bytes, to be filled in by the caller.
  void append(std::size_t size, std::span<const Window> frame_windows);
  std::span<const std::byte> frame(std::size_t i) const {
    return std::span(bytes).subspan(entries[i].offset, entries[i].size);
  }
  std::span<std::byte> frame(std::size_t i) {
    return std::span(bytes).subspan(entries[i].offset, entries[i].size);
  }
  std::span<const Window> windows_of(std::size_t i) const {
    return std::span(windows).subspan(entries[i].first_window, entries[i].window_count);
  }
};

/// The newest window at each place in a frame, by ordinal, from which the next one there is
/// predicted. Keeps its buffer.
class NewestSamples {
 public:
  void clear() { found_.clear(); }
  /// Empty if there is none of `bytes` [bytes].
  std::span<const std::byte> get(const FrameTable& table,
                                 std::size_t ordinal,
                                 std::size_t bytes) const;
  void set(std::size_t ordinal, std::size_t offset, std::size_t bytes);

 private:
  struct Place {
    std::size_t offset = 0;  // into FrameTable::bytes
    std::size_t bytes = 0;
  };
  std::vector<Place> found_{};
};

/// The block's values sorted by kind, so that each compressor call gets one kind of number.
constexpr std::size_t kLayout = 0;  // sizes, references, windows, choices
constexpr std::size_t kLow = 1;     // low bytes of the sample residuals
constexpr std::size_t kHigh = 2;    // their high bytes
constexpr std::size_t kRest = 3;    // all bytes outside the windows, in the order of RestOrder
constexpr std::size_t kStreams = 4;
using Streams = std::array<std::vector<std::uint8_t>, kStreams>;

/// The order of the bytes outside the windows. Frames of one length are stored together, as they
/// mostly hold the same fields; within them by position and then by frame. Keeps its buffer.
class RestOrder {
 public:
  /// `starts` of each frame's bytes, and the end of the last; must outlive walk().
  void set(std::span<const std::size_t> starts);
  /// Calls `visit(frame, position)` for every byte.
  template <typename Visit>
  void walk(const Visit& visit) const {
    for (const Group& group : groups_) {
      const std::span frames = std::span(frames_).subspan(group.first, group.end - group.first);
      for (std::size_t k = 0; k < group.length; ++k) {
        for (const std::size_t frame : frames) visit(frame, k);
      }
    }
  }

 private:
  struct Group {
    std::size_t first = 0;  // into frames_
    std::size_t end = 0;
    std::size_t length = 0;  // [bytes] of each of its frames
  };
  std::size_t size(std::size_t frame) const { return starts_[frame + 1] - starts_[frame]; }

  std::span<const std::size_t> starts_{};
  std::vector<std::size_t> frames_{};
  std::vector<Group> groups_{};
};

class Cursor;
struct Compressor;    // a zstd context and its output buffer
struct Decompressor;  // likewise, for unpacking

}  // namespace detail

std::shared_ptr<detail::Compressor> make_compressor();

/// Collects frames and packs them. Not thread-safe. Allocates nothing once its buffers have grown.
///
/// Samples are predicted in the better of two ways: from their left neighbour, or from it and the
/// newest window of the same size at their place. All other bytes are predicted from an earlier
/// frame of the block with the same layout (its reference). zstd compresses the residuals stream by
/// stream; a stream that it does not shrink is stored as it is.
class BlockEncoder {
 public:
  /// `compressor`: shared by the encoders of one thread, since it is large; null: makes its own.
  explicit BlockEncoder(std::shared_ptr<detail::Compressor> compressor = {});

  /// Appends a copy of the frame. Windows must be in order of offset and not overlap.
  /// Throws CodecError when a window extends beyond the frame or the block is full (see fits()).
  void add(std::span<const std::byte> frame, std::span<const Window> windows);
  /// True when a frame of `bytes` still fits into this block.
  bool fits(std::size_t bytes) const;

  std::size_t frames() const { return table_.entries.size(); }
  std::size_t bytes() const { return table_.bytes.size(); }  // unpacked
  void clear();

  /// The packed block, valid until the next call. Keeps the frames: more may be added and the
  /// longer block packed anew, without processing the earlier frames again. Throws CodecError when
  /// there are no frames.
  std::span<const std::byte> encode();

 private:
  void encode_frame(std::size_t i);
  std::size_t reference_of(std::size_t i) const;
  void predict_rest(std::size_t i);
  void write_rest();

  detail::FrameTable table_{};
  detail::Streams streams_{};
  detail::NewestSamples newest_{};
  std::vector<std::size_t> references_{};  // distance back to each frame's reference; 0: none
  std::vector<std::uint8_t> rest_{};       // the frames without their windows, end to end
  std::vector<std::uint8_t> rest_residuals_{};
  std::vector<std::size_t> rest_starts_{0};  // of each frame, and the end of the last
  detail::RestOrder rest_order_{};
  std::vector<std::byte> packed_{};
  std::shared_ptr<detail::Compressor> compressor_;
};

/// Unpacks blocks. Not thread-safe.
class BlockDecoder {
 public:
  BlockDecoder();

  /// Unpacks `block`. Its frames are readable until the next call. Throws CodecError for any bytes
  /// that are not a block this program can read. Never gives frames that differ from those packed
  /// (a 64-bit check value guards them). Uses at most a small multiple of kMaxBlockBytes of memory.
  void decode(std::span<const std::byte> block);

  std::size_t frames() const { return table_.entries.size(); }
  std::span<const std::byte> frame(std::size_t i) const { return table_.frame(i); }
  std::span<const Window> windows(std::size_t i) const { return table_.windows_of(i); }

 private:
  void read_layout(std::size_t frames, std::size_t bytes);
  void read_frame_layout(detail::Cursor& layout, std::size_t bytes_left);
  void read_choice(detail::Cursor& layout);
  void check_sizes() const;
  void read_rest();
  void fill_frames();

  detail::FrameTable table_{};
  detail::Streams streams_{};
  std::vector<std::size_t> references_{};
  detail::NewestSamples newest_{};
  std::vector<std::uint8_t> choices_{};  // detail::Choice of each window
  std::vector<std::uint8_t> rest_{};
  std::vector<std::size_t> rest_starts_{};
  detail::RestOrder rest_order_{};
  std::shared_ptr<detail::Decompressor> decompressor_;  // shared_ptr, for an incomplete type
};

}  // namespace db
