// tests/drivers/serial_robot_test.cpp: the motion and the safety stops of a robot of real devices;
// the clock is a variable.
#include "drivers/serial_robot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/drivers/fake_robot.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/telemetry.hpp"

namespace drivers {
namespace {

using algo::Halt;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(SerialRobot, DoesNotMoveUntilItIsArmed) {
  FakeRobot f;
  f.steps(1);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::Disarmed);
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("Nobody has armed"));
  f.arm();
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::None);
  EXPECT_EQ(f.robot->health().trouble, "");
}

TEST(SerialRobot, CommandsTheBaseOncePerTickAndNeverBetween) {
  FakeRobot f;
  f.arm();
  const int before = f.base->commands;
  f.steps(1);
  EXPECT_EQ(f.base->commands - before, 20);
}

TEST(SerialRobot, StopUsesTheEmergencyRampAndZeroSpeedTheDrivingRamp) {
  FakeRobot f;
  f.arm();
  const int before = f.base->brakes;
  f.step(0);
  EXPECT_EQ(f.base->brakes, before);
  f.robot->stop();
  EXPECT_EQ(f.base->brakes, before + 1);
  // WHEN the gate releases it THEN the robot drives on: Stop is no fault.
  f.step();
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, CommandsAreClampedToTheLimits) {
  FakeRobot f;
  f.arm();
  f.step(3, -9);
  EXPECT_EQ(f.base->commanded, (algo::Twist2{0.1, -0.5}));
}

TEST(SerialRobot, ObservationUsesTheRunClockAndTheStartPose) {
  FakeRobot f;
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

TEST(SerialRobot, PoseIsExtrapolatedToTheTick) {
  FakeRobot f;
  f.base->now.twist = {0.1, 0.5};
  f.step();
  EXPECT_EQ(f.seen.odometry.pose, algo::Pose2{});
  f.base->silent = true;  // two ticks old: 0.1 s
  f.step();
  f.step();
  EXPECT_NEAR(f.seen.odometry.pose.x, 0.01, 1e-4);
  EXPECT_NEAR(f.seen.odometry.pose.heading, 0.05, 1e-9);
  EXPECT_NEAR(f.seen.odometry.stamp, f.seen.stamp, 1e-9);
  f.steps(2);  // only as long as a report is valid
  EXPECT_NEAR(f.seen.odometry.pose.heading, 0.5 * SerialRobot::kBaseTimeout, 1e-9);
}

/// The base reports its wheels; R swings about them.
TEST(SerialRobot, ThePoseIsOfTheHullsMiddleWhereverTheWheelsAre) {
  RobotFile file = fake_robot_file();
  file.spec.axle = -0.09;
  FakeRobot f(false, file);
  f.base->now.pose = {3, 4, 0.7};
  f.robot->reset(f.seen);
  EXPECT_EQ(f.seen.odometry.pose, algo::Pose2{});
  f.base->now.pose.heading += std::numbers::pi / 2;
  f.step();
  EXPECT_NEAR(f.seen.odometry.pose.x, -0.09, 1e-12);
  EXPECT_NEAR(f.seen.odometry.pose.y, 0.09, 1e-12);
  EXPECT_NEAR(f.seen.odometry.pose.heading, std::numbers::pi / 2, 1e-12);
}

TEST(SerialRobot, SilentScannerStopsItWithinThreePeriodsAndOneTick) {
  FakeRobot f;
  f.arm();
  f.scanner->silent = true;
  const double silent_at = f.time;
  while (f.moves() && f.time < silent_at + 1) f.step();
  EXPECT_LE(f.time - silent_at, 3 * 0.0266 + SerialRobot::kArrivalJitter + 2 * kPeriod);
  EXPECT_EQ(f.seen.halt, Halt::ScannerLost);
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("front laser at /dev/test: Silent."));
  // WHEN it is back soon THEN the robot goes on.
  f.scanner->silent = false;
  f.steps(0.2);
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, SilentScannerStopsItInTimeAndALateOneDoesNot) {
  for (const double period : {0.01332, 0.0266, 0.12, 0.24, 0.8}) {
    FakeRobot f;
    f.scanner->period = period;
    f.arm();
    // A gap of one period plus the delay of a USB chip is no silence.
    f.scanner->silent = true;
    f.steps(std::floor((period + SerialRobot::kArrivalJitter) / kPeriod) * kPeriod);
    EXPECT_TRUE(f.moves()) << period;
    f.scanner->silent = false;
    f.step();
    f.scanner->silent = true;
    const double silent_at = f.time;
    while (f.moves() && f.time < silent_at + 3) f.step();
    // The stop is sent at the beginning of the last step.
    EXPECT_LE(f.time - kPeriod - silent_at, blind_time(period)) << period;
    EXPECT_EQ(f.seen.halt, Halt::ScannerLost) << period;
  }
}

