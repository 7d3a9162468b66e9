// drivers/emulators/line.hpp: a serial line seen from the device: each byte takes its transfer
// time, and faults may damage it.
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

/// Probabilities of line faults, in both directions.
struct LineFaults {
  double drop = 0;    // of a byte: lost
  double flip = 0;    // of a byte: one bit flipped
  double damage = 0;  // of a telegram: one byte of it lost or flipped
};

/// The transmission of a telegram.
struct Sending {
  double begin = 0;  // [s] first bit
  double end = 0;    // [s] last bit
  bool intact = true;
};

/// Ten bit times per byte: start bit, eight data bits, stop bit. Time is an argument in seconds,
/// with any origin, and never goes back. The same seed gives the same faults.
class Line {
 public:
  explicit Line(unsigned baud, std::uint64_t seed = 0) : baud_(baud), random_(seed) {}

  LineFaults faults{};

  /// [bit/s]
  unsigned baud() const { return baud_; }
  /// Sets the rate; bytes being sent keep their old rate.
  void set_baud(unsigned baud) { baud_ = baud; }

  /// The host starts to send `bytes` at `now`, one after another.
  void hear(ByteView bytes, double now);
  /// Calls `on_byte(byte, time)` for each byte that has arrived by `now`.
  template <class OnByte>
  void deliver(double now, OnByte&& on_byte) {
    while (!incoming_.empty() && incoming_.front().time <= now) {
      const Timed byte = incoming_.front();
      incoming_.pop_front();
      last_heard_ = byte.time;
      on_byte(byte.value, byte.time);
    }
  }
  /// [s] from the last byte of the host to `now`; 0 while more are under way.
  double quiet(double now) const { return incoming_.empty() ? now - last_heard_ : 0; }

  /// Sends `telegram` when the line is free, not before `earliest`.
  Sending say(ByteView telegram, double earliest);
  /// Aborts: bytes not sent by `now` are lost. True when there were any.
  bool cut(double now);
  /// [s] When the last byte will be sent; in the past when nothing is being sent.
  double free_at() const { return free_at_; }
  /// Appends to `out` the bytes sent by `now` at one rate and returns that rate; call it until
  /// `out` gets nothing.
  unsigned leave(double now, std::vector<std::uint8_t>& out);

  /// [s] When the next byte arrives or is sent; kNever without one.
  double next_arrival() const { return first_time(incoming_); }
  double next_departure() const { return first_time(outgoing_); }

 private:
  struct Timed {
    double time = 0;  // [s] of its stop bit
    unsigned baud = 0;
    std::uint8_t value = 0;
  };

  static double first_time(const std::deque<Timed>& bytes) {
    if (bytes.empty()) return kNever;
    return bytes.front().time;
  }
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

/// The bytes that a receiver at `to` reads when `bytes` are sent at `from` [bit/s]. It samples the
/// line's level in the middle of each expected bit. A byte without its stop bit reads as 0.
std::vector<std::uint8_t> misread(ByteView bytes, unsigned from, unsigned to);

}  // namespace drivers::emulators
