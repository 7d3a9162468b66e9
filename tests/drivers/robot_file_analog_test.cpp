// tests/drivers/robot_file_analog_test.cpp: robots with motors on an acquisition card.
#include <string>
#include <variant>

#include "tests/drivers/robot_error.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/robot_file.hpp"

namespace drivers {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kHead = R"(name = "silvermate"
[hull]
radius = 0.35
[[laser]]
port = "/dev/lms"
[base]
type = "analog"
port = "/dev/comedi0"
track = 0.5
wheel_radius = 0.1
counts_per_turn = 2000
speed_per_volt = 0.1
)";

RobotFile robot(const std::string& more) {
  return parse_robot(kHead + more, "my.toml");
}
std::string refusal(const std::string& more) {
  return error_of(kHead + more);
}

TEST(RobotFileAnalog, RequiredKeysAloneAreEnough) {
  const RobotFile file = robot("");
  const auto& entry = std::get<AnalogEntry>(file.base.setup);
  EXPECT_EQ(entry.card.library, "libcomedi.so.0");
  EXPECT_EQ(entry.card.relay_line, 0U);
  EXPECT_EQ(entry.base.half_track, 0.25);
  EXPECT_EQ(entry.base.limits.speed, 0.1);
  EXPECT_EQ(entry.card.max_volts, 10);
  EXPECT_EQ(file.base.watchdog, 0.2);
}

TEST(RobotFileAnalog, EveryKeyIsRead) {
  const RobotFile file = robot(R"(watchdog = 0.3
max_volts = 5
gain = 2
library = "libmine.so"
output_subdevice = 1
outputs = [1, 0]
reverse_left = true
counter_subdevices = [4, 5]
counters = [0, 0]
reverse_right_counter = true
counter_mode = 7
line_subdevice = 2
input_subdevice = 2
relay_line = 7
enable_line = 8
relay_closed_line = 1
stop_line = 2
fault_line = 3
bumper_lines = [4, 5]
rear_bumper_lines = [6]
)");
  const auto& [base, card] = std::get<AnalogEntry>(file.base.setup);
  EXPECT_EQ(base.watchdog, 0.3);
  EXPECT_EQ(base.max_volts, 5);
  EXPECT_EQ(base.gain, 2);
  EXPECT_EQ(card.library, "libmine.so");
  EXPECT_EQ(card.output_subdevice, 1U);
  EXPECT_THAT(card.outputs, ElementsAre(1U, 0U));
  EXPECT_THAT(card.reversed_outputs, ElementsAre(true, false));
  EXPECT_THAT(card.counter_subdevices, ElementsAre(4U, 5U));
  EXPECT_THAT(*card.counters, ElementsAre(0U, 0U));
  EXPECT_THAT(card.reversed_counters, ElementsAre(false, true));
  EXPECT_EQ(card.counter_mode, 7U);
  EXPECT_EQ(card.relay_line, 7U);
  EXPECT_EQ(card.enable_line, 8U);
  EXPECT_EQ(card.relay_closed_line, 1U);
  EXPECT_EQ(card.stop_line, 2U);
  EXPECT_EQ(card.fault_line, 3U);
  EXPECT_THAT(card.bumper_lines, ElementsAre(4U, 5U));
  EXPECT_THAT(card.rear_bumper_lines, ElementsAre(6U));
}

TEST(RobotFileAnalog, ErrorsNameTheirLine) {
  EXPECT_THAT(refusal("max_volts = 1\n"),
              HasSubstr("my.toml:12: [base] speed_per_volt is 0.100 m/s at the wheel, and [limits] "
                        "ask for 0.225"));
  EXPECT_THAT(refusal("outputs = [0]\n"),
              HasSubstr("my.toml:13: [base] outputs must be two channels"));
  EXPECT_THAT(refusal("outputs = [1, 1]\n"), HasSubstr("not one twice"));
  EXPECT_THAT(refusal("outputs = [0, -1]\n"), HasSubstr("whole numbers from 0"));
  EXPECT_THAT(refusal("counter_subdevices = [1, 2, 3]\n"), HasSubstr("one for both wheels"));
  EXPECT_THAT(refusal("stop_line = 0\n"),
              HasSubstr("my.toml:13: [base] stop_line asks for digital line 0, which is in use"));
  EXPECT_THAT(refusal("bumper_lines = [3, 3]\n"), HasSubstr("in use already"));
  EXPECT_THAT(refusal("battery_low = 20\n"), HasSubstr("an analog base reports no voltage"));
  EXPECT_THAT(refusal("watchdog = 0.1\n"), HasSubstr("three times within"));
  EXPECT_THAT(refusal("gear = 20\n"), HasSubstr("'gear' is no key known here"));
  EXPECT_THAT(refusal("relay_line = 1.5\n"), HasSubstr("whole number"));
  std::string coarse = kHead;
  coarse.replace(coarse.find("2000"), 4, "10");
  EXPECT_THAT(error_of(coarse), HasSubstr("counts_per_turn makes one count 0.063 m"));
}

TEST(RobotFileAnalog, InputsOfAnotherSubdeviceMayReuseLineNumbers) {
  EXPECT_EQ(refusal("line_subdevice = 3\ninput_subdevice = 2\nstop_line = 0\n"), "");
}

}  // namespace
}  // namespace drivers
