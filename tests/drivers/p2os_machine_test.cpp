// tests/drivers/p2os_machine_test.cpp: finding, opening, driving and closing a Pioneer base.
#include "drivers/p2os_machine.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "tests/drivers/line_bench.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::p2os {
namespace {

using ::testing::HasSubstr;

/// Echoes greetings, sends states, keeps the commands it received.
class FakePioneer final : public LineDevice {
 public:
  unsigned baud = 9600;
  bool open = false;
  bool mute = false;
  bool stop_button = false;
  bool motors = false;
  unsigned bumpers = 0;
  std::uint16_t x = 0;
  std::uint8_t left_mm_s = 0;
  std::uint8_t right_mm_s = 0;
  std::vector<Bytes> heard{};

  void hear(double now, ByteView bytes, unsigned at) override {
    if (at != baud) return;
    reader_.feed(
        bytes, [&](ByteView packet) { act(now, bytes_of(body_of(packet))); }, [](std::uint8_t) {});
  }
  Bytes say(double now, unsigned host_baud) override {
    Bytes out;
    while (!out_.empty()) {
      append(out, out_.front());
      out_.pop_front();
    }
    if (open && now >= next_state_) {
      next_state_ = now + kStatePeriod;
      append(out, state());
    }
    return host_baud == baud && !mute ? out : Bytes{};
  }
  bool was_told(const Bytes& body) const {
    return std::find(heard.begin(), heard.end(), body) != heard.end();
  }

 private:
  static Bytes framed(const Bytes& body) {
    Bytes packet{0xFA, 0xFB, static_cast<std::uint8_t>(body.size() + 2)};
    append(packet, body);
    const std::uint16_t sum = checksum(ByteView(body));
    packet.push_back(static_cast<std::uint8_t>(sum >> 8U));
    packet.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
    return packet;
  }
  Bytes state() const {
    const unsigned flags = (motors ? 1U : 0U) | (stop_button ? 0x20U : 0U);
    return framed({0x32,
                   static_cast<std::uint8_t>(x & 0xFFU),
                   static_cast<std::uint8_t>(x >> 8U),
                   0,
                   0,
                   0,
                   0,
                   left_mm_s,
                   0,
                   right_mm_s,
                   0,
                   124,
                   static_cast<std::uint8_t>(bumpers & 0xFFU),
                   static_cast<std::uint8_t>(bumpers >> 8U),
                   0,
                   0,
                   static_cast<std::uint8_t>(flags & 0xFFU),
                   static_cast<std::uint8_t>(flags >> 8U),
                   0,
                   1,
                   3,
                   0xDC,
                   0x05});
  }
  void act(double now, const Bytes& body) {
    heard.push_back(body);
    if (!open && body.size() == 1 && body[0] <= 1) out_.push_back(framed(body));
    if (!open && body == Bytes{2}) {
      Bytes echo{2};
      for (const char c : std::string("Robby\0Pioneer\0p3dx-sh", 21)) {
        echo.push_back(static_cast<std::uint8_t>(c));
      }
      echo.push_back(0);
      out_.push_back(framed(echo));
      synced_ = true;
      return;
    }
    if (synced_ && body == Bytes{1}) {
      open = true;
      synced_ = false;
      out_.clear();
      next_state_ = now + kStatePeriod;
    }
    if (open && body == Bytes{2}) open = false;
    if (body.size() == 4 && body[0] == 4) motors = body[2] == 1 && !stop_button;
  }

