// drivers/frame_reader.hpp: finds the frames in a byte stream that may be damaged.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/bytes.hpp"

namespace drivers {

/// Counts since the reader was made.
struct LineCounters {
  std::uint64_t frames = 0;         // intact
  std::uint64_t bad_checks = 0;     // complete, with a wrong check value
  std::uint64_t skipped_bytes = 0;  // outside intact frames
  std::uint64_t given_up = 0;       // begun but never completed
  bool operator==(const LineCounters&) const = default;
};

/// Whether the first bytes of a buffer may begin a frame.
struct FrameStart {
  enum class Kind : std::uint8_t { Nothing, TooShortToTell, Frame };
  Kind kind = Kind::Nothing;
  std::size_t size = 0;  // of a frame, in bytes, from its start mark to its check value
};

/// Cuts a stream into frames. `Framing` says what a frame is:
///   kLongest                      bytes of the longest frame
///   FrameStart start(ByteView)    of bytes, at least one, that may begin a frame
///   bool intact(ByteView)         whether a complete frame has the right check value
///
/// A start mark may occur within data, and the next frame may cut one off. So after a failure the
/// reader rescans from the byte after the mark: only the damaged frame is lost. Allocates nothing.
/// Not thread-safe.
template <class Framing>
class FrameReader {
 public:
  explicit FrameReader(Framing framing = {}) : framing_(framing) {}

  /// Calls `on_frame(ByteView)` for each intact frame, and `on_stray(std::uint8_t)` for each byte
  /// outside of all frames, intact or broken, in order of arrival.
  template <class OnFrame, class OnStray>
  void feed(ByteView bytes, OnFrame&& on_frame, OnStray&& on_stray) {
    while (!bytes.empty()) {
      const std::size_t room = std::min(bytes.size(), buffer_.size() - end_);
      std::copy_n(bytes.begin(), room, buffer_.begin() + static_cast<std::ptrdiff_t>(end_));
      end_ += room;
      bytes = bytes.subspan(room);
      read(on_frame, on_stray);
      compact();
    }
  }

  /// Call after a silence so long that the frame begun will not be completed: rescans its bytes for
  /// other frames.
  template <class OnFrame, class OnStray>
  void expire(OnFrame&& on_frame, OnStray&& on_stray) {
    while (begin_ < end_) {
      ++counters_.given_up;
      debris_end_ = end_;
      skip(on_stray);
      read(on_frame, on_stray);
    }
    compact();
  }

  /// Drops all buffered bytes, as after a change of the rate.
  void clear() { begin_ = end_ = debris_end_ = 0; }

  /// Bytes of the frame begun; 0 without one.
  std::size_t pending() const { return end_ - begin_; }
  const LineCounters& counters() const { return counters_; }

 private:
  template <class OnFrame, class OnStray>
  void read(OnFrame& on_frame, OnStray& on_stray) {
    while (begin_ < end_) {
      const ByteView waiting = ByteView(buffer_).subspan(begin_, end_ - begin_);
      const FrameStart start = framing_.start(waiting);
      if (start.kind == FrameStart::Kind::Nothing) {
        skip(on_stray);
        continue;
      }
      if (start.kind == FrameStart::Kind::TooShortToTell || waiting.size() < start.size) return;
      const ByteView frame = waiting.first(start.size);
      if (framing_.intact(frame)) {
        ++counters_.frames;
        begin_ += frame.size();
        on_frame(frame);
      } else {
        ++counters_.bad_checks;
        debris_end_ = std::max(debris_end_, begin_ + frame.size());
        skip(on_stray);
      }
    }
  }

  template <class OnStray>
  void skip(OnStray& on_stray) {
    ++counters_.skipped_bytes;
    const std::uint8_t byte = buffer_[begin_];
    const bool stray = begin_ >= debris_end_;
    ++begin_;
    if (stray) on_stray(byte);
  }

  /// Moves the unread bytes, always less than one frame, to the front.
  void compact() {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
              buffer_.begin());
    debris_end_ -= std::min(debris_end_, begin_);
    end_ -= begin_;
    begin_ = 0;
  }

  Framing framing_;
  std::array<std::uint8_t, 2 * Framing::kLongest> buffer_{};
  std::size_t begin_ = 0;       // of the unread bytes
  std::size_t end_ = 0;         // of all bytes in the buffer
  std::size_t debris_end_ = 0;  // up to here bytes may belong to a broken frame
  LineCounters counters_{};
};

}  // namespace drivers
