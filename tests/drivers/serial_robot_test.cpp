// tests/drivers/serial_robot_test.cpp: what moves a robot of real devices, and what stops it; the
// clock is a variable.
#include "drivers/serial_robot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/telemetry.hpp"

namespace drivers {
namespace {

using algo::Halt;
using ::testing::HasSubstr;

constexpr double kPeriod = 0.05;

class FakeClock final : public Clock {
 public:
  explicit FakeClock(double& time) : time_(time) {}
  double now() override { return time_; }
  void sleep_until(double time) override { time_ = std::max(time_, time); }

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
            .period = 0.0266,
            .bad_line = bad_line,
            .faulty = faulty};
  }
  DeviceReport report() override {
    return {.name = "front laser", .port = "/dev/test", .well = !silent, .sentence = "Silent."};
  }

 private:
  double& time_;
  double last_ = 0;
};

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

  void enable(bool on) override { now.motors_on = on && motors_work; }
  void drive(const algo::Twist2& twist) override {
    commanded = twist;
    ++commands;
  }
  void stop() noexcept override { commanded = {}; }
  BaseState state() override {
    if (!silent) now.stamp = time_;
    return now;
  }
  double watchdog() const override { return 0.5; }
  DeviceReport report() override {
    return {.name = "base", .port = "/dev/base", .well = !silent, .sentence = "No answer."};
  }

 private:
  double& time_;
};

RobotFile file() {
  RobotFile out;
  out.spec.name = "test";
  out.spec.period = kPeriod;
  out.spec.radius = 0.3;
  out.spec.drives = true;
  out.lasers.push_back({.name = "front laser", .port = "/dev/test", .mount_R = {0.2, 0, 0}});
  out.base.battery_low = 11;
  return out;
}

struct Fixture {
  Fixture() {
    auto own_scanner = std::make_unique<FakeScanner>(time);
    auto own_base = std::make_unique<FakeBase>(time);
    scanner = own_scanner.get();
    base = own_base.get();
    std::vector<std::unique_ptr<Scanner>> scanners;
    scanners.push_back(std::move(own_scanner));
    robot = std::make_unique<SerialRobot>(
        file(), std::move(scanners), std::move(own_base), std::make_unique<FakeClock>(time));
    robot->reset(seen);
  }
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

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
  bool armed() const { return robot->report().armed; }

  double time = 500;
  FakeScanner* scanner = nullptr;
  FakeBase* base = nullptr;
  std::unique_ptr<SerialRobot> robot{};
  algo::Observation seen{};
};

TEST(SerialRobot, DoesNotMoveUntilItIsArmed) {
  Fixture f;
  f.steps(1);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::Disarmed);
  EXPECT_THAT(f.robot->report().trouble, HasSubstr("Nobody has armed"));
  f.arm();
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::None);
  EXPECT_EQ(f.robot->report().trouble, "");
}

TEST(SerialRobot, CommandsTheBaseOncePerTickAndNeverBetween) {
  Fixture f;
  f.arm();
  const int before = f.base->commands;
  f.steps(1);
  EXPECT_EQ(f.base->commands - before, 20);
}

TEST(SerialRobot, LimitsHold) {
  Fixture f;
  f.arm();
  f.step(3, -9);
  EXPECT_EQ(f.base->commanded, (algo::Twist2{0.1, -0.5}));
}

TEST(SerialRobot, ObservationIsOnTheRunClockAndFromTheStart) {
  Fixture f;
  f.base->now.pose = {1, 2, 0.5};
  f.robot->reset(f.seen);
  EXPECT_EQ(f.seen.stamp, 0);
  EXPECT_EQ(f.seen.odometry.pose, algo::Pose2{});
  f.base->now.pose = {1 + std::cos(0.5), 2 + std::sin(0.5), 0.6};
  f.step();
  EXPECT_NEAR(f.seen.stamp, kPeriod, 1e-9);
  EXPECT_NEAR(f.seen.odometry.pose.x, 1, 1e-12);
  EXPECT_NEAR(f.seen.odometry.pose.y, 0, 1e-12);
  EXPECT_NEAR(f.seen.odometry.pose.heading, 0.1, 1e-12);
  ASSERT_EQ(f.seen.scans.size(), 1U);
  EXPECT_NEAR(f.seen.scans[0].stamp, kPeriod - 0.01, 1e-9);
  EXPECT_EQ(f.seen.scans[0].mount_R, (algo::Pose2{0.2, 0, 0}));
}

TEST(SerialRobot, PoseIsOfTheTickThoughTheReportIsOlder) {
  Fixture f;
  f.base->now.twist = {0.1, 0.5};
  f.step();
  EXPECT_EQ(f.seen.odometry.pose, algo::Pose2{});
  f.base->silent = true;  // two ticks old: 0.1 s
  f.step();
  f.step();
  EXPECT_NEAR(f.seen.odometry.pose.x, 0.01, 1e-4);
  EXPECT_NEAR(f.seen.odometry.pose.heading, 0.05, 1e-9);
  EXPECT_NEAR(f.seen.odometry.stamp, f.seen.stamp, 1e-9);
  f.steps(2);  // no further than its reports are believed
  EXPECT_NEAR(f.seen.odometry.pose.heading, 0.5 * SerialRobot::kBaseTimeout, 1e-9);
}

