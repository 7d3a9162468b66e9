// tests/drivers/roboteq_machine_test.cpp: checking, driving and leaving a Roboteq controller.
#include "drivers/roboteq_machine.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "tests/drivers/line_bench.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::roboteq {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Answers line by line; repeats its queries in turn.
class FakeRoboteq final : public LineDevice {
 public:
  std::map<std::string, std::string> parameters{{"RWD", "1000"},
                                                {"MMOD", "0:0"},
                                                {"MXRPM", "1000:1000"},
                                                {"EPPR", "500:500"},
                                                {"MAC", "20000:20000"},
                                                {"MDEC", "20000:20000"},
                                                {"CLERD", "2:2"}};
  std::string counts = "0:0";
  std::string rpm = "0:0";
  std::string amperes = "0:0";
  std::string motor_flags = "0:0";
  bool knows_loop_error = true;
  std::string inputs = "0:0:0";
  int faults = 0;
  bool button = false;
  bool mute = false;
  bool keeps_parameters = false;
  std::vector<std::string> heard{};

  void hear(double /*now*/, ByteView bytes, unsigned /*at*/) override {
    for (const std::uint8_t byte : bytes) {
      if (echo_) out_.push_back(byte);
      if (byte == '\r' || byte == '_') {
        act(line_);
        line_.clear();
      } else {
        line_.push_back(static_cast<char>(byte));
      }
    }
  }
  Bytes say(double now, unsigned /*host_baud*/) override {
    if (!repeated_.empty() && now >= next_) {
      next_ = now + 0.01;
      query(repeated_[turn_++ % repeated_.size()]);
    }
    Bytes out = std::move(out_);
    out_.clear();
    return mute ? Bytes{} : out;
  }

 private:
  void say_line(const std::string& text) {
    for (const char c : text) out_.push_back(static_cast<std::uint8_t>(c));
    out_.push_back('\r');
  }
  void query(const std::string& name) {
    const int shown = faults | (stopped_ || button ? 16 : 0);
    if (name == "C") say_line("C=" + counts);
    if (name == "S") say_line("S=" + rpm);
    if (name == "FF") say_line("FF=" + std::to_string(shown));
    if (name == "FS") say_line("FS=1");
    if (name == "FM") say_line("FM=" + motor_flags);
    if (name == "V") say_line("V=120:240:5010");
    if (name == "A") say_line("A=" + amperes);
    if (name == "DI") say_line("DI=" + inputs);
    if (name == "FID") say_line("FID=Roboteq v2.0 SDC2XXX 01/01/2020");
  }
  void set(const std::string& text) {
    const std::size_t space = text.find(' ');
    const std::string name = text.substr(1, space - 1);
    std::string value = text.substr(space + 1);
    if (const std::size_t second = value.find(' '); second != std::string::npos) {
      const bool first = value[0] == '1';
      value = value.substr(second + 1);
      const std::string before = parameters[name];
      const std::size_t colon = before.find(':');
      value = first ? value + before.substr(colon) : before.substr(0, colon + 1) + value;
    }
    if (!keeps_parameters) parameters[name] = value;
  }
  void act(const std::string& line) {
    if (line.empty()) return;
    heard.push_back(line);
    if (line == "^ECHOF 1") {
      echo_ = false;
    } else if (line[0] == '^') {
      set(line);
    } else if (!knows_loop_error && line.find("CLERD") != std::string::npos) {
      say_line("-");
      return;
    } else if (line[0] == '~') {
      say_line(line.substr(1) + "=" + parameters[line.substr(1)]);
      return;
    } else if (line[0] == '?') {
      query(line.substr(1));
      if (collecting_) repeated_.push_back(line.substr(1));
      return;
    } else if (line[0] == '#') {
      collecting_ = line == "# C";
      if (line == "# C" || line == "#") repeated_.clear();
      return;
    }
    if (line == "!EX") stopped_ = true;
    if (line == "!MG") stopped_ = false;
    say_line("+");
  }

