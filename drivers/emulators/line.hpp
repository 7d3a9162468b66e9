// drivers/emulators/line.hpp: a serial line as the device at its end knows it: every byte takes its
// time, and some do not arrive as they were sent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <random>
#include <vector>

#include "drivers/bytes.hpp"

namespace drivers::emulators {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What happens to bytes on their way, both ways, each a probability.
struct LineFaults {
  double drop = 0;    // of a byte: lost
  double flip = 0;    // of a byte: one bit turned over
  double damage = 0;  // of a telegram: one byte of it lost or flipped
};

/// How a telegram goes out.
struct Sending {
  double begin = 0;  // [s] its first bit
  double end = 0;    // [s] its last
  bool intact = true;
};

/// Start bit, eight, stop bit: ten bit times a byte. No clock: the time is an argument, in seconds
/// since any moment, and never goes back. The same seed brings the same faults.
class Line {
 public:
  explicit Line(unsigned baud, std::uint64_t seed = 0) : baud_(baud), random_(seed) {}

  LineFaults faults{};

  /// [bit/s]
  unsigned baud() const { return baud_; }
  /// What is under way stays at its old rate.
  void set_baud(unsigned baud) { baud_ = baud; }

  /// The host began to send `bytes` at `now`, one after another.
  void hear(ByteView bytes, double now);
  /// Calls `on_byte(byte, time)` for each that has arrived by `now`.
  template <class OnByte>
  void deliver(double now, OnByte&& on_byte) {
    while (!incoming_.empty() && incoming_.front().time <= now) {
      const Timed byte = incoming_.front();
      incoming_.pop_front();
      last_heard_ = byte.time;
      on_byte(byte.value, byte.time);
    }
  }
  /// [s] since the last byte from the host, by `now`; 0 when more are under way.
  double quiet(double now) const { return incoming_.empty() ? now - last_heard_ : 0; }

  /// Sends `telegram` when the line is free, not before `earliest`.
  Sending say(ByteView telegram, double earliest);
  /// Breaks off: what has not left by `now` never will. True when there was something.
  bool cut(double now);
  /// [s] When the last byte will have left; in the past when nothing is being sent.
  double free_at() const { return free_at_; }
  /// Appends to `out` what has left by `now` at one rate, which it returns; call it again until
  /// nothing comes.
  unsigned leave(double now, std::vector<std::uint8_t>& out);

  /// [s] When the next byte arrives or leaves; kNever without one.
  double next_arrival() const { return incoming_.empty() ? kNever : incoming_.front().time; }
  double next_departure() const { return outgoing_.empty() ? kNever : outgoing_.front().time; }

 private:
  struct Timed {
    double time = 0;  // [s] of its stop bit
    unsigned baud = 0;
    std::uint8_t value = 0;
  };

  double byte_time() const { return 10.0 / static_cast<double>(baud_); }
  bool happens(double probability);
  bool spoil(ByteView bytes);

  unsigned baud_ = 0;
  std::mt19937_64 random_;
  std::deque<Timed> incoming_{};
  std::deque<Timed> outgoing_{};
  std::vector<std::uint8_t> spoiled_{};  // workspace of spoil()
  double last_heard_ = 0;
  double heard_until_ = 0;
  double free_at_ = 0;
};

/// What a receiver at `to` makes of `bytes` sent at `from` [bit/s]: the line's level, sampled in
/// the middle of where it expects each bit. A byte without its stop bit reads as 0.
std::vector<std::uint8_t> misread(ByteView bytes, unsigned from, unsigned to);

}  // namespace drivers::emulators
