// drivers/emulators/device.hpp: what all emulated devices have: a line, a clock that is an
// argument, and days on which they say nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/bytes.hpp"
#include "drivers/emulators/line.hpp"

namespace drivers::emulators {

/// A device seen from its line. Time [s] counts from any moment and never goes back. No I/O and no
/// thread; not for two threads at once.
///
/// Derived classes are written from the devices' manuals, not from the drivers, and refuse what the
/// device would refuse.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// The host begins to send `bytes` at `now`.
  void receive(ByteView bytes, double now) {
    line_.hear(bytes, now);
    run(now, false);
  }
  /// Nothing has come since, up to `now`: does what is due.
  void advance(double now) { run(now, true); }
  /// Appends to `out` the bytes that have left by `now`, all at the rate it returns [bit/s]; call
  /// it until nothing comes.
  unsigned send(double now, std::vector<std::uint8_t>& out) {
    const std::size_t before = out.size();
    const unsigned rate = line_.leave(now, out);
    if (now < mute_until_) out.resize(before);
    return rate;
  }
  /// [s] When advance() has something to do, at the latest.
  double next() const {
    return std::min({line_.next_arrival(), line_.next_departure(), next_duty()});
  }

  unsigned baud() const { return line_.baud(); }
  void set_faults(const LineFaults& faults) { line_.faults = faults; }
  const LineFaults& faults() const { return line_.faults; }
  /// Its transmitter is dead until then.
  void mute(double until) { mute_until_ = until; }
  bool mute_at(double now) const { return now < mute_until_; }

 protected:
  Device(unsigned baud, std::uint64_t seed) : line_(baud, seed) {}

  virtual void on_byte(std::uint8_t byte, double at) = 0;
  /// The line has been quiet for `silence` [s].
  virtual void on_quiet(double silence) = 0;
  /// Does what is due by `now`.
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
