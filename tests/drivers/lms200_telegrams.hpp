// tests/drivers/lms200_telegrams.hpp: whole scans as the device sends them, and a reader that keeps
// the telegrams.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "tests/drivers/hex.hpp"

#include "drivers/lms200_telegram.hpp"

namespace drivers::lms200 {

inline Bytes framed(std::uint8_t address, const Bytes& payload) {
  FixedBytes<kLongestLength + kFrameBytes> frame;
  append_frame(frame, address, payload);
  return bytes_of(frame.view());
}

/// An answer with values; `count_word` has their count and flags.
inline Bytes scan_frame(unsigned count_word,
                        const std::vector<unsigned>& words,
                        const Bytes& indices = {}) {
  Bytes payload{0xB0};
  const auto put = [&payload](unsigned word) {
    payload.push_back(static_cast<std::uint8_t>(word & 0xFFU));
    payload.push_back(static_cast<std::uint8_t>(word >> 8U));
  };
  put(count_word);
  for (const unsigned word : words) put(word);
  append(payload, indices);
  payload.push_back(0x10);
  return framed(0x80, payload);
}

/// 361 values of 1000 + i mm.
inline Bytes scan_361() {
  std::vector<unsigned> words;
  for (unsigned i = 0; i < 361; ++i) words.push_back(1000 + i);
  return scan_frame(0x4169, words);
}

/// 181 values of 2000 mm.
inline Bytes scan_181() {
  return scan_frame(0x40B5, std::vector<unsigned>(181, 2000));
}

/// Reads all of `bytes`, in pieces of `piece` bytes, and keeps copies.
struct Kept {
  explicit Kept(Sender sender = Sender::Device) : reader(Framing{sender}) {}
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  void feed(ByteView bytes, std::size_t piece = 4096) {
    while (!bytes.empty()) {
      const std::size_t size = std::min(piece, bytes.size());
      reader.feed(bytes.first(size), keep_frame_, keep_stray_);
      bytes = bytes.subspan(size);
    }
  }
  void expire() { reader.expire(keep_frame_, keep_stray_); }

  std::vector<Bytes> frames{};
  Bytes strays{};
  TelegramReader reader;

 private:
  std::function<void(ByteView)> keep_frame_ = [this](ByteView frame) {
    frames.push_back(bytes_of(frame));
  };
  std::function<void(std::uint8_t)> keep_stray_ = [this](std::uint8_t byte) {
    strays.push_back(byte);
  };
};

}  // namespace drivers::lms200
