// tests/algo/gate_test.cpp: the gate holds dangerous commands and gives a reason.
#include "algo/gate.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace algo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct GateTest : ::testing::Test {
  GateTest() {
    observation.stamp = 10.0;
    input.scan_timeout = 0.2;
    input.scan_stamp = 9.9;  // 0.1 s old
  }
  Observation observation{};
  GateInput input{};
  Command command{{0.3, 0.1}};
};

TEST_F(GateTest, PassesACommandWithAFreshScan) {
  EXPECT_EQ(gate(input, observation, command), Hold{});
}

TEST_F(GateTest, HoldsARobotThatIsLostOnItsMapUnlessAPersonDrives) {
  MapPose& at = observation.map_pose.emplace();
  for (const MapFix fix : {MapFix::Searching, MapFix::Nowhere, MapFix::NotUnique, MapFix::Unsure}) {
    at.fix = fix;
    const Hold hold = gate(input, observation, command);
    EXPECT_EQ(hold, holds::kNotLocated);
    EXPECT_EQ(hold.why, sentence(fix));
  }
  input.by_hand = true;
  EXPECT_EQ(gate(input, observation, command), Hold{});
  input.by_hand = false;
  at.fix = MapFix::Located;
  EXPECT_EQ(gate(input, observation, command), Hold{});
}

TEST_F(GateTest, HoldsWhenTheScanIsStaleOrNeverCame) {
  input.scan_stamp = 9.79;  // 0.21 s old
  EXPECT_EQ(gate(input, observation, command), holds::kStaleScan);
  input.scan_stamp.reset();
  EXPECT_EQ(gate(input, observation, command), holds::kStaleScan);
  input.scan_stamp = kNaN;
  EXPECT_EQ(gate(input, observation, command), holds::kStaleScan);
}

TEST_F(GateTest, HoldsARobotThatDrivesByItsInclinometerUntilAReadingIsFresh) {
  input.tilt_timeout = 0.2;
  EXPECT_FALSE(gate(input, observation, command)) << "it has none";
  input.needs_tilt = true;
  EXPECT_EQ(gate(input, observation, command), holds::kNoTilt);
  input.tilt_stamp = 9.79;  // 0.21 s old
  EXPECT_EQ(gate(input, observation, command), holds::kStaleTilt);
  input.tilt_stamp = kNaN;
  EXPECT_EQ(gate(input, observation, command), holds::kStaleTilt);
  input.tilt_stamp = 9.9;
  EXPECT_FALSE(gate(input, observation, command));
}

TEST_F(GateTest, HoldsOnAnythingThatIsNotANumber) {
  for (double* field : {&observation.odometry.pose.x,
                        &observation.odometry.pose.y,
                        &observation.odometry.pose.heading,
                        &observation.odometry.twist.v,
                        &observation.odometry.twist.omega,
                        &command.base.v,
                        &command.base.omega}) {
    const double before = *field;
    for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
      *field = bad;
      EXPECT_EQ(gate(input, observation, command), holds::kNotFinite);
    }
    *field = before;
  }
}

TEST_F(GateTest, HoldsARobotThatLiesOnItsSide) {
  for (const double angle : {0.0, 0.5, 1.0, 1.1, 1.6, 3.1}) {
    const Hold expected = angle > 1.05 ? holds::kOverturned : Hold{};  // 60 degrees
    for (const double sign : {-1.0, 1.0}) {
      observation.inclinometer = Inclinometer{10, sign * angle, 0};
      EXPECT_EQ(gate(input, observation, command), expected) << angle;
      observation.inclinometer = Inclinometer{10, 0, sign * angle / 2};
      EXPECT_EQ(gate(input, observation, command), angle > 2.1 ? holds::kOverturned : Hold{});
    }
  }
}

TEST_F(GateTest, ABumperHoldsUnlessTheDriverBacksOff) {
  const BumperReading front{.mount_R = {0.35, 0, 0}, .stamp = 10, .pressed = true};
  const BumperReading rear{.mount_R = {-0.35, 0, 3.14}, .stamp = 10, .pressed = true};
  for (const bool at_front : {true, false}) {
    observation.bumpers.clear();
    observation.bumpers.push_back(at_front ? front : rear);
    const double away = at_front ? -0.1 : 0.1;
    for (const double v : {away, -away, 0.0}) {
      command.base = {v, 0};
      input.by_hand = false;
      EXPECT_EQ(gate(input, observation, command), holds::kBumper) << at_front << v;
      input.by_hand = true;
      EXPECT_EQ(gate(input, observation, command), v == away ? Hold{} : holds::kBumper)
          << at_front << v;
    }
  }
  observation.bumpers.push_back(front);  // both
  command.base = {-0.1, 0};
  EXPECT_EQ(gate(input, observation, command), holds::kBumper);
}

TEST_F(GateTest, NothingDrivesWhereADazzledScannerSeesNothing) {
  input.hidden = true;
  EXPECT_EQ(gate(input, observation, command), holds::kDazzled);
  input.hidden = false;
  input.blinded = true;  // only recently: the last usable scan is fresh enough
  EXPECT_EQ(gate(input, observation, command), Hold{});
  input.scan_stamp.reset();
  EXPECT_EQ(gate(input, observation, command), holds::kDazzled);
}

TEST_F(GateTest, StopHasPriority) {
  input.stopped = true;
  input.scan_stamp.reset();
  observation.odometry.pose.x = kNaN;
  EXPECT_EQ(gate(input, observation, command), holds::kStopped);
}

}  // namespace
}  // namespace algo
