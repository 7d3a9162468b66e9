// db/block_decoder.cpp: unpacking a block. Nothing read from it is believed before it is checked.
#include <algorithm>
#include <cstring>
#include <string>

#include "db/block_codec.hpp"
#include "db/block_format.hpp"
#include "db/residuals.hpp"
#include "db/turned_scan.hpp"

namespace db {

using namespace detail;

namespace {

std::size_t bytes_of(const Window& window) {
  return std::size_t{window.count} * (window.kind == Window::Kind::Samples ? 2U : 4U);
}

/// Positions in the window streams, moved on as windows are read.
struct Position {
  std::size_t sample = 0;
  std::size_t number = 0;
};

void read_window(std::span<std::byte> window,
                 std::span<const std::byte> reference,
                 const Window& shape,
                 const std::array<std::uint8_t, 3>& how,
                 TurnedScan& turned,
                 const Streams& streams,
                 Position& at) {
  const auto choice = static_cast<Choice>(how[0]);
  if (shape.kind == Window::Kind::Samples) {
    std::span<const std::uint16_t> expected{};
    if (choice == Choice::Reference) {
      turned.set_reference(reference);
      expected = turned.expect({how[1], how[2]});
    }
    for (std::size_t i = 0; i < shape.count; ++i, ++at.sample) {
      const unsigned folded = streams[kLow][at.sample] | (streams[kHigh][at.sample] * 256U);
      const unsigned before = choice == Choice::Reference ? expected[i] : left_of(window, i);
      store(window,
            i,
            static_cast<std::uint16_t>(unfold16(static_cast<std::uint16_t>(folded)) + before));
    }
    return;
  }
  for (std::size_t field = 0; field < shape.stride; ++field) {
    for (std::size_t i = field; i < shape.count; i += shape.stride, ++at.number) {
      std::uint32_t folded = 0;
      for (std::size_t byte = 0; byte < 4; ++byte) {
        folded |= std::uint32_t{streams[kFloat0 + byte][at.number]} << (8U * byte);
      }
      store(
          window, i, unfold32(folded) + expected_float(window, reference, i, shape.stride, choice));
    }
  }
}

}  // namespace

BlockDecoder::BlockDecoder() : turned_(new TurnedScan), decompressor_(new Decompressor) {}

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
    const std::uint8_t choice = layout.byte();
    if (choice > static_cast<std::uint8_t>(Choice::Reference) || (choice != 0 && distance == 0)) {
      throw CodecError("a window of the block is predicted in an unknown way");
    }
    choices_.push_back({choice, kNotTurned, kNotTurned});
    if (choice != 0 && used[k].kind == Window::Kind::Samples) {
      for (std::size_t parity = 1; parity <= 2; ++parity) {
        choices_.back()[parity] = layout.byte();
        if (choices_.back()[parity] > kMostTurned) {
          throw CodecError("a window of the block is turned too far");
        }
      }
    }
    in_windows += bytes_of(used[k]);
  }
  rest_starts_.push_back(rest_starts_.back() + size - in_windows);
  table_.append(size, used);
}

void BlockDecoder::check_sizes() const {
  std::size_t samples = 0;
  std::size_t numbers = 0;
  for (const Window& window : table_.windows) {
    (window.kind == Window::Kind::Samples ? samples : numbers) += window.count;
  }
  const bool floats_fit = std::all_of(streams_.begin() + kFloat0,
                                      streams_.begin() + kFloat0 + 4,
                                      [&](const auto& s) { return s.size() == numbers; });
  if (streams_[kLow].size() != samples || streams_[kHigh].size() != samples || !floats_fit ||
      streams_[kRest].size() != rest_starts_.back()) {
    throw CodecError("the block's streams do not match its layout");
  }
  // A window predicted from its reference needs one there of the same form.
  std::size_t at = 0;
  for (std::size_t i = 0; i < table_.entries.size(); ++i) {
    const auto windows = table_.windows_of(i);
    const auto reference = table_.windows_of(i - references_[i]);
    for (std::size_t k = 0; k < windows.size(); ++k, ++at) {
      if (choices_[at][0] == 0) continue;
      if (k >= reference.size() || reference[k].kind != windows[k].kind ||
          reference[k].count != windows[k].count || reference[k].stride != windows[k].stride) {
        throw CodecError("a window of the block refers to another kind of window");
      }
    }
  }
}

void BlockDecoder::read_rest() {
  const auto start = [&](std::size_t i) { return rest_starts_[i]; };
  const auto size = [&](std::size_t i) { return rest_starts_[i + 1] - rest_starts_[i]; };
  const std::size_t frames = table_.entries.size();
  std::size_t longest = 0;
  for (std::size_t i = 0; i < frames; ++i) longest = std::max(longest, size(i));
  rest_.resize(rest_starts_.back());
  const std::uint8_t* next = streams_[kRest].data();
  for (std::size_t k = 0; k < longest; ++k) {
    for (std::size_t i = 0; i < frames; ++i) {
      if (k >= size(i)) continue;
      const std::size_t from = i - references_[i];
      const bool predicted = references_[i] != 0 && k < size(from);
      const unsigned before = predicted ? rest_[start(from) + k] : 0U;
      rest_[start(i) + k] = static_cast<std::uint8_t>(*next++ + before);
    }
  }
}

void BlockDecoder::fill_frames() {
  Position at{};
  std::size_t choice = 0;
  for (std::size_t i = 0; i < table_.entries.size(); ++i) {
    const auto frame = table_.frame(i);
    const auto windows = table_.windows_of(i);
    const auto reference = table_.frame(i - references_[i]);
    const auto reference_windows = table_.windows_of(i - references_[i]);
    const auto rest = std::as_bytes(std::span(rest_)).subspan(rest_starts_[i]);
    std::size_t done = 0;
    std::size_t taken = 0;
    const auto copy_rest = [&](std::size_t until) {
      std::ranges::copy(rest.subspan(taken, until - done),
                        frame.begin() + static_cast<std::ptrdiff_t>(done));
      taken += until - done;
    };
    for (std::size_t k = 0; k < windows.size(); ++k, ++choice) {
      copy_rest(windows[k].offset);
      const auto& how = choices_[choice];
      const auto here = frame.subspan(windows[k].offset, bytes_of(windows[k]));
      const auto there = how[0] == static_cast<std::uint8_t>(Choice::Reference)
                             ? reference.subspan(reference_windows[k].offset, here.size())
                             : std::span<const std::byte>{};
      read_window(here, there, windows[k], how, *turned_, streams_, at);
      done = windows[k].offset + here.size();
    }
    copy_rest(frame.size());
  }
}

}  // namespace db