  bool echo_ = true;
  bool stopped_ = false;
  bool collecting_ = false;
  std::string line_{};
  Bytes out_{};
  std::vector<std::string> repeated_{};
  std::size_t turn_ = 0;
  double next_ = 0;
};

RoboteqSetup roboteq_setup() {
  RoboteqSetup out;
  out.wheel = {.radius = 0.1, .gear = 20, .encoder_lines = 500, .full_speed_rpm = 1000};
  out.half_track = 0.25;
  out.max_current = 10;
  return out;
}

struct Fixture {
  explicit Fixture(const RoboteqSetup& with = roboteq_setup())
      : machine(with), bench(machine, device) {}
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  bool running(double seconds = 5) {
    bench.open();
    return bench.run_until(seconds, [&] { return machine.state().running; });
  }
  void arm() {
    machine.enable(bench.now(), true);
    bench.settle();
    bench.run(0.7);
  }
  FakeRoboteq device{};
  RoboteqMachine machine;
  LineBench bench;
};

TEST(RoboteqMachine, OnlyDifferingParametersAreSet) {
  Fixture f;
  ASSERT_TRUE(f.running());
  EXPECT_EQ(f.device.parameters["RWD"], "500");
  EXPECT_EQ(f.device.parameters["MMOD"], "1:1");
  EXPECT_THAT(f.device.heard, ::testing::Not(Contains(HasSubstr("^EPPR"))));
  EXPECT_THAT(f.device.heard, ::testing::Not(Contains(HasSubstr("EESAV"))));
  EXPECT_FALSE(f.machine.state().motors_on);
  EXPECT_DOUBLE_EQ(*f.machine.state().volts, 24.0);
}

TEST(RoboteqMachine, ControllerWithoutTheWantedWatchdogIsNotDriven) {
  Fixture f;
  f.device.keeps_parameters = true;
  EXPECT_FALSE(f.running());
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("keeps ^RWD at 1000"));
}

TEST(RoboteqMachine, OneChannelControllerIsRefused) {
  Fixture f;
  f.device.parameters["MMOD"] = "1";
  EXPECT_FALSE(f.running());
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("one channel"));
}

TEST(RoboteqMachine, SendsSpeedsAsSharesOfFullSpeedOnlyWhenEnabled) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.device.heard.clear();
  f.machine.drive(f.bench.now(), {0.1, 0});
  f.bench.settle();
  EXPECT_THAT(f.device.heard, ::testing::IsEmpty());
  f.arm();
  EXPECT_TRUE(f.machine.state().motors_on);
  f.device.heard.clear();
  // 0.1 m/s: 0.1 * 60 * 20 / (2 pi 0.1) = 190.99 rpm of 1000, in thousandths 191. The turn of
  // 0.1 rad/s is 0.025 m/s at each wheel: 47.7.
  f.machine.drive(f.bench.now(), {0.1, 0});
  f.machine.drive(f.bench.now(), {0, 0.1});
  f.machine.drive(f.bench.now(), {});
  f.bench.settle();
  EXPECT_THAT(f.device.heard,
              ElementsAre("!G 1 191", "!G 2 191", "!G 1 -48", "!G 2 48", "!G 1 0", "!G 2 0"));
}

TEST(RoboteqMachine, SwappedAndReversedMotorsAreMapped) {
  RoboteqSetup with = roboteq_setup();
  with.swapped = true;
  with.reversed = {false, true};
  Fixture f(with);
  ASSERT_TRUE(f.running());
  f.arm();
  f.device.heard.clear();
  f.machine.drive(f.bench.now(), {0.1, 0.1});  // left 0.075, right 0.125 m/s
  f.bench.settle();
  EXPECT_THAT(f.device.heard, ElementsAre("!G 1 -239", "!G 2 143"));
}

