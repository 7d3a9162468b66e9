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

/// A stretch of a frame that holds little-endian samples of 16 bits, neighbours alike: the ranges
/// of a scan. A window never changes what is stored: a frame packed without windows, or with the
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

/// Frames laid end to end with their windows; its buffers survive clear().
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
  /// A further frame of `size` bytes, which are to be filled in.
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

/// The newest window at each place in a frame, by its ordinal: the next one there is predicted from
/// it. Keeps its buffer.
class NewestSamples {
 public:
  void clear() { found_.clear(); }
  /// Empty when there is none of `bytes` [bytes].
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

/// The block's values sorted by kind, so that each compressor call sees one sort of number.
constexpr std::size_t kLayout = 0;  // sizes, references, windows, choices
constexpr std::size_t kLow = 1;     // low bytes of the sample residuals
constexpr std::size_t kHigh = 2;    // their high bytes
constexpr std::size_t kRest = 3;    // all outside the windows, in the order of RestOrder
constexpr std::size_t kStreams = 4;
using Streams = std::array<std::vector<std::uint8_t>, kStreams>;

/// In which order the bytes outside the windows are stored: frames of one length together, as they
/// mostly hold the same fields; of those by position and then by frame. Keeps its buffer.
class RestOrder {
 public:
  /// `starts` of each frame's bytes, and their end; they must outlive walk().
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
struct Decompressor;  // the same for unpacking

}  // namespace detail

std::shared_ptr<detail::Compressor> make_compressor();

/// Collects frames and packs them. Not thread-safe; allocates nothing once its buffers have grown.
///
/// Samples are predicted from their left neighbour, or from that and the newest window of the same
/// size at their place: of the two the way that leaves less. All else is predicted byte by byte
/// from an earlier frame of the block laid out alike (its reference). The residuals go through zstd
/// stream by stream, and are stored as they are where zstd does not pay.
class BlockEncoder {
 public:
  /// `compressor`: shared by encoders of one thread, as it is large; null: one of its own.
  explicit BlockEncoder(std::shared_ptr<detail::Compressor> compressor = {});

  /// Appends a copy of the frame. Windows are in order of offset and do not overlap.
  /// Throws CodecError when a window leaves the frame or the block is full (see fits()).
  void add(std::span<const std::byte> frame, std::span<const Window> windows);
  /// True when a frame of `bytes` still fits into this block.
  bool fits(std::size_t bytes) const;

  std::size_t frames() const { return table_.entries.size(); }
  std::size_t bytes() const { return table_.bytes.size(); }  // unpacked
  void clear();

  /// The packed block, valid until the next call. The frames stay: more may be added and the
  /// longer block packed anew, for which these are not looked at again. Throws CodecError when
  /// there is none.
  std::span<const std::byte> encode();

 private:
  void encode_frame(std::size_t i);
  std::size_t reference_of(std::size_t i) const;
  void predict_rest(std::size_t i);
  void write_rest();

  detail::FrameTable table_{};
  detail::Streams streams_{};
  detail::NewestSamples newest_{};
  std::vector<std::size_t> references_{};  // distance back to each frame's reference; 0 = none
  std::vector<std::uint8_t> rest_{};       // the frames without their windows, end to end
  std::vector<std::uint8_t> rest_residuals_{};
  std::vector<std::size_t> rest_starts_{0};  // of each frame, and the end
  detail::RestOrder rest_order_{};
  std::vector<std::byte> packed_{};
  std::shared_ptr<detail::Compressor> compressor_;
};

/// Unpacks blocks. Not thread-safe.
class BlockDecoder {
 public:
  BlockDecoder();

  /// Unpacks `block`; its frames stay readable until the next call. Throws CodecError when the
  /// bytes are not a block this program can read, whatever they are, and never gives out frames
  /// that differ from those packed (a 64-bit check value guards them). Takes at most a small
  /// multiple of kMaxBlockBytes of memory.
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
  std::shared_ptr<detail::Decompressor> decompressor_;  // whose type need not be known here
};

}  // namespace db
