// tests/db/frames.hpp: made-up frames of the size and kind the recorder stores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "db/block_codec.hpp"

namespace test {

struct Frame {
  std::vector<std::byte> bytes{};
  std::vector<db::Window> windows{};
};

/// 361 beams towards an approaching wall, +-15 mm noise, a few free beams; smoothly changing
/// doubles, a strip of `nodes` nodes and a sentence.
class FrameMaker {
 public:
  explicit FrameMaker(std::uint64_t seed, std::size_t nodes = 50) : random_(seed), nodes_(nodes) {}

  Frame next() {
    Frame frame{};
    const double t = 0.026 * static_cast<double>(tick_);
    put(frame, tick_);
    for (const double value : {t, 0.4 * t, 0.1 * t, 0.01 * t, 0.5, 0.02}) put(frame, value);
    // Every fortieth tick comes without a new scan, as with a real scanner.
    if (tick_ % 40 != 39) put_scan(frame, 8.0 - 0.01 * t);
    put_strip(frame, static_cast<float>(0.4 * t));
    const std::string why = "An obstacle " + std::to_string(1.5 + 0.01 * uniform()) + " m ahead.";
    for (const char c : why) frame.bytes.push_back(static_cast<std::byte>(c));
    ++tick_;
    return frame;
  }

 private:
  template <typename T>
  static void put(Frame& frame, T value) {
    std::array<std::byte, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    frame.bytes.insert(frame.bytes.end(), raw.begin(), raw.end());
  }
  double uniform() { return 2.0 * static_cast<double>(random_() >> 11U) * 0x1p-53 - 1.0; }

  void put_scan(Frame& frame, double distance) {
    frame.windows.push_back(
        {.offset = static_cast<std::uint32_t>(frame.bytes.size()), .count = 361});
    for (int i = 0; i < 361; ++i) {
      const bool free = random_() % 500 == 0;
      const double mm = 1000.0 * distance + 5.0 * i + 15.0 * uniform();
      put(frame, static_cast<std::uint16_t>(free ? 65535 : static_cast<int>(mm)));
    }
  }
  void put_strip(Frame& frame, float x) {
    if (nodes_ == 0) return;
    const auto bend = static_cast<float>(0.015 * uniform());
    for (std::size_t i = 0; i < nodes_; ++i) {
      const float q = static_cast<float>(i) / static_cast<float>(nodes_);
      for (const float value : {x + (4 - x) * q, bend + (3 - bend) * q}) {
        put(frame, static_cast<std::int16_t>(static_cast<int>(1024 * value)));
      }
    }
  }

  std::mt19937_64 random_;
  std::size_t nodes_ = 0;
  std::uint64_t tick_ = 0;
};

}  // namespace test
