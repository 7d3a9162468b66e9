// tests/drivers/emulators/p2os_emulator_test.cpp: the emulated Pioneer base against its manual.
#include "drivers/emulators/p2os_emulator.hpp"

#include <numbers>

#include "tests/drivers/emulators/talk.hpp"
#include "tests/drivers/hex.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/p2os_protocol.hpp"

namespace drivers::p2os {
namespace {

using emulators::Host;
using emulators::WheelMotion;

const char* const kSync0 = "FA FB 03 00 00 00";
const char* const kSync1 = "FA FB 03 01 00 01";
const char* const kSync2 = "FA FB 03 02 00 02";  // and CLOSE
const char* const kEnable = "FA FB 06 04 3B 01 00 05 3B";
const char* const kForward = "FA FB 06 0B 3B C8 00 D3 3B";  // 200 mm/s

std::vector<Bytes> bodies(const Bytes& bytes) {
  std::vector<Bytes> found;
  PacketReader reader;
  reader.feed(
      bytes,
      [&](ByteView packet) { found.push_back(bytes_of(body_of(packet))); },
      [](std::uint8_t) {});
  return found;
}

std::vector<State> states(const Bytes& bytes) {
  std::vector<State> found;
  for (const Bytes& body : bodies(bytes)) {
    State state;
    if (decode_state(body, state)) found.push_back(state);
  }
  return found;
}

/// A base with a session open and the motors on, in a world without obstacles.
class Driven {
 public:
  explicit Driven(const EmulatorOptions& options = {}) : device(options), host(device) {
    for (const char* packet : {kSync0, kSync1, kSync2, kSync1}) host.ask(hex(packet), 0.1);
    host.ask(hex(kEnable), 0.05);
  }

  /// Advances by `seconds`; the wheels follow the motors unless they are blocked.
  Bytes drive(double seconds, bool blocked = false) {
    Bytes got;
    for (int i = 0; i < static_cast<int>(seconds / kStep + 0.5); ++i) {
      const WheelMotion motion = device.drive(host.now());
      senses.motion = blocked ? WheelMotion{} : motion;
      senses.left_travel += senses.motion.left * kStep;
      senses.right_travel += senses.motion.right * kStep;
      device.feel(senses, host.now());
      append(got, host.listen(kStep));
    }
    return got;
  }
  double speed() { return (device.drive(host.now()).left + device.drive(host.now()).right) / 2; }