TEST(SerialRobot, LongFaultsDisarm) {
  FakeRobot f;
  f.arm();
  f.scanner->silent = true;
  f.steps(SerialRobot::kRearm + 0.5);
  f.scanner->silent = false;
  f.steps(1);
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("Arm it again"));
  f.arm();
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, EveryFaultStopsInTheTickThatDetectsIt) {
  const std::vector<std::pair<Halt, std::function<void(FakeRobot&)>>> faults{
      {Halt::StopButton, [](FakeRobot& f) { f.base->now.stop_button = true; }},
      {Halt::BaseFault, [](FakeRobot& f) { f.base->now.faulty = true; }},
      {Halt::OverCurrent, [](FakeRobot& f) { f.base->now.over_current = true; }},
      {Halt::OverCurrent, [](FakeRobot& f) { f.base->now.stalled = true; }},

      {Halt::BaseLost, [](FakeRobot& f) { f.base->now.running = false; }},
      {Halt::MotorsOff, [](FakeRobot& f) { f.base->now.motors_on = false; }},
      {Halt::BadLine, [](FakeRobot& f) { f.scanner->bad_line = true; }},
      {Halt::ScannerFault, [](FakeRobot& f) { f.scanner->faulty = true; }},
      {Halt::ScannerFault, [](FakeRobot& f) { f.scanner->blinded = true; }}};
  for (const auto& [halt, inject] : faults) {
    FakeRobot f;
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

TEST(SerialRobot, NeverSaysThatAStopButtonIsReleased) {
  FakeRobot f;
  f.arm();
  f.base->now.stop_button = true;
  f.step();
  EXPECT_FALSE(f.armed());
  f.base->now.stop_button = false;  // a base with its motors off reports the button no more
  f.step();
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("stop button"));
  EXPECT_THAT(f.robot->health().trouble, Not(HasSubstr("over now")));
}

TEST(SerialRobot, WheelsThatTurnWithoutACommandAreCutOff) {
  FakeRobot f;
  f.arm();
  for (int i = 0; i < 20; ++i) f.step(0);
  EXPECT_TRUE(f.armed());
  const double began = f.time;
  f.base->now.twist = {2 * 0.1, 0};
  while (f.armed() && f.time < began + 4) f.step(0);
  EXPECT_LE(f.time - began, 0.3);
  EXPECT_EQ(f.base->cuts, 1);
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("does not turn as told"));
  // Pushing it without power is no fault.
  f.steps(5);
  EXPECT_EQ(f.base->cuts, 1);
  f.base->now.twist = {};
  f.arm();
  EXPECT_TRUE(f.armed());
}

TEST(SerialRobot, BaseWithoutAUsableWatchdogIsNotArmed) {
  FakeRobot f;
  f.step();
  f.base->now.watchdog = 0;
  EXPECT_THAT(*f.robot->arm(), HasSubstr("watchdog is off"));
  f.base->now.watchdog = 0.1;
  EXPECT_THAT(*f.robot->arm(), HasSubstr("three times within"));
  f.base->now.watchdog = 25;  // 2.5 m at 0.1 m/s
  EXPECT_THAT(*f.robot->arm(), HasSubstr("go on for 2.5 m"));
  f.base->now.watchdog = 2;
  EXPECT_EQ(f.robot->arm(), std::nullopt);
  EXPECT_THAT(f.robot->health().warnings,
              ::testing::Contains(HasSubstr("says that its watchdog is 2.00 s")));
}

TEST(SerialRobot, StaleBaseStateStops) {
  FakeRobot f;
  f.arm();
  f.base->silent = true;
  const double silent_at = f.time;
  while (f.moves() && f.time < silent_at + 1) f.step();
  EXPECT_LE(f.time - silent_at, SerialRobot::kBaseTimeout + 2 * kPeriod);
  EXPECT_EQ(f.seen.halt, Halt::BaseLost);
}

TEST(SerialRobot, BaseSetUpAgainMustBeArmedAgain) {
  FakeRobot f;
  f.arm();
  ++f.base->now.set_ups;
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
}

TEST(SerialRobot, BatteryMaySagBrieflyButNotStayLow) {
  FakeRobot f;
  f.arm();
  f.base->now.volts = 10;
  f.steps(2);
  EXPECT_TRUE(f.moves());
  f.steps(2);
  EXPECT_FALSE(f.moves());
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("battery"));
}

