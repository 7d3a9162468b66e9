// drivers/machine.hpp: the interface of every serial driver: a state machine over bytes and times,
// without a port, a thread or a clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "drivers/bytes.hpp"

namespace drivers {

/// An action on the line that a machine asks for.
struct LineOrder {
  FixedBytes<256> bytes{};         // to send; empty when only the rate changes
  std::optional<unsigned> baud{};  // [bit/s] to set instead, once all earlier orders are sent
  double pause = 0;                // [s] of silence the device needs afterwards
  bool gaps = false;               // the device needs a pause between two bytes
  /// [s] From here on the order is dropped: a motion command must not be executed late.
  double expires = std::numeric_limits<double>::infinity();
};

/// Times are seconds of a steady clock. Not thread-safe; LineThread holds a lock.
class Machine {
 public:
  Machine() = default;
  virtual ~Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// [bit/s] The rate to open the line at.
  virtual unsigned opening_baud() const = 0;
  /// Called when the line is open; `baud` is the port's actual rate, 0 if unknown.
  virtual void opened(double now, unsigned baud) = 0;
  /// Called when the line is lost or could not be opened; `why` is a sentence.
  virtual void closed(double now, const std::string& why) = 0;
  /// Called when an ordered rate is set; `baud` as in opened().
  virtual void rate_set(double now, unsigned baud) = 0;
  virtual void receive(double now, ByteView bytes) = 0;
  /// Called when bytes of unknown age were discarded: a frame begun is void.
  virtual void lost_bytes() {}
  /// Does the work due by `now`; call it after every other call and at wake_time().
  virtual void advance(double now) = 0;
  /// [s] The latest time for the next advance().
  virtual double wake_time() const = 0;
  /// The next order for the line, oldest first; nullopt without one.
  virtual std::optional<LineOrder> next_order() = 0;

  /// Begins to leave the device in the state that the next program expects.
  virtual void leave(double now) = 0;
  /// True once leaving is done or has taken too long.
  virtual bool left() const = 0;
};

/// A queue of orders for the line. Orders that do not fit are dropped: a machine with so many
/// pending has lost its line.
class LineOrders {
 public:
  void send(ByteView bytes, double pause = 0) {
    LineOrder order;
    order.bytes.append(bytes);
    order.pause = pause;
    push(order);
  }
  /// Appends a motion command, not to be sent from `expires` [s] on.
  void send_before(double expires, ByteView bytes, double pause = 0) {
    LineOrder order;
    order.bytes.append(bytes);
    order.pause = pause;
    order.expires = expires;
    push(order);
  }
  /// Appends bytes with a pause between each two, where the line is fast enough to need one.
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
