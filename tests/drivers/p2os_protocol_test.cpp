// tests/drivers/p2os_protocol_test.cpp: packets of Pioneer bases, as printed and damaged.
#include "drivers/p2os_protocol.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "tests/drivers/hex.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::p2os {
namespace {

using ::testing::ElementsAre;

constexpr double kDegree = std::numbers::pi / 180;
// Moving, x 1234, y 32700, heading -90 deg, 150 and 170 mm/s, 12.4 V, a front bumper, two sonars.
constexpr const char* kPrintedState =
    "FA FB 21 33 D2 04 BC 7F 00 FC 96 00 AA 00 7C 00 04 00 00 1F 00 00 02 00 DC 05 01 88 13 00 01 "
    "80 00 00 E2 41";

std::vector<Bytes> packets_of(const Bytes& stream, std::size_t piece = 1000) {
  std::vector<Bytes> packets;
  PacketReader reader;
  const auto keep = [&packets](ByteView packet) { packets.push_back(bytes_of(packet)); };
  const auto drop = [](std::uint8_t) {};
  for (ByteView rest = stream; !rest.empty();) {
    const ByteView next = rest.first(std::min(piece, rest.size()));
    reader.feed(next, keep, drop);
    rest = rest.subspan(next.size());
  }
  reader.expire(keep, drop);
  return packets;
}

Bytes packet(const Bytes& body) {
  Bytes bytes{0xFA, 0xFB, static_cast<std::uint8_t>(body.size() + 2)};
  append(bytes, body);
  const unsigned sum = checksum(body);
  bytes.push_back(static_cast<std::uint8_t>(sum >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  return bytes;
}

TEST(P2osProtocol, CommandsMatchTheManualAndDecodeAgain) {
  struct Row {
    Packet packet;
    const char* bytes;
  };
  const std::vector<Row> rows{
      {command(Code::Open), "FA FB 03 01 00 01"},
      {command(Code::Close), "FA FB 03 02 00 02"},
      {command(Code::Enable, 1), "FA FB 06 04 3B 01 00 05 3B"},
      {command(Code::Enable, 0), "FA FB 06 04 3B 00 00 04 3B"},
      {command(Code::Acceleration, 300), "FA FB 06 05 3B 2C 01 31 3C"},
      {command(Code::Acceleration, -300), "FA FB 06 05 1B 2C 01 31 1C"},
      {command(Code::SpeedLimit, 750), "FA FB 06 06 3B EE 02 F4 3D"},
      {command(Code::ZeroOdometry), "FA FB 03 07 00 07"},
      {command(Code::Velocity, 200), "FA FB 06 0B 3B C8 00 D3 3B"},
      {command(Code::Velocity, -200), "FA FB 06 0B 1B C8 00 D3 1B"},
      {command(Code::TurnRate, 30), "FA FB 06 15 3B 1E 00 33 3B"},
      {command(Code::TurnRate, -30), "FA FB 06 15 1B 1E 00 33 1B"},
      {command(Code::Encoders, 2), "FA FB 06 13 3B 02 00 15 3B"},
      {command(Code::Sonar, 0), "FA FB 06 1C 3B 00 00 1C 3B"},
      {command(Code::Stop), "FA FB 03 1D 00 1D"},
      {command(Code::EmergencyStop), "FA FB 03 37 00 37"},
      {command(Code::BumpStall, 3), "FA FB 06 2C 3B 03 00 2F 3B"},
      {command(Code::HostBaud, 4), "FA FB 06 32 3B 04 00 36 3B"},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(bytes_of(row.packet.view()), hex(row.bytes));
    EXPECT_THAT(packets_of(hex(row.bytes)), ElementsAre(hex(row.bytes)));
  }
}

TEST(P2osProtocol, SpeedsAreClampedBeforeTheyAreScaledAndZeroStaysZero) {
  const auto bytes = [](const Packet& p) { return bytes_of(p.view()); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const VelocityPackets none = velocity({.v = nan, .omega = nan}, {1, 1});
  EXPECT_EQ(bytes(none.velocity), bytes(command(Code::Velocity, 0)));
  EXPECT_EQ(bytes(none.turn_rate), bytes(command(Code::TurnRate, 0)));
  const VelocityPackets slow = velocity({.v = 0.2, .omega = -30 * kDegree}, {1, 1});
  EXPECT_EQ(bytes(slow.velocity), bytes(command(Code::Velocity, 200)));
  EXPECT_EQ(bytes(slow.turn_rate), bytes(command(Code::TurnRate, -30)));
  EXPECT_EQ(bytes(velocity({.v = 7, .omega = 0}, {1, 1}).velocity),
            bytes(command(Code::Velocity, 1000)));
}

TEST(P2osProtocol, PrintedState) {
  const Bytes printed = hex(kPrintedState);
  ASSERT_THAT(packets_of(printed), ElementsAre(printed));
  State state;
  ASSERT_TRUE(decode_state(body_of(printed), state));
  EXPECT_EQ(state.x_count, 1234);
  EXPECT_EQ(state.y_count, 32700);
  EXPECT_NEAR(state.heading, -90 * kDegree, 1e-9);
  EXPECT_DOUBLE_EQ(state.left_speed, 0.150);
  EXPECT_DOUBLE_EQ(state.right_speed, 0.170);
  EXPECT_DOUBLE_EQ(state.volts, 12.4);
  EXPECT_EQ(state.front_bumpers, 2);  // bit 10 of the word: the second of the front
  EXPECT_EQ(state.rear_bumpers, 0);
  EXPECT_FALSE(state.stalled());
  EXPECT_TRUE(state.motors_on());
  EXPECT_FALSE(state.stop_button());
  ASSERT_EQ(state.sonar_count, 2U);
  EXPECT_EQ(state.sonars[0], (SonarReading{.index = 0, .range = 1.5}));
  EXPECT_EQ(state.sonars[1], (SonarReading{.index = 1, .range = 5.0}));
  EXPECT_FALSE(state.faults);
}

TEST(P2osProtocol, StallsStopButtonAndFaults) {
  const Bytes body =
      hex("32 7x00 00 00 00 78 03 81 00 00 60 00 00 00 00 00 00 00 00 FF 00 01 9C FF 04 00");
  State state;
  ASSERT_TRUE(decode_state(body, state));
  EXPECT_TRUE(state.left_stalled);
  EXPECT_TRUE(state.right_stalled);
  EXPECT_EQ(state.rear_bumpers, 1);
  EXPECT_EQ(state.front_bumpers, 0x40);
  EXPECT_TRUE(state.stop_button());
  EXPECT_FALSE(state.motors_on());
  EXPECT_DOUBLE_EQ(state.volts, 25.5);
  EXPECT_EQ(state.faults, 4);
}

TEST(P2osProtocol, TruncatedStateIsRefusedOrReadToItsEnd) {
  const Bytes printed = hex(kPrintedState);
  const ByteView body = body_of(printed);
  for (std::size_t size = 0; size < body.size(); ++size) {
    State state;
    EXPECT_EQ(decode_state(body.first(size), state), size >= 26) << size;  // 20 + 2 sonars
  }
}

TEST(P2osProtocol, DamagedByteLosesOnePacket) {
  const Bytes printed = hex(kPrintedState);
  const Bytes stopped = packet(hex("32 19x00"));
  for (std::size_t at = 0; at < printed.size(); ++at) {
    Bytes stream = stopped;
    append(stream, printed);
    append(stream, stopped);
    append(stream, stopped);
    const std::size_t damaged = stopped.size() + at;
    Bytes lost = stream;
    lost.erase(lost.begin() + static_cast<std::ptrdiff_t>(damaged));
    stream[damaged] ^= 0x41U;
    EXPECT_THAT(packets_of(stream, 7), ElementsAre(stopped, stopped, stopped)) << at;
    EXPECT_THAT(packets_of(lost, 1), ElementsAre(stopped, stopped, stopped)) << at;
  }
}

TEST(P2osProtocol, HandshakeEndsWithTheBasesNames) {
  Handshake handshake;
  EXPECT_EQ(bytes_of(handshake.request().view()), hex("FA FB 03 00 00 00"));
  EXPECT_EQ(handshake.receive(hex("01")), Handshake::Progress::Ignored);
  EXPECT_EQ(handshake.receive(hex("00")), Handshake::Progress::Advanced);
  EXPECT_EQ(handshake.receive(hex("01")), Handshake::Progress::Advanced);
  EXPECT_EQ(bytes_of(handshake.request().view()), hex("FA FB 03 02 00 02"));
  const std::string echo("\x02MyRobot\0Pioneer\0p3dx-sh\0", 25);
  EXPECT_EQ(handshake.receive(Bytes(echo.begin(), echo.end())), Handshake::Progress::Done);
  EXPECT_EQ(handshake.identity(),
            (Identity{.name = "MyRobot", .type = "Pioneer", .subtype = "p3dx-sh"}));
}

TEST(P2osProtocol, StateDuringTheHandshakeMeansAnOpenSession) {
  Handshake handshake;
  EXPECT_EQ(handshake.receive(hex("32 19x00")), Handshake::Progress::SessionOpen);
}

TEST(P2osOdometer, WrapsAroundAndIgnoresJumps) {
  State state;
  Odometer odometer;
  state.x_count = 32700;
  EXPECT_TRUE(odometer.update(state));
  EXPECT_EQ(odometer.pose(), algo::Pose2{});
  state.x_count = 32;  // 32768 - 32700 + 32 = 100 mm on
  state.y_count = 32768 - 50;
  EXPECT_TRUE(odometer.update(state));
  EXPECT_NEAR(odometer.pose().x, 0.1, 1e-12);
  EXPECT_NEAR(odometer.pose().y, -0.05, 1e-12);
  state.x_count = 1000;
  EXPECT_FALSE(odometer.update(state));
  EXPECT_NEAR(odometer.pose().x, 0.1, 1e-12);
  state.x_count = 990;
  EXPECT_TRUE(odometer.update(state));
  EXPECT_NEAR(odometer.pose().x, 0.09, 1e-12);
}

}  // namespace
}  // namespace drivers::p2os