  PacketReader reader_{};
  std::deque<Bytes> out_{};
  bool synced_ = false;
  double next_state_ = 0;
};

struct Fixture {
  Fixture() : machine(PioneerSetup{}), bench(machine, device) { bench.open(); }
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  bool running(double seconds = 5) {
    return bench.run_until(seconds, [&] { return machine.state().running; });
  }
  /// The packets that the device receives during `action`.
  template <class Action>
  std::vector<Bytes> told(Action&& action) {
    device.heard.clear();
    action();
    bench.settle();
    return device.heard;
  }
  FakePioneer device{};
  PioneerMachine machine;
  LineBench bench;
};

const Bytes kVelocityZero{11, 0x3B, 0, 0};
const Bytes kTurnZero{21, 0x3B, 0, 0};
const Bytes kEmergencyStop{55};
const Bytes kMotorsOff{4, 0x3B, 0, 0};
const Bytes kClose{2};

TEST(P2osMachine, HandshakeOpensTheBaseWithItsMotorsOff) {
  Fixture f;
  ASSERT_TRUE(f.running());
  EXPECT_TRUE(f.device.was_told({4, 0x3B, 0, 0}));
  EXPECT_FALSE(f.device.was_told({4, 0x3B, 1, 0}));
  EXPECT_THAT(f.machine.report(f.bench.now()).facts[2].second, HasSubstr("p3dx-sh"));
  EXPECT_DOUBLE_EQ(*f.machine.state().volts, 12.4);
  EXPECT_EQ(f.machine.state().sonar_count, 4U);
  EXPECT_DOUBLE_EQ(f.machine.state().sonars[3].range, 1.5);
}

TEST(P2osMachine, OldSessionIsClosedFirst) {
  Fixture f;
  f.device.open = true;
  ASSERT_TRUE(f.running());
  EXPECT_TRUE(f.device.was_told({2}));
}

TEST(P2osMachine, BaseIsFoundAtEveryRate) {
  for (const unsigned rate : {38400U, 57600U}) {
    Fixture f;
    f.device.baud = rate;
    EXPECT_TRUE(f.running(15)) << rate;
  }
}

TEST(P2osMachine, SendsMotionOnlyOnATick) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.machine.enable(f.bench.now(), true);
  f.machine.drive(f.bench.now(), {0.05, 0});
  f.bench.settle();
  f.device.heard.clear();
  f.bench.run(3);  // the base's own watchdog would have stopped it
  EXPECT_TRUE(f.device.heard.empty());
}

TEST(P2osMachine, SpeedsGoOutInMillimetresAndDegrees) {
  Fixture f;
  ASSERT_TRUE(f.running());
  const auto told = f.told([&] { f.machine.drive(f.bench.now(), {0.04, -0.1}); });
  EXPECT_THAT(told, ::testing::ElementsAre(Bytes{11, 0x3B, 40, 0}, Bytes{21, 0x1B, 6, 0}));
}

TEST(P2osMachine, ClampsToTheLimitsAndStopsOnNaN) {
  Fixture f;
  ASSERT_TRUE(f.running());
  auto told = f.told([&] { f.machine.drive(f.bench.now(), {9, 0}); });
  EXPECT_EQ(told[0], (Bytes{11, 0x3B, 100, 0}));
  f.bench.run(0.2);
  told = f.told([&] { f.machine.drive(f.bench.now(), {std::nan(""), 0}); });
  EXPECT_EQ(told[0], kVelocityZero);
}

TEST(P2osMachine, RepeatsAnUnchangedCommandAt10HzAndSendsAStopAtOnce) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.bench.settle();
  f.device.heard.clear();
  for (int tick = 0; tick < 40; ++tick) {  // one second of ticks
    f.machine.drive(f.bench.now(), {0.05, 0});
    f.bench.run(0.025);
  }
  EXPECT_NEAR(static_cast<double>(f.device.heard.size()), 20, 2);  // two packets each
  f.machine.drive(f.bench.now(), {0.06, 0});
  f.bench.settle();
  const auto told = f.told([&] { f.machine.drive(f.bench.now(), {}); });
  EXPECT_THAT(told, ::testing::ElementsAre(kVelocityZero, kTurnZero));
}

TEST(P2osMachine, PositionContinuesOverTheCounterWrap) {
  Fixture f;
  f.device.x = 32700;
  ASSERT_TRUE(f.running());
  f.device.x = 32;  // 100 mm on, modulo 2^15
  f.bench.run(0.2);
  EXPECT_NEAR(f.machine.state().pose.x, 0.1, 1e-9);
}

TEST(P2osMachine, StopButtonBumpersAndMotorsAreReported) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.machine.enable(f.bench.now(), true);
  f.bench.settle();
  f.bench.run(0.2);
  EXPECT_TRUE(f.machine.state().motors_on);
  f.device.stop_button = true;
  f.device.motors = false;
  f.device.bumpers = 0x0402;  // a front and a rear one
  f.bench.run(0.2);
  EXPECT_TRUE(f.machine.state().stop_button);
  EXPECT_FALSE(f.machine.state().motors_on);
  EXPECT_TRUE(f.machine.state().bumper_front);
  EXPECT_TRUE(f.machine.state().bumper_rear);
  EXPECT_THAT(f.machine.report(f.bench.now()).sentence, HasSubstr("stop button"));
}

