// tests/drivers/roboteq_protocol_test.cpp: dialogues with a Roboteq controller, whole and
// truncated.
#include "drivers/roboteq_protocol.hpp"

#include <limits>
#include <numbers>

#include "tests/drivers/hex.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::roboteq {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Kind = Reply::Kind;

/// The bytes of `text`.
Bytes raw(std::string_view text) {
  return {text.begin(), text.end()};
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  LineReader reader;
  reader.feed(raw(text), [&lines](std::string_view line) { lines.emplace_back(line); });
  return lines;
}

std::vector<Kind> kinds_of(std::string_view text) {
  std::vector<Kind> kinds;
  for (const std::string& line : lines_of(text)) kinds.push_back(parse_reply(line).kind);
  return kinds;
}

State state_after(std::string_view text) {
  State state;
  for (const std::string& line : lines_of(text)) update(state, parse_reply(line));
  return state;
}

TEST(RoboteqProtocol, CommandLinesMatchTheManual) {
  EXPECT_EQ(echo_off().text(), "^ECHOF 1\r");
  EXPECT_EQ(query("FID").text(), "?FID\r");
  EXPECT_EQ(read_parameter("RWD").text(), "~RWD\r");
  EXPECT_EQ(drive(500, -250).text(), "!G 1 500_!G 2 -250\r");
  EXPECT_EQ(query("S").text(), "?S\r");
  EXPECT_EQ(emergency_stop().text(), "!EX\r");
  EXPECT_EQ(release_stop().text(), "!MG\r");
  EXPECT_EQ(set_counter(1, 0).text(), "!C 1 0\r");
  EXPECT_EQ(end_repetition().text(), "#\r");
}

TEST(RoboteqProtocol, RepeatedQueries) {
  const std::array<std::string_view, 2> names{"C", "FF"};
  EXPECT_EQ(repeat_queries(names, 50).text(), "# C_?C_?FF_# 50\r");
  const std::vector<std::string_view> many(40, "FF");
  EXPECT_EQ(repeat_queries(many, 50).size(), 0U);
}

TEST(RoboteqProtocol, EchoesAreIgnored) {
  EXPECT_THAT(kinds_of("^ECHOF 1\r+\r"), ElementsAre(Kind::Nothing, Kind::Accepted));
  EXPECT_THAT(kinds_of("?S\rS=100:-50\r"), ElementsAre(Kind::Nothing, Kind::Values));
}

TEST(RoboteqProtocol, AnswersMatchTheManual) {
  EXPECT_THAT(kinds_of("+\r+\r"), ElementsAre(Kind::Accepted, Kind::Accepted));
  EXPECT_THAT(kinds_of("-\r"), ElementsAre(Kind::Refused));
  const Reply firmware = parse_reply("FID=Roboteq v2.0 SDC2XXX 01/01/2020");
  EXPECT_EQ(firmware.kind, Kind::Text);
  EXPECT_EQ(firmware.name, "FID");
  EXPECT_EQ(firmware.text, "Roboteq v2.0 SDC2XXX 01/01/2020");
  const Reply watchdog = parse_reply("RWD=500");
  EXPECT_EQ(watchdog.kind, Kind::Values);
  EXPECT_EQ(watchdog.values[0], 500);
}

TEST(RoboteqProtocol, StateFromAnswersInAnyOrder) {
  const State state = state_after("V=120:240:5010\r+\rC=3546:-1787\rFF=16\r+\rFS=9\rS=100:-50\r");
  EXPECT_EQ(state.counts, (std::array<std::int32_t, 2>{3546, -1787}));
  EXPECT_EQ(state.rpm, (std::array<double, 2>{100, -50}));
  EXPECT_EQ(state.battery_volts, 24.0);
  EXPECT_EQ(state.faults, 16);
  EXPECT_FALSE(state.one_channel);
  EXPECT_EQ(fault_text(16), "emergency stop");
  EXPECT_EQ(state_after("V=240\r").battery_volts, 24.0);
}

TEST(RoboteqProtocol, OneChannelControllerIsRefused) {
  EXPECT_TRUE(state_after("S=100\r").one_channel);
  EXPECT_FALSE(state_after("S=100\r").rpm);
}

TEST(RoboteqProtocol, FaultsHaveNames) {
  EXPECT_EQ(fault_text(0), "");
  EXPECT_EQ(fault_text(1 | 4 | 64), "overheated, voltage too low, power transistor failed");
  EXPECT_EQ(fault_text(256), "something unknown");
  EXPECT_FALSE(must_stop(0));
  EXPECT_TRUE(must_stop(4));
}

TEST(RoboteqProtocol, NoiseIsIgnored) {
  for (const char* line : {"=5", "C=", "c=5", "+5", "46:-1787", "ABCDEFGHI=1", " C=1"}) {
    EXPECT_EQ(parse_reply(line).kind, Kind::Nothing) << line;
  }
  for (const char* line : {"C=1:", "C=:1", "C=1:x", "C=99999999999", "C=1:2:3:4:5:6:7:8:9"}) {
    EXPECT_EQ(parse_reply(line).kind, Kind::Text) << line;  // and so no value of State
    EXPECT_FALSE(state_after(std::string(line) + "\r").counts) << line;
  }
}

TEST(RoboteqLines, LinesEndWithCrOrLfAndArriveInAnyPieces) {
  EXPECT_THAT(lines_of("S=1\r\nC=2\n\r\rV=3"), ElementsAre("S=1", "C=2"));
  LineReader reader;
  std::vector<std::string> lines;
  for (const std::uint8_t byte : raw("S=1\rC=2\r")) {
    reader.feed(ByteView(&byte, 1), [&lines](std::string_view line) { lines.emplace_back(line); });
  }
  EXPECT_THAT(lines, ElementsAre("S=1", "C=2"));
}

TEST(RoboteqLines, OverlongLinesAreSkipped) {
  EXPECT_THAT(lines_of(std::string(161, 'x') + "\r"), IsEmpty());
  EXPECT_THAT(lines_of(std::string(160, 'x') + "\rS=1\r"),
              ElementsAre(std::string(160, 'x'), "S=1"));
  EXPECT_THAT(lines_of(std::string(5000, 'x') + "\rS=1\r"), ElementsAre("S=1"));
}

TEST(RoboteqWheel, ConvertsMetresToTurns) {
  // A wheel of 1 m round, geared 10 to 1, 500 lines: 20000 counts a metre, 600 rpm at 1 m/s.
  const Wheel wheel{.radius = 1 / (2 * std::numbers::pi),
                    .gear = 10,
                    .encoder_lines = 500,
                    .full_speed_rpm = 1200};
  EXPECT_NEAR(wheel.rpm(1), 600, 1e-9);
  EXPECT_NEAR(wheel.speed(600), 1, 1e-12);
  EXPECT_NEAR(wheel.metres(-20000), -1, 1e-12);
  EXPECT_EQ(wheel.command_for(1, 5), 500);
  EXPECT_EQ(wheel.command_for(-9, 1), -500);  // clamped to the limit before it is scaled
  EXPECT_EQ(wheel.command_for(9, 9), 1000);
  EXPECT_EQ(wheel.command_for(0, 1), 0);
  EXPECT_EQ(wheel.command_for(std::numeric_limits<double>::quiet_NaN(), 1), 0);
}

}  // namespace
}  // namespace drivers::roboteq
