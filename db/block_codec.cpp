// db/block_codec.cpp: packs frames into a block.
#include "db/block_codec.hpp"

#include <algorithm>
#include <string>

#include "db/block_format.hpp"
#include "db/samples.hpp"

namespace db {

using namespace detail;

namespace {

constexpr std::size_t kReferenceReach = 48;  // earlier frames searched for one with the same layout

}  // namespace

std::shared_ptr<Compressor> make_compressor() {
  return std::make_shared<Compressor>();
}

BlockEncoder::BlockEncoder(std::shared_ptr<Compressor> compressor)
    : compressor_(compressor ? std::move(compressor) : make_compressor()) {}

void BlockEncoder::clear() {
  table_.clear();
  for (auto& stream : streams_) stream.clear();
  references_.clear();
  rest_.clear();
  rest_residuals_.clear();
  rest_starts_.assign(1, 0);
  newest_.clear();
}

bool BlockEncoder::fits(std::size_t bytes) const {
  return frames() < kMaxBlockFrames && bytes <= kMaxBlockBytes - table_.bytes.size();
}

void BlockEncoder::add(std::span<const std::byte> frame, std::span<const Window> windows) {
  if (!fits(frame.size())) {
    throw CodecError("a frame of " + std::to_string(frame.size()) +
                     " bytes does not fit into the block of " + std::to_string(frames()) +
                     " frames, " + std::to_string(bytes()) + " bytes");
  }
  if (const char* wrong = window_defect(windows, frame.size())) {
    throw CodecError("frame " + std::to_string(frames()) + " of the block: " + wrong);
  }
  table_.append(frame.size(), windows);
  copy_bytes(frame, table_.frame(frames() - 1));
}

std::size_t BlockEncoder::reference_of(std::size_t i) const {
  const auto windows = table_.windows_of(i);
  std::size_t best = 0;
  int best_score = 0;
  for (std::size_t distance = 1; distance <= std::min(i, kReferenceReach); ++distance) {
    const auto earlier = table_.windows_of(i - distance);
    int score = 0;
    if (std::ranges::equal(windows, earlier)) {
      score = table_.entries[i].size == table_.entries[i - distance].size ? 3 : 2;
    } else if (std::ranges::equal(windows, earlier, {}, &Window::count, &Window::count)) {
      score = 1;
    }
    if (score > best_score) {
      best = distance;
      best_score = score;
    }
    if (score == 3) break;
  }
  return best;
}

void BlockEncoder::encode_frame(std::size_t i) {
  const std::size_t distance = reference_of(i);
  references_.push_back(distance);
  const auto frame = table_.frame(i);
  const auto windows = table_.windows_of(i);

  auto& layout = streams_[kLayout];
  put_varint(layout, frame.size());
  put_varint(layout, distance);
  const bool as_reference =
      distance > 0 && std::ranges::equal(windows, table_.windows_of(i - distance));
  put_varint(layout, as_reference ? 0 : windows.size() + 1);
  if (!as_reference) {
    for (const Window& window : windows) put_window(layout, window);
  }

  std::size_t done = 0;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const Window& window = windows[k];
    append_bytes(rest_, frame.subspan(done, window.offset - done));
    done = window.offset + window.bytes();
    const auto here = frame.subspan(window.offset, window.bytes());
    const Choice choice = write_samples(here, newest_.get(table_, k, here.size()), streams_);
    newest_.set(k, table_.entries[i].offset + window.offset, here.size());
    layout.push_back(static_cast<std::uint8_t>(choice));
  }
  append_bytes(rest_, frame.subspan(done));
  rest_starts_.push_back(rest_.size());
  predict_rest(i);
}

/// Appends the residuals of the newest frame `i` outside its windows, relative to its reference.
void BlockEncoder::predict_rest(std::size_t i) {
  const std::size_t start = rest_starts_[i];
  rest_residuals_.insert(
      rest_residuals_.end(), rest_.begin() + static_cast<std::ptrdiff_t>(start), rest_.end());
  if (references_[i] == 0) return;
  const std::size_t from = i - references_[i];
  const std::size_t shared =
      std::min(rest_.size() - start, rest_starts_[from + 1] - rest_starts_[from]);
  std::uint8_t* const here = rest_residuals_.data() + start;
  const std::uint8_t* const there = rest_.data() + rest_starts_[from];
  for (std::size_t k = 0; k < shared; ++k) {
    here[k] = static_cast<std::uint8_t>(here[k] - there[k]);
  }
}

void BlockEncoder::write_rest() {
  streams_[kRest].resize(rest_.size());
  std::uint8_t* next = streams_[kRest].data();
  const std::uint8_t* const residuals = rest_residuals_.data();
  const std::size_t* const starts = rest_starts_.data();
  rest_order_.set(rest_starts_);
  rest_order_.walk([&](std::size_t i, std::size_t k) { *next++ = residuals[starts[i] + k]; });
}

std::span<const std::byte> BlockEncoder::encode() {
  if (frames() == 0) throw CodecError("a block without frames cannot be packed");
  for (std::size_t i = references_.size(); i < frames(); ++i) encode_frame(i);
  write_rest();

  packed_.clear();
  put_header(packed_, {.frames = frames(), .bytes = bytes(), .check = check_of(table_)});
  for (const auto& stream : streams_) compressor_->append(packed_, stream);
  return packed_;
}

}  // namespace db
