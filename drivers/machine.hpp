// drivers/machine.hpp: what every device's driver is: a state machine of bytes and times, without a
// port, a thread or a clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "drivers/bytes.hpp"

namespace drivers {

/// What a machine wants done with its line.
struct LineOrder {
  FixedBytes<256> bytes{};         // to be sent; none when only the rate changes
  std::optional<unsigned> baud{};  // [bit/s] to be set instead, once all before has been sent
  double pause = 0;                // [s] of silence the device needs afterwards
  bool gaps = false;               // the device wants a moment between two bytes
  /// [s] when it is too late to send it: a motion that was ordered long ago is none.
  double expires = std::numeric_limits<double>::infinity();
};

/// Times are seconds of a steady clock. Not for two threads at once; LineThread holds a lock.
class Machine {
 public:
  Machine() = default;
  virtual ~Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// [bit/s] at which the line is to be opened next.
  virtual unsigned opening_baud() const = 0;
  /// The line is there; `baud` is what the port says it does, 0 when it does not know.
  virtual void opened(double now, unsigned baud) = 0;
  /// The line is lost or could not be opened; `why` is a sentence.
  virtual void closed(double now, const std::string& why) = 0;
  /// A change of the rate that was ordered is done; as in opened().
  virtual void rate_set(double now, unsigned baud) = 0;
  virtual void receive(double now, ByteView bytes) = 0;
  /// Bytes were thrown away, because nobody knows how old they were: what had begun is void.
  virtual void lost_bytes() {}
  /// Does what is due by `now`; call it after everything else and whenever wake_time() comes.
  virtual void advance(double now) = 0;
  /// [s] at the latest for the next advance().
  virtual double wake_time() const = 0;
  /// The next thing to do with the line, in order; nothing when there is none.
  virtual std::optional<LineOrder> next_order() = 0;

  /// Begins the way out: the device is left as the next program expects it.
  virtual void leave(double now) = 0;
  /// The way out is done, or has taken too long.
  virtual bool left() const = 0;
};

/// Orders on their way to the line. Those that do not fit are left out: a
/// machine that gives so many has lost its line.
class LineOrders {
 public:
  void send(ByteView bytes, double pause = 0) {
    LineOrder order;
    order.bytes.append(bytes);
    order.pause = pause;
    push(order);
  }
  /// Bytes that move something, not to be sent from `expires` [s] on.
  void send_before(double expires, ByteView bytes, double pause = 0) {
    LineOrder order;
    order.bytes.append(bytes);
    order.pause = pause;
    order.expires = expires;
    push(order);
  }
  /// With a moment between two bytes where the line is so fast that it gives none itself.
  void send_slowly(ByteView bytes) {
    LineOrder order;
    order.bytes.append(bytes);
    order.gaps = true;
    push(order);
  }
  void set_baud(unsigned baud) {
    LineOrder order;
    order.baud = baud;
    push(order);
  }
  std::optional<LineOrder> next() {
    if (begin_ == end_) return std::nullopt;
    return ring_[begin_++ % kRoom];
  }
  void clear() { begin_ = end_ = 0; }

 private:
  static constexpr std::size_t kRoom = 32;

  void push(const LineOrder& order) {
    if (end_ - begin_ < kRoom) ring_[end_++ % kRoom] = order;
  }

  std::array<LineOrder, kRoom> ring_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace drivers
