// tests/drivers/fake_robot.hpp: a SerialRobot on a scanner, a base and a clock that are variables.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/serial_robot.hpp"

namespace drivers {

inline constexpr double kPeriod = 0.05;  // [s] of the robot's ticks

/// A clock that advances only by sleeping.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(double& time) : time_(time) {}
  double now() override { return time_; }
  void sleep_until(double time) override {
    time_ = std::max(time_, time) + oversleep;
    oversleep = 0;
  }
  double oversleep = 0;  // [s] the next time

 private:
  double& time_;
};

/// A scan every 26.6 ms while it runs.
class FakeScanner final : public Scanner {
 public:
  explicit FakeScanner(double& time) : time_(time) {}
  bool silent = false;
  bool bad_line = false;
  bool faulty = false;
  bool blinded = false;
  double period = 0.0266;

  bool take(algo::LaserScan& scan) override {
    if (silent) return false;
    last_ = time_;
    scan.stamp = time_ - 0.01;
    scan.range_max = 8.191;
    scan.resize(3);
    for (std::size_t i = 0; i < 3; ++i) scan.set_ok(i, 1.0);
    return true;
  }
  ScannerState state() override {
    if (!silent) last_ = time_;
    return {.running = true,
            .last_scan = last_,
            .period = period,
            .bad_line = bad_line,
            .faulty = faulty,
            .blinded = blinded};
  }
  algo::DeviceReport report() override {
    return {.name = "front laser", .port = "/dev/test", .well = !silent, .sentence = "Silent."};
  }

 private:
  double& time_;
  double last_ = 0;
};

/// Wheels that follow commands at once.
class FakeBase final : public Base {
 public:
  explicit FakeBase(double& time) : time_(time) {
    now.running = true;
    now.set_ups = 1;
  }
  BaseState now{};
  bool silent = false;
  bool motors_work = true;
  algo::Twist2 commanded{};
  int commands = 0;
  int brakes = 0;
  int cuts = 0;
  double write_takes = 0;  // [s] the next time

  void enable(bool on) override {
    now.motors_on = on && motors_work;
    if (!on) commanded = {};
  }
  void cut() noexcept override {
    now.motors_on = false;
    commanded = {};
    ++cuts;
  }
  void drive(const algo::Twist2& twist) override {
    commanded = twist;
    ++commands;
    time_ += std::exchange(write_takes, 0);
  }
  void stop() noexcept override {
    commanded = {};
    ++brakes;
  }
  BaseState state() override {
    if (!silent) now.stamp = time_;
    return now;
  }
  double watchdog() const override { return 0.5; }
  WheelDynamics dynamics() const override { return {.checked = true}; }
  algo::DeviceReport report() override {
    return {.name = "base", .port = "/dev/base", .well = !silent, .sentence = "No answer."};
  }

 private:
  double& time_;
};

/// A reading in every tick while it runs.
class FakeFloor final : public FloorSense {
 public:
  explicit FakeFloor(double& time) : time_(time) {}
  bool silent = false;
  bool faulty = false;

  bool take(algo::FloorRanges& ranges) override {
    if (silent) return false;
    ranges = {time_ - 0.004, 0.28, 0.27, 0.2, 0.21};
    return true;
  }
  FloorState state() override {
    if (!silent) last_ = time_;
    return {.running = true, .last_reading = last_, .period = 0.0383, .faulty = faulty};
  }
  algo::DeviceReport report() override {
    return {.name = "floor sensors",
            .port = "/dev/psd",
            .well = !silent && !faulty,
            .sentence = faulty ? "The near left sensor is stuck." : "It has been silent."};
  }

 private:
  double& time_;
  double last_ = 0;
};

inline RobotFile fake_robot_file() {
  RobotFile out;
  out.spec.name = "test";
  out.spec.period = kPeriod;
  out.spec.radius = 0.3;
  out.spec.drives = true;
  out.lasers.push_back({.name = "front laser", .port = "/dev/test", .mount_R = {0.2, 0, 0}});
  out.base.battery_low = 11;
  return out;
}

/// A robot of fake devices, whose clock is `time`.
struct FakeRobot {
  explicit FakeRobot(bool with_floor = false, const RobotFile& file = fake_robot_file()) {
    auto own_scanner = std::make_unique<FakeScanner>(time);
    auto own_base = std::make_unique<FakeBase>(time);
    auto own_clock = std::make_unique<FakeClock>(time);
    clock = own_clock.get();
    scanner = own_scanner.get();
    base = own_base.get();
    std::vector<std::unique_ptr<Scanner>> scanners;
    scanners.push_back(std::move(own_scanner));
    std::unique_ptr<FakeFloor> own_floor;
    if (with_floor) own_floor = std::make_unique<FakeFloor>(time);
    floor = own_floor.get();
    robot = std::make_unique<SerialRobot>(
        file, std::move(scanners), std::move(own_base), std::move(own_clock), std::move(own_floor));
    robot->reset(seen);
  }
  FakeRobot(const FakeRobot&) = delete;
  FakeRobot& operator=(const FakeRobot&) = delete;

  void step(double v = 0.05, double omega = 0) { robot->step({{v, omega}}, seen); }
  void steps(double seconds, double v = 0.05) {
    for (const double until = time + seconds; time < until;) step(v);
  }
  void arm() {
    step();
    ASSERT_EQ(robot->arm(), std::nullopt);
    step();
    step();
  }
  bool moves() const { return base->commanded != algo::Twist2{}; }
  bool armed() const { return robot->health().armed; }

  double time = 500;
  FakeScanner* scanner = nullptr;
  FakeBase* base = nullptr;
  FakeClock* clock = nullptr;
  FakeFloor* floor = nullptr;
  std::unique_ptr<SerialRobot> robot{};
  algo::Observation seen{};
};

}  // namespace drivers