TEST(RoboteqMachine, PoseContinuesOverTheCounterWrap) {
  Fixture f;
  f.device.counts = "2147483647:2147483647";
  ASSERT_TRUE(f.running());
  f.bench.run(0.2);
  // One turn of the wheel is 40000 counts and 0.628 m: a fortieth of it is 1000.
  f.device.counts = std::to_string(-2147483648LL + 999) + ":" + std::to_string(-2147483648LL + 999);
  f.bench.run(0.3);
  EXPECT_NEAR(f.machine.state().pose.x, 0.005 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(f.machine.state().pose.heading, 0, 1e-12);
}

TEST(RoboteqMachine, LineThatLostItsColonDoesNotMeanOneChannel) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.device.counts = "100100";
  f.bench.run(0.04);
  f.device.counts = "0:0";
  f.bench.run(0.3);
  EXPECT_TRUE(f.machine.state().running);
  EXPECT_EQ(f.machine.state().set_ups, 1U);
  f.device.counts = "100";
  f.device.rpm = "0";
  f.bench.run(0.5);
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("one channel"));
}

TEST(RoboteqMachine, DamagedDigitDoesNotMoveThePose) {
  Fixture f;
  f.device.counts = "100:100";
  ASSERT_TRUE(f.running());
  f.bench.run(0.2);
  f.device.counts = "900100:100";
  f.bench.run(0.04);
  f.device.counts = "1100:1100";
  f.bench.run(0.2);
  EXPECT_NEAR(f.machine.state().pose.x, 0.005 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(f.machine.state().pose.heading, 0, 1e-12);
  // WHEN the counters stay at another value THEN they were reset, and the robot has not moved.
  f.device.counts = "500000:500000";
  f.bench.run(0.5);
  f.device.counts = "501000:501000";
  f.bench.run(0.2);
  EXPECT_NEAR(f.machine.state().pose.x, 0.01 * std::numbers::pi, 1e-9);
}

TEST(RoboteqMachine, StopButtonFaultsAndCurrentAreReported) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.arm();
  f.device.button = true;
  f.bench.run(0.3);
  EXPECT_TRUE(f.machine.state().stop_button);
  EXPECT_FALSE(f.machine.state().motors_on);
  f.device.button = false;
  f.device.faults = 4;
  f.bench.run(0.3);
  EXPECT_TRUE(f.machine.state().faulty);
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("voltage too low"));
  f.device.faults = 0;
  f.device.amperes = "20:150";  // 2 A, 15 A
  f.bench.run(0.15);
  EXPECT_FALSE(f.machine.state().over_current);  // allowed while starting
  f.bench.run(0.5);
  EXPECT_TRUE(f.machine.state().over_current);
}

TEST(RoboteqMachine, StalledMotorNeedsTwoReports) {
  Fixture f;
  ASSERT_TRUE(f.running());
  EXPECT_EQ(f.device.parameters["CLERD"], "1:1");
  f.arm();
  f.device.motor_flags = "0:6";
  f.bench.run(0.1);
  EXPECT_FALSE(f.machine.state().stalled);
  f.bench.run(0.1);
  EXPECT_TRUE(f.machine.state().stalled);
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("blocked"));
}

TEST(RoboteqMachine, ControllerWithoutLoopErrorsIsStillDriven) {
  Fixture f;
  f.device.knows_loop_error = false;
  ASSERT_TRUE(f.running());
  EXPECT_THAT(f.machine.report(f.bench.now()).remarks, Contains(HasSubstr("^CLERD")));
}

TEST(RoboteqMachine, BumperThatCannotBeReadCountsAsHit) {
  RoboteqSetup with = roboteq_setup();
  with.bumper_inputs = {2, 3};
  Fixture f(with);
  ASSERT_TRUE(f.running());
  f.bench.run(0.3);
  EXPECT_FALSE(f.machine.state().bumper_front);
  f.device.inputs = "0:0:1";
  f.bench.run(0.3);
  EXPECT_TRUE(f.machine.state().bumper_front);
  EXPECT_FALSE(f.machine.state().bumpers_unread);
  f.device.inputs = "0:0";
  f.bench.run(0.3);
  EXPECT_TRUE(f.machine.state().bumper_front);
  EXPECT_TRUE(f.machine.state().bumpers_unread);
  f.device.inputs = "0:0:0";
  f.bench.run(0.3);
  EXPECT_FALSE(f.machine.state().bumper_front);
  EXPECT_FALSE(f.machine.state().bumpers_unread);
}

