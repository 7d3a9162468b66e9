// tests/drivers/line_bench.hpp: a machine and a device on a line with a simulated clock: no thread,
// no port, no waiting.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/drivers/hex.hpp"

#include "drivers/machine.hpp"

namespace drivers {

/// The device at the other end.
class LineDevice {
 public:
  LineDevice() = default;
  virtual ~LineDevice() = default;
  LineDevice(const LineDevice&) = delete;
  LineDevice& operator=(const LineDevice&) = delete;

  /// Takes bytes that the host sent at `baud`.
  virtual void hear(double now, ByteView bytes, unsigned baud) = 0;
  /// The bytes that the host receives at `now`.
  virtual Bytes say(double now, unsigned host_baud) = 0;
};

/// Advances time in steps of a millisecond.
class LineBench {
 public:
  LineBench(Machine& machine, LineDevice& device) : machine_(machine), device_(device) {}

  /// [bit/s] The port's actual rate for a wanted one.
  std::function<unsigned(unsigned)> port = [](unsigned wanted) { return wanted; };

  /// [s] Received bytes are held this long and then delivered at once, as by a poor adapter.
  double bunch = 0;

  void open() {
    baud_ = machine_.opening_baud();
    machine_.opened(now_, port(baud_));
    settle();
  }
  void unplug() { machine_.closed(now_, "The device at the test has gone."); }

  void run(double seconds) {
    run_until(seconds, [] { return false; });
  }
  /// False when `done` does not become true within `seconds`.
  template <class Done>
  bool run_until(double seconds, Done&& done) {
    const auto steps = static_cast<long>(std::lround(seconds / kStep));
    for (long i = 0; i < steps; ++i) {
      if (done()) return true;
      now_ += kStep;
      append(waiting_, device_.say(now_, baud_));
      if (!waiting_.empty() && now_ >= next_) {
        machine_.receive(now_, ByteView(waiting_));
        waiting_.clear();
        next_ = now_ + bunch;
      }
      settle();
    }
    return done();
  }
  /// Executes the machine's pending orders.
  void settle() {
    machine_.advance(now_);
    while (const auto order = machine_.next_order()) {
      if (order->baud) {
        baud_ = *order->baud;
        machine_.rate_set(now_, port(baud_));
      } else {
        sent.emplace_back(bytes_of(order->bytes.view()));
        device_.hear(now_, order->bytes.view(), baud_);
      }
    }
  }
  double now() const { return now_; }
  unsigned baud() const { return baud_; }

  std::vector<Bytes> sent{};

 private:
  static constexpr double kStep = 0.001;  // [s]

  Machine& machine_;
  LineDevice& device_;
  double now_ = 1000.0;
  Bytes waiting_{};
  double next_ = 0;  // [s] when it is let through
  unsigned baud_ = 0;
};

}  // namespace drivers
