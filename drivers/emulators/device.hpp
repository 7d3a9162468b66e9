// drivers/emulators/device.hpp: the common part of emulated devices: a line, time as an argument,
// and injected silence.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/bytes.hpp"
#include "drivers/emulators/line.hpp"

namespace drivers::emulators {

/// A device as the host sees it over the line. Time [s] has any origin and never goes back. No I/O
/// and no thread; not thread-safe.
///
/// Derived classes follow the devices' manuals, not the drivers, and refuse what the device would
/// refuse.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// The host starts to send `bytes` at `now`.
  void receive(ByteView bytes, double now) {
    line_.hear(bytes, now);
    run(now, false);
  }
  /// Advances to `now`, without further bytes from the host.
  void advance(double now) { run(now, true); }
  /// Appends to `out` the bytes sent by `now` at one rate and returns that rate [bit/s]; call it
  /// until `out` gets nothing.
  unsigned send(double now, std::vector<std::uint8_t>& out) {
    const std::size_t before = out.size();
    const unsigned rate = line_.leave(now, out);
    if (now < mute_until_) out.resize(before);
    return rate;
  }
  /// [s] The latest time for the next advance().
  double next() const {
    return std::min({line_.next_arrival(), line_.next_departure(), next_duty()});
  }

  unsigned baud() const { return line_.baud(); }
  void set_faults(const LineFaults& faults) { line_.faults = faults; }
  const LineFaults& faults() const { return line_.faults; }
  /// The transmitter is dead until then.
  void mute(double until) { mute_until_ = until; }
  bool mute_at(double now) const { return now < mute_until_; }

 protected:
  Device(unsigned baud, std::uint64_t seed) : line_(baud, seed) {}

  virtual void on_byte(std::uint8_t byte, double at) = 0;
  /// Called when the line has been quiet for `silence` [s].
  virtual void on_quiet(double silence) = 0;
  /// Does the work due by `now`.
  virtual void work(double now) = 0;
  /// [s] When work() is next due; kNever when it is not.
  virtual double next_duty() const = 0;

  Line& line() { return line_; }
  const Line& line() const { return line_; }

 private:
  void run(double now, bool quiet) {
    work(now);
    line_.deliver(now, [this](std::uint8_t byte, double at) { on_byte(byte, at); });
    if (quiet) on_quiet(line_.quiet(now));
    work(now);
  }

  Line line_;
  double mute_until_ = -kNever;
};

}  // namespace drivers::emulators