TEST(RoboteqMachine, RearBumpersAreNotReportedAsFrontBumpers) {
  RoboteqSetup with = roboteq_setup();
  with.bumper_inputs = {1};
  with.rear_bumper_inputs = {2};
  Fixture f(with);
  ASSERT_TRUE(f.running());
  for (const auto& [inputs, front, rear] :
       {std::tuple{"0:0", false, false}, {"1:0", true, false}, {"0:1", false, true}}) {
    f.device.inputs = inputs;
    f.bench.run(0.3);
    EXPECT_EQ(f.machine.state().bumper_front, front) << inputs;
    EXPECT_EQ(f.machine.state().bumper_rear, rear) << inputs;
  }
}

TEST(RoboteqMachine, ReportsSilenceAndRepeatsTheSetUp) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.device.mute = true;
  f.bench.run(2);
  EXPECT_FALSE(f.machine.state().running);
  f.device.mute = false;
  f.device.parameters["RWD"] = "1000";  // it has been off
  ASSERT_TRUE(f.bench.run_until(10, [&] { return f.machine.state().running; }));
  EXPECT_EQ(f.device.parameters["RWD"], "500");
}

// 2 m/s2 are 20 * 60 / (2 pi 0.1) * 2 = 3819.7 rpm a second. The file's ramp: the wheel takes part
// in 0.3 m/s2 ahead and in 1 rad/s2 of the turn, 0.55 m/s2 together.
TEST(RoboteqMachine, BrakesWithTheSteepestRampAndDrivesWithTheFilesRamp) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.arm();
  f.machine.drive(f.bench.now(), {0.1, 0});
  f.bench.settle();
  f.device.heard.clear();
  f.machine.halt(f.bench.now());
  f.bench.settle();
  EXPECT_THAT(f.device.heard, ElementsAre("!DC 1 38197", "!DC 2 38197", "!G 1 0", "!G 2 0"));
  f.device.heard.clear();
  f.machine.drive(f.bench.now(), {0.1, 0});
  f.bench.settle();
  EXPECT_THAT(f.device.heard, ElementsAre("!DC 1 10504", "!DC 2 10504", "!G 1 191", "!G 2 191"));
}

TEST(RoboteqMachine, PowerGoesOffOnceTheWheelsStand) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.arm();
  f.device.rpm = "190:190";
  f.bench.run(0.1);
  f.machine.enable(f.bench.now(), false);
  f.machine.drive(f.bench.now(), {0.1, 0});  // from a caller that does not know of it yet
  f.bench.run(0.2);
  EXPECT_THAT(f.device.heard, ::testing::Not(Contains("!G 1 191")));
  EXPECT_EQ(std::count(f.device.heard.begin(), f.device.heard.end(), "!EX"), 1);  // of the set-up
  f.device.rpm = "0:0";
  f.bench.run(0.1);
  EXPECT_EQ(std::count(f.device.heard.begin(), f.device.heard.end(), "!EX"), 2);
  EXPECT_FALSE(f.machine.state().motors_on);
  f.arm();
  f.device.rpm = "190:190";
  f.bench.run(0.1);
  f.machine.cut(f.bench.now());
  f.bench.settle();
  EXPECT_EQ(f.device.heard.back(), "!EX");
}

TEST(RoboteqMachine, LeavesThePowerOff) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.arm();
  f.device.heard.clear();
  f.machine.leave(f.bench.now());
  f.bench.run(0.1);
  EXPECT_THAT(
      f.device.heard,
      ElementsAre(
          "!DC 1 38197", "!DC 2 38197", "!G 1 0", "!G 2 0", "!G 1 0", "!G 2 0", "!EX", "#"));
  EXPECT_TRUE(f.machine.left());
}

}  // namespace
}  // namespace drivers::roboteq