  static constexpr double kStep = 0.005;
  Emulator device;
  Host host;
  emulators::BaseSenses senses{};
};

TEST(P2osEmulator, EchoesTheHandshakeInOrderAndNamesItself) {
  Emulator device;
  Host host(device);
  EXPECT_EQ(host.ask(hex(kSync1), 0.5), Bytes{});  // not first
  EXPECT_EQ(host.ask(hex(kSync0), 0.2), hex(kSync0));
  EXPECT_EQ(host.ask(hex(kSync2), 0.2), Bytes{});  // out of order: begins anew
  EXPECT_EQ(host.ask(hex(kSync1), 0.2), Bytes{});
  EXPECT_EQ(host.ask(hex(kSync0), 0.2), hex(kSync0));
  EXPECT_EQ(host.ask(hex(kSync1), 0.2), hex(kSync1));
  const Bytes names = host.ask(hex(kSync2), 0.2);
  EXPECT_NE(emulators::text(names).find("p3dx-sh"), std::string::npos);
  EXPECT_EQ(host.listen(1.0), Bytes{});  // OPEN has not come
  EXPECT_EQ(states(host.ask(hex(kSync1), 1.05)).size(), 10U);
  EXPECT_TRUE(device.open());
  host.ask(hex(kSync2), 0.2);
  EXPECT_FALSE(device.open());
  EXPECT_EQ(host.listen(1.0), Bytes{});
}

TEST(P2osEmulator, APacketWithAWrongSumIsDroppedSilently) {
  Driven base;
  base.host.ask(hex("FA FB 06 0B 3B C8 00 D3 3C"), 0.05);
  EXPECT_EQ(base.device.bad_packets(), 1U);
  base.drive(0.5);
  EXPECT_EQ(base.speed(), 0);
}

TEST(P2osEmulator, MovesOnlyWithMotorsOn) {
  Driven base;
  base.host.ask(hex("FA FB 06 04 3B 00 00 04 3B"), 0.05);
  base.host.ask(hex(kForward), 0.05);
  base.drive(1);
  EXPECT_EQ(base.speed(), 0);
  base.host.ask(hex(kEnable), 0.05);
  base.drive(0.5);
  EXPECT_EQ(base.speed(), 0);  // the earlier command was dropped
  base.host.ask(hex(kForward), 0.05);
  base.drive(1);
  EXPECT_NEAR(base.speed(), 0.2, 1e-9);
}

TEST(P2osEmulator, AcceleratesAsConfigured) {
  Driven base;
  base.host.ask(hex("FA FB 06 05 3B 2C 01 31 3C"), 0.05);  // 300 mm/s2
  base.drive(0.01);
  base.host.ask(hex(kForward), 0.02);
  const double before = base.host.now();
  base.drive(0.3);
  EXPECT_NEAR(base.speed(), 0.3 * (base.host.now() - before), 0.012);
}

TEST(P2osEmulator, WheelSpeedsAndTurns) {
  Driven base;
  base.host.ask(hex("FA FB 06 20 3B 0A F6 2B 31"), 0.05);  // right 200, left -200 mm/s
  base.drive(1.5);
  const WheelMotion motion = base.device.drive(base.host.now());
  EXPECT_NEAR(motion.right, 0.2, 1e-9);
  EXPECT_NEAR(motion.left, -0.2, 1e-9);
  base.host.ask(hex("FA FB 06 0B 3B 00 00 0B 3B"), 0.05);
  base.host.ask(hex("FA FB 06 15 3B 1E 00 33 3B"), 0.05);  // 30 deg/s to the left
  base.drive(1.5);
  const WheelMotion turn = base.device.drive(base.host.now());
  EXPECT_NEAR(turn.right, 30 * std::numbers::pi / 180 * 0.165, 1e-9);
}

TEST(P2osEmulator, WatchdogStopsItUntilTheNextCommand) {
  Driven base;
  base.host.ask(hex(kForward), 0.02);
  base.drive(1.9);
  EXPECT_NEAR(base.speed(), 0.2, 1e-9);
  base.drive(1.2);  // 2 s of silence, then the ramp
  EXPECT_EQ(base.speed(), 0);
  EXPECT_TRUE(base.device.motors_on());
  base.host.ask(hex(kForward), 0.02);
  base.drive(1.5);
  base.host.ask(hex(kSync0), 0.02);  // PULSE
  base.drive(1.5);
  EXPECT_NEAR(base.speed(), 0.2, 1e-9);
}

TEST(P2osEmulator, TheStopButtonTurnsTheMotorsOffUntilEnabledAgain) {
  Driven base;
  base.host.ask(hex(kForward), 0.02);
  base.drive(1);
  base.device.press_stop_button(true);
  const std::vector<State> pressed = states(base.drive(0.5));
  ASSERT_FALSE(pressed.empty());
  EXPECT_TRUE(pressed.back().stop_button());
  EXPECT_FALSE(pressed.back().motors_on());
  EXPECT_EQ(base.speed(), 0);
  base.host.ask(hex(kEnable), 0.05);
  EXPECT_FALSE(base.device.motors_on());
  base.device.press_stop_button(false);
  base.host.ask(hex(kEnable), 0.05);
  EXPECT_TRUE(base.device.motors_on());
}

TEST(P2osEmulator, ReportsItsPositionAndWrapsItsCounters) {
  EmulatorOptions options;
  options.first_x_mm = 0x7FFF - 100;
  Driven base(options);
  base.host.ask(hex(kForward), 0.02);
  std::vector<State> seen;
  Odometer odometer;
  for (int i = 0; i < 6; ++i) {
    base.host.ask(hex(kForward), 0.001);
    const Bytes sent = base.drive(1);
    for (const State& state : states(sent)) {
      EXPECT_TRUE(odometer.update(state));
      seen.push_back(state);
    }
    EXPECT_EQ(bodies(sent).back()[0], 0x33);  // moving
  }
  ASSERT_GT(seen.size(), 50U);
  EXPECT_NEAR(seen.front().x_count, 0x7FFF - 100, 20);
  EXPECT_LT(seen.back().x_count, 2000);
  EXPECT_NEAR(odometer.pose().x, base.senses.left_travel, 0.03);
  EXPECT_NEAR(seen.back().left_speed, 0.2, 1e-3);
  EXPECT_NEAR(seen.back().volts, 12.6, 1e-9);
}

TEST(P2osEmulator, BumpersStopTheBaseWhenConfigured) {
  Driven base;
  base.host.ask(hex("FA FB 06 2C 3B 03 00 2F 3B"), 0.02);  // BUMPSTALL 3
  base.host.ask(hex(kForward), 0.02);
  base.drive(1);
  base.device.press_bumper(true);
  const std::vector<State> hit = states(base.drive(1));
  ASSERT_FALSE(hit.empty());
  EXPECT_NE(hit.back().front_bumpers, 0);
  EXPECT_EQ(base.speed(), 0);

  Driven blocked;
  blocked.host.ask(hex(kForward), 0.02);
  const std::vector<State> stalled = states(blocked.drive(1.4, true));
  EXPECT_TRUE(std::ranges::any_of(stalled, [](const State& s) { return s.left_stalled; }));
}

TEST(P2osEmulator, SonarReadingsComeOnceAndNotWhenOff) {
  Driven base;
  base.drive(0.2);
  base.senses.echoes = {{.index = 3, .range = 1.5}};
  base.device.feel(base.senses, base.host.now());
  base.senses.echoes.clear();
  const std::vector<State> got = states(base.drive(0.3));
  ASSERT_EQ(got.size(), 3U);
  ASSERT_EQ(got[0].sonar_count, 1U);
  EXPECT_EQ(got[0].sonars[0], (SonarReading{3, 1.5}));
  EXPECT_EQ(got[1].sonar_count, 0U);
  base.host.ask(hex("FA FB 06 1C 3B 00 00 1C 3B"), 0.02);
  base.senses.echoes = {{.index = 3, .range = 1.5}};
  base.device.feel(base.senses, base.host.now());
  base.senses.echoes.clear();
  for (const State& state : states(base.drive(0.3))) EXPECT_EQ(state.sonar_count, 0U);
}

TEST(P2osEmulator, ChangesItsRate) {
  Driven base;
  base.host.ask(hex("FA FB 06 32 3B 04 00 36 3B"), 0.05);
  EXPECT_EQ(base.device.baud(), 115200U);
}

}  // namespace
}  // namespace drivers::p2os
