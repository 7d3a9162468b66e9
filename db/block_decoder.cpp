// db/block_decoder.cpp: unpacks a block. Checks every value before it is used.
#include <algorithm>
#include <cstring>
#include <string>

#include "db/block_codec.hpp"
#include "db/block_format.hpp"
#include "db/samples.hpp"

namespace db {

using namespace detail;

BlockDecoder::BlockDecoder() : decompressor_(std::make_shared<Decompressor>()) {}

void BlockDecoder::decode(std::span<const std::byte> block) {
  table_.clear();
  try {
    Cursor cursor(block);
    const Header header = read_header(cursor);
    for (auto& stream : streams_) read_stream(cursor, *decompressor_, stream);
    if (!cursor.at_end()) throw CodecError("the block is followed by other bytes");
    read_layout(header.frames, header.bytes);
    check_sizes();
    read_rest();
    fill_frames();
    if (check_of(table_) != header.check) {
      throw CodecError("the block's frames do not match its check value");
    }
  } catch (...) {
    table_.clear();
    throw;
  }
}

void BlockDecoder::read_layout(std::size_t frames, std::size_t bytes) {
  references_.clear();
  choices_.clear();
  rest_starts_.assign(1, 0);
  Cursor layout(std::as_bytes(std::span(streams_[kLayout])));
  for (std::size_t i = 0; i < frames; ++i) {
    read_frame_layout(layout, bytes - table_.bytes.size());
  }
  if (!layout.at_end() || table_.bytes.size() != bytes) {
    throw CodecError("the block's layout does not match its header");
  }
}

void BlockDecoder::read_frame_layout(Cursor& layout, std::size_t bytes_left) {
  const std::size_t i = table_.entries.size();
  const std::size_t size = layout.varint();
  if (size > bytes_left) throw CodecError("the block's frames are longer than it says");
  const std::size_t distance = layout.varint();
  if (distance > i) throw CodecError("a frame of the block refers to one before its start");
  references_.push_back(distance);

  std::array<Window, kMaxFrameWindows> windows{};
  const std::size_t listed = layout.varint();
  std::size_t count = 0;
  if (listed == 0) {
    if (distance == 0) throw CodecError("a frame of the block takes its windows from none");
    const auto reference = table_.windows_of(i - distance);
    count = reference.size();
    std::ranges::copy(reference, windows.begin());
  } else {
    count = listed - 1;
    if (count > kMaxFrameWindows) throw CodecError("a frame of the block has too many windows");
    for (std::size_t k = 0; k < count; ++k) windows[k] = layout.window();
  }
  const std::span<const Window> used(windows.data(), count);
  if (const char* wrong = window_defect(used, size)) {
    throw CodecError(std::string("a frame of the block is damaged: ") + wrong);
  }
  std::size_t in_windows = 0;
  for (std::size_t k = 0; k < count; ++k) {
    read_choice(layout);
    in_windows += used[k].bytes();
  }
  rest_starts_.push_back(rest_starts_.back() + size - in_windows);
  table_.append(size, used);
}

/// Reads how a window is predicted.
void BlockDecoder::read_choice(Cursor& layout) {
  const std::uint8_t choice = layout.byte();
  if (choice > static_cast<std::uint8_t>(Choice::Reference)) {
    throw CodecError("a window of the block is predicted in an unknown way");
  }
  choices_.push_back(choice);
}

void BlockDecoder::check_sizes() const {
  std::size_t samples = 0;
  for (const Window& window : table_.windows) samples += window.count;
  if (streams_[kLow].size() != samples || streams_[kHigh].size() != samples ||
      streams_[kRest].size() != rest_starts_.back()) {
    throw CodecError("the block's streams do not match its layout");
  }
}

void BlockDecoder::read_rest() {
  rest_.resize(rest_starts_.back());
  rest_order_.set(rest_starts_);
  const std::uint8_t* next = streams_[kRest].data();
  std::uint8_t* const bytes = rest_.data();
  const std::size_t* const starts = rest_starts_.data();
  rest_order_.walk([&](std::size_t i, std::size_t k) { bytes[starts[i] + k] = *next++; });
  // A reference is an earlier frame, so it is already complete.
  const auto bytes_of_frame = [&](std::size_t i) {
    return std::span(rest_).subspan(rest_starts_[i], rest_starts_[i + 1] - rest_starts_[i]);
  };
  for (std::size_t i = 0; i < references_.size(); ++i) {
    if (references_[i] == 0) continue;
    const auto here = bytes_of_frame(i);
    const auto there = bytes_of_frame(i - references_[i]);
    for (std::size_t k = 0; k < std::min(here.size(), there.size()); ++k) {
      here[k] = static_cast<std::uint8_t>(here[k] + there[k]);
    }
  }
}

void BlockDecoder::fill_frames() {
  std::size_t window = 0;
  std::size_t sample = 0;
  newest_.clear();
  for (std::size_t i = 0; i < table_.entries.size(); ++i) {
    const auto frame = table_.frame(i);
    const auto windows = table_.windows_of(i);
    const auto rest = std::as_bytes(std::span(rest_)).subspan(rest_starts_[i]);
    std::size_t done = 0;
    std::size_t taken = 0;
    const auto copy_rest = [&](std::size_t until) {
      copy_bytes(rest.subspan(taken, until - done), frame.subspan(done, until - done));
      taken += until - done;
    };
    for (std::size_t k = 0; k < windows.size(); ++k, ++window) {
      copy_rest(windows[k].offset);
      const auto here = frame.subspan(windows[k].offset, windows[k].bytes());
      const bool referred = static_cast<Choice>(choices_[window]) == Choice::Reference;
      const auto there = newest_.get(table_, k, referred ? here.size() : 0);
      if (there.empty() && referred && !here.empty()) {
        throw CodecError("a window of the block refers to another kind of window");
      }
      read_samples(here, there, streams_, sample);
      newest_.set(k, table_.entries[i].offset + windows[k].offset, here.size());
      done = windows[k].offset + here.size();
    }
    copy_rest(frame.size());
  }
}

}  // namespace db
