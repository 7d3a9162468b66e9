// tests/drivers/emulated_laser.hpp: emulated devices for the test bench of the drivers, and an
// LMS200 with its machine. The line takes its transfer time on a simulated clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tests/drivers/line_bench.hpp"
#include <gtest/gtest.h>

#include "drivers/emulators/lms200_emulator.hpp"
#include "drivers/lms200_machine.hpp"
#include "drivers/lms200_scan.hpp"

namespace drivers {

/// Adapts an emulated device to the bench.
class Emulated : public LineDevice {
 public:
  explicit Emulated(emulators::Device& device) : device_(device) {}

  void hear(double now, ByteView bytes, unsigned baud) override {
    if (baud == device_.baud()) {
      device_.receive(bytes, now);
    } else {
      const Bytes garbled = emulators::misread(bytes, baud, device_.baud());
      device_.receive(ByteView(garbled), now);
    }
  }
  Bytes say(double now, unsigned host_baud) override {
    device_.advance(now);
    live(now);
    Bytes all;
    for (;;) {
      Bytes bytes;
      const unsigned baud = device_.send(now, bytes);
      if (bytes.empty()) return all;
      append(all, baud == host_baud ? bytes : emulators::misread(ByteView(bytes), baud, host_baud));
    }
  }

 protected:
  /// Called with the time: the world's effect on the device.
  virtual void live(double /*now*/) {}

 private:
  emulators::Device& device_;
};

/// A room in which every beam of a sweep has another range.
class EmulatedLaser final : public Emulated {
 public:
  explicit EmulatedLaser(lms200::Emulator& emulator) : Emulated(emulator), emulator_(emulator) {}

  static double range_at(double bearing) { return std::round(3000 + 1000 * bearing) / 1000; }

 protected:
  void live(double now) override {
    const lms200::Sweep& sweep = emulator_.sweep();
    const bool parts = !sweep.parts.empty();
    const double period = lms200::kTurnPeriod * (parts ? 1 : sweep.variant.turns());
    if (now < next_) return;
    next_ = std::max(next_ + period, now);
    algo::LaserScan scan;
    scan.range_max = 8.191;
    scan.angle_increment = 0.25 * std::numbers::pi / 180;
    scan.angle_min = -std::numbers::pi / 2;
    scan.resize(721);
    for (std::size_t i = 0; i < scan.size(); ++i) scan.set_ok(i, range_at(scan.angle(i)));
    if (parts) {
      emulator_.offer(scan, now, sweep.parts[turn_++ % sweep.parts.size()]);
    } else {
      emulator_.offer(scan, now);
    }
  }

 private:
  lms200::Emulator& emulator_;
  double next_ = 0;
  std::size_t turn_ = 0;
};

struct Laser {
  explicit Laser(const lms200::EmulatorOptions& options, const lms200::LaserSetup& setup = {})
      : emulator(options), device(emulator), machine(setup), bench(machine, device) {
    emulator.on_scan = [this](const lms200::SentScan& sent) {
      using Fate = lms200::SentScan::Fate;
      if (sent.fate == Fate::Sent) ++intact;
      if (sent.fate == Fate::Damaged) ++damaged;
    };
    bench.open();
  }
  Laser(const Laser&) = delete;
  Laser& operator=(const Laser&) = delete;

  bool running(double seconds) {
    return bench.run_until(seconds, [&] { return machine.stage() == lms200::Stage::Running; });
  }
  /// Expects every beam of the next scan to equal the world, to the millimetre.
  void expect_room(std::size_t beams) {
    algo::LaserScan scan;
    ASSERT_TRUE(bench.run_until(5, [&] { return machine.take(scan); }));
    ASSERT_EQ(scan.size(), beams);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      ASSERT_NEAR(scan.ranges[i], EmulatedLaser::range_at(scan.angle(i)), 1e-9) << i;
    }
  }
  std::uint64_t intact = 0;
  std::uint64_t damaged = 0;
  lms200::Emulator emulator;
  EmulatedLaser device;
  lms200::LaserMachine machine;
  LineBench bench;
};

inline lms200::LaserSetup setup(unsigned baud, lms200::Variant variant = {180, 50}) {
  lms200::LaserSetup out;
  out.baud = baud;
  out.variant = variant;
  return out;
}

}  // namespace drivers