TEST(SerialRobot, SilentScannerStopsItWithinThreePeriodsAndOneTick) {
  Fixture f;
  f.arm();
  f.scanner->silent = true;
  const double silent_at = f.time;
  while (f.moves() && f.time < silent_at + 1) f.step();
  EXPECT_LE(f.time - silent_at, 3 * 0.0266 + SerialRobot::kArrivalJitter + 2 * kPeriod);
  EXPECT_EQ(f.seen.halt, Halt::ScannerLost);
  EXPECT_THAT(f.robot->report().trouble, HasSubstr("front laser at /dev/test: Silent."));
  // WHEN it is back soon THEN the robot goes on.
  f.scanner->silent = false;
  f.steps(0.2);
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, WhatLastsLongDisarms) {
  Fixture f;
  f.arm();
  f.scanner->silent = true;
  f.steps(SerialRobot::kRearm + 0.5);
  f.scanner->silent = false;
  f.steps(1);
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.robot->report().trouble, HasSubstr("Arm it again"));
  f.arm();
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, EveryFaultStopsInTheTickThatSeesIt) {
  const std::vector<std::pair<Halt, std::function<void(Fixture&)>>> faults{
      {Halt::StopButton, [](Fixture& f) { f.base->now.stop_button = true; }},
      {Halt::BaseFault, [](Fixture& f) { f.base->now.faulty = true; }},
      {Halt::OverCurrent, [](Fixture& f) { f.base->now.over_current = true; }},
      {Halt::BaseLost, [](Fixture& f) { f.base->now.running = false; }},
      {Halt::MotorsOff, [](Fixture& f) { f.base->now.motors_on = false; }},
      {Halt::BadLine, [](Fixture& f) { f.scanner->bad_line = true; }},
      {Halt::ScannerFault, [](Fixture& f) { f.scanner->faulty = true; }}};
  for (const auto& [halt, inject] : faults) {
    Fixture f;
    f.arm();
    ASSERT_TRUE(f.moves());
    inject(f);
    f.step();
    EXPECT_FALSE(f.moves()) << algo::name(halt);
    const bool person =
        halt == Halt::StopButton || halt == Halt::BaseFault || halt == Halt::OverCurrent;
    EXPECT_EQ(f.seen.halt, halt) << algo::name(halt);
    EXPECT_EQ(f.armed(), !person) << algo::name(halt);
  }
}

TEST(SerialRobot, StateOfTheBaseMustNotBeOld) {
  Fixture f;
  f.arm();
  f.base->silent = true;
  const double silent_at = f.time;
  while (f.moves() && f.time < silent_at + 1) f.step();
  EXPECT_LE(f.time - silent_at, SerialRobot::kBaseTimeout + 2 * kPeriod);
  EXPECT_EQ(f.seen.halt, Halt::BaseLost);
}

TEST(SerialRobot, BaseThatWasSetUpAnewHasToBeArmedAgain) {
  Fixture f;
  f.arm();
  ++f.base->now.set_ups;
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
}

TEST(SerialRobot, BatteryMaySagButNotStayLow) {
  Fixture f;
  f.arm();
  f.base->now.volts = 10;
  f.steps(2);
  EXPECT_TRUE(f.moves());
  f.steps(2);
  EXPECT_FALSE(f.moves());
  EXPECT_THAT(f.robot->report().trouble, HasSubstr("battery"));
}

TEST(SerialRobot, BumperAllowsOnlyTheWayBack) {
  Fixture f;
  f.arm();
  f.base->now.bumper_front = true;
  f.step(0.05, 0.2);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.seen.bumper_pressed());
  f.step(-0.05, 0.2);
  EXPECT_EQ(f.base->commanded, (algo::Twist2{-0.05, 0}));
}

TEST(SerialRobot, CommandThatComesTooLateIsNone) {
  Fixture f;
  f.arm();
  f.time += 0.4;  // the control loop was elsewhere
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::LateTick);
  EXPECT_GT(f.robot->missed_periods(), 5U);
  f.steps(1.2);
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, LatenessOfLessThanAPeriodDelaysNoDeadline) {
  Fixture f;
  for (int i = 0; i < 10; ++i) {
    f.time += 0.02;  // work within the period
    f.step();
  }
  EXPECT_NEAR(f.seen.stamp, 10 * kPeriod, 1e-9);
  EXPECT_EQ(f.robot->missed_periods(), 0U);
  EXPECT_EQ(f.robot->report().lateness.ticks(), 10U);
}

TEST(SerialRobot, ResetAndStopDoNotLeaveItArmed) {
  Fixture f;
  f.arm();
  f.robot->reset(f.seen);
  EXPECT_FALSE(f.armed());
  f.step();
  EXPECT_FALSE(f.moves());
}

TEST(SerialRobot, IsNotArmedWhileSomethingIsWrong) {
  Fixture f;
  f.scanner->silent = true;
  f.steps(1);
  const auto refusal = f.robot->arm();
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, HasSubstr("front laser"));
}

TEST(SerialRobot, MotorsThatDoNotComeOnDisarm) {
  Fixture f;
  f.base->motors_work = false;
  f.step();
  ASSERT_EQ(f.robot->arm(), std::nullopt);
  f.steps(1);
  EXPECT_EQ(f.seen.halt, Halt::MotorsOff);
  f.steps(2);
  EXPECT_FALSE(f.armed());
}

TEST(SerialRobot, ObstaclesCannotBeEdited) {
  Fixture f;
  EXPECT_TRUE(f.robot->edit(algo::AddObstacle{}));
  EXPECT_FALSE(f.robot->edit(algo::Stop{true}));
}

}  // namespace
}  // namespace drivers