TEST(SerialRobot, BumperLatchesUntilArmingThenAllowsOnlyBackingOff) {
  FakeRobot f;
  f.arm();
  f.base->now.bumper_front = true;
  f.step(0.05, 0.2);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.seen.bumper_pressed());
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("touched something"));
  // Free again, it does not go on by itself.
  f.base->now.bumper_front = false;
  f.steps(1);
  EXPECT_FALSE(f.moves());
  // A person who arms it with the bumper pressed knows of the contact.
  f.base->now.bumper_front = true;
  f.arm();
  f.step(0.05, 0.2);
  EXPECT_FALSE(f.moves());
  f.step(-0.05, 0.2);
  EXPECT_EQ(f.base->commanded, (algo::Twist2{-0.05, 0}));
  EXPECT_TRUE(f.armed());
  // WHEN it has been free for a while THEN the next hit counts; one of the other bumper at once.
  f.base->now.bumper_front = false;
  f.steps(1);
  EXPECT_TRUE(f.moves());
  f.base->now.bumper_front = true;
  f.step();
  EXPECT_FALSE(f.armed());
  f.arm();
  f.base->now.bumper_rear = true;
  f.step(-0.05);
  EXPECT_FALSE(f.armed());
}

TEST(SerialRobot, SaysThatABumperIsNotReadInsteadOfHit) {
  FakeRobot f;
  f.arm();
  f.base->now.bumper_front = true;
  f.base->now.bumpers_unread = true;
  f.step(0.05, 0.2);
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("does not report its bumper inputs"));
  EXPECT_THAT(f.robot->health().trouble, Not(HasSubstr("touched")));
}

TEST(SerialRobot, LateCommandIsRejected) {
  FakeRobot f;
  f.arm();
  f.time += 0.4;  // the control loop was delayed
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.seen.halt, Halt::LateTick);
  EXPECT_GT(f.robot->health().missed_periods, 5U);
  f.steps(1.2);
  EXPECT_TRUE(f.moves());
}

TEST(SerialRobot, ProgramThatSleptDisarms) {
  // At any point of the tick: before its deadline, or during the controller.
  for (const bool asleep : {true, false}) {
    FakeRobot f;
    f.arm();
    ASSERT_TRUE(f.moves());
    if (asleep) f.clock->oversleep = 2;
    f.step();
    if (!asleep) f.time += 2;
    f.step();
    EXPECT_FALSE(f.moves());
    EXPECT_FALSE(f.armed());
    EXPECT_THAT(f.robot->health().trouble, HasSubstr("stood still for 2."));
    f.steps(5);
    EXPECT_FALSE(f.moves());
    f.arm();
    EXPECT_TRUE(f.moves());
  }
}

TEST(SerialRobot, LateCommandIsStoppedAfterItWasSent) {
  FakeRobot f;
  f.arm();
  const int brakes = f.base->brakes;
  f.base->write_takes = 0.4;
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.base->brakes, brakes + 1);
}

TEST(SerialRobot, DelayBelowAPeriodShiftsNoDeadline) {
  FakeRobot f;
  for (int i = 0; i < 10; ++i) {
    f.time += 0.02;  // work within the period
    f.step();
  }
  EXPECT_NEAR(f.seen.stamp, 10 * kPeriod, 1e-9);
  EXPECT_EQ(f.robot->health().missed_periods, 0U);
  EXPECT_EQ(f.robot->health().lateness.ticks(), 10U);
}

TEST(SerialRobot, ResetAndStopDoNotLeaveItArmed) {
  FakeRobot f;
  f.arm();
  f.robot->reset(f.seen);
  EXPECT_FALSE(f.armed());
  f.step();
  EXPECT_FALSE(f.moves());
}

TEST(SerialRobot, IsNotArmedDuringAFault) {
  FakeRobot f;
  f.scanner->silent = true;
  f.steps(1);
  const auto refusal = f.robot->arm();
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, HasSubstr("front laser"));
}

TEST(SerialRobot, MotorsThatStayOffDisarm) {
  FakeRobot f;
  f.base->motors_work = false;
  f.step();
  ASSERT_EQ(f.robot->arm(), std::nullopt);
  f.steps(1);
  EXPECT_EQ(f.seen.halt, Halt::MotorsOff);
  f.steps(2);
  EXPECT_FALSE(f.armed());
}

TEST(SerialRobot, ObstaclesCannotBeEdited) {
  FakeRobot f;
  algo::Robot& robot = *f.robot;
  EXPECT_EQ(robot.editing(), nullptr);
  EXPECT_EQ(robot.arming(), f.robot.get());
}

}  // namespace
}  // namespace drivers