TEST(P2osMachine, ReportsSilenceAndFindsTheBaseAgain) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.device.mute = true;
  f.bench.run(2);
  EXPECT_FALSE(f.machine.state().running);
  f.device.mute = false;
  ASSERT_TRUE(f.running(15));
  EXPECT_EQ(f.machine.state().set_ups, 2U);
}

TEST(P2osMachine, RepeatsTheEmergencyStopAsPacketsMayBeLost) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.machine.enable(f.bench.now(), true);
  f.machine.drive(f.bench.now(), {0.05, 0});
  f.bench.settle();
  const auto at_once = f.told([&] { f.machine.halt(f.bench.now()); });
  EXPECT_THAT(at_once, ::testing::ElementsAre(kEmergencyStop));
  const auto later = f.told([&] {
    for (int tick = 0; tick < 8; ++tick) {  // 0.4 s of ticks that are held
      f.bench.run(0.05);
      f.machine.halt(f.bench.now());
      f.bench.settle();
    }
    // A zero command from a controller does not soften the braking.
    f.bench.run(0.1);
    f.machine.drive(f.bench.now(), {});
  });
  EXPECT_THAT(later, ::testing::Each(kEmergencyStop));
  EXPECT_GE(later.size(), 4U);
  f.bench.run(0.05);
  const auto on = f.told([&] { f.machine.drive(f.bench.now(), {0.05, 0}); });
  ASSERT_FALSE(on.empty());
  EXPECT_EQ(on[0], (Bytes{11, 0x3B, 50, 0}));
}

TEST(P2osMachine, MotorsGoOffOnceTheWheelsStand) {
  Fixture f;
  ASSERT_TRUE(f.running());
  f.machine.enable(f.bench.now(), true);
  f.bench.settle();
  f.device.left_mm_s = f.device.right_mm_s = 100;
  f.bench.run(0.2);
  auto told = f.told([&] { f.machine.enable(f.bench.now(), false); });
  EXPECT_THAT(told, ::testing::ElementsAre(kEmergencyStop));
  // It ignores commands meanwhile.
  told = f.told([&] { f.machine.drive(f.bench.now(), {0.1, 0}); });
  EXPECT_THAT(told, ::testing::IsEmpty());
  told = f.told([&] { f.bench.run(0.2); });
  EXPECT_THAT(told, ::testing::Each(kEmergencyStop));
  f.device.left_mm_s = f.device.right_mm_s = 0;
  told = f.told([&] { f.bench.run(0.15); });
  EXPECT_THAT(told, ::testing::Contains(kMotorsOff));
  // GIVEN wheels that keep turning WHEN braking takes too long THEN the motors go off anyway.
  f.machine.enable(f.bench.now(), true);
  f.bench.settle();
  f.device.left_mm_s = 100;
  f.bench.run(0.2);
  told = f.told([&] {
    f.machine.enable(f.bench.now(), false);
    f.bench.run(braking_time({}) + 0.01);
  });
  EXPECT_EQ(told.back(), kMotorsOff);
  // The motors of a base that does not obey are cut at once.
  f.machine.enable(f.bench.now(), true);
  f.bench.run(0.2);
  told = f.told([&] { f.machine.cut(f.bench.now()); });
  EXPECT_EQ(told.back(), kMotorsOff);
}

TEST(P2osMachine, LeavesItAtRestSwitchedOffAndClosed) {
  Fixture f;
  ASSERT_TRUE(f.running());
  auto told = f.told([&] { f.machine.leave(f.bench.now()); });
  EXPECT_THAT(told, ::testing::ElementsAre(kEmergencyStop, kMotorsOff, kClose));
  EXPECT_TRUE(f.machine.left());
  // A driving base must come to rest first.
  Fixture g;
  ASSERT_TRUE(g.running());
  g.machine.enable(g.bench.now(), true);
  g.bench.settle();
  g.device.left_mm_s = 100;
  g.bench.run(0.2);
  told = g.told([&] {
    g.machine.leave(g.bench.now());
    g.bench.run(0.15);
  });
  EXPECT_THAT(told, ::testing::ElementsAre(kEmergencyStop, kEmergencyStop));
  EXPECT_FALSE(g.machine.left());
  g.device.left_mm_s = 0;
  told = g.told([&] { g.bench.run(0.2); });
  ASSERT_GE(told.size(), 2U);
  EXPECT_EQ(told[told.size() - 2], kMotorsOff);
  EXPECT_EQ(told.back(), kClose);
  EXPECT_TRUE(g.machine.left());
}

}  // namespace
}  // namespace drivers::p2os
