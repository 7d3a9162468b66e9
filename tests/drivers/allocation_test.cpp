// tests/drivers/allocation_test.cpp: after the first scans, reading and decoding allocate nothing.
#include "tests/algo/allocations.hpp"
#include "tests/drivers/lms200_telegrams.hpp"
#include <gtest/gtest.h>

#include "drivers/lms200_scan.hpp"
#include "drivers/p2os_protocol.hpp"
#include "drivers/psd_machine.hpp"
#include "drivers/roboteq_protocol.hpp"

namespace drivers {
namespace {

TEST(DriverAllocations, ScanStreamAllocatesNothing) {
  const Bytes stream = lms200::scan_361();
  const lms200::ScanDecoder decoder({180, 50}, lms200::WordFormat{});
  lms200::TelegramReader reader;
  algo::LaserScan scan;
  int scans = 0;
  const auto on_frame = [&](ByteView frame) {
    const auto values = lms200::measured_values(lms200::telegram_of(frame));
    if (values && decoder.decode(*values, scan)) ++scans;
  };
  const auto on_stray = [](std::uint8_t) {};
  reader.feed(stream, on_frame, on_stray);
  const std::size_t before = allocations::count();
  for (int i = 0; i < 10; ++i) reader.feed(stream, on_frame, on_stray);
  EXPECT_EQ(allocations::count(), before);
  EXPECT_EQ(scans, 11);
}

TEST(DriverAllocations, MotorControllersAllocateNothing) {
  const Bytes body = hex("32 19x00");
  const std::string_view text = "C=3546:-1787\rFF=16\rS=100:-50\r";
  const ByteView lines(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  p2os::State base;
  roboteq::State controller;
  roboteq::LineReader reader;
  const std::size_t before = allocations::count();
  EXPECT_TRUE(p2os::decode_state(body, base));
  EXPECT_GT(p2os::velocity({.v = 0.2, .omega = 0}, {1, 1}).velocity.size(), 0U);
  EXPECT_GT(roboteq::drive(1, 2).size(), 0U);
  reader.feed(lines, [&](std::string_view line) {
    roboteq::update(controller, roboteq::parse_reply(line));
  });
  EXPECT_EQ(allocations::count(), before);
  EXPECT_TRUE(controller.counts);
}

TEST(DriverAllocations, FloorSensorsAllocateNothing) {
  psd::PsdMachine machine{psd::PsdSetup{}};
  machine.opened(100, 115'200);
  algo::FloorRanges ranges;
  const std::size_t before = allocations::count();
  for (std::uint16_t i = 0; i < 100; ++i) {
    const double now = 100 + i * psd::kPeriod;
    const std::uint16_t count = static_cast<std::uint16_t>(1200 + i % 2);
    machine.receive(
        now,
        psd::line_of({static_cast<std::uint32_t>(38 * i), {count, 1300, count, count}}).view());
    machine.advance(now);
    EXPECT_TRUE(machine.take(ranges));
    EXPECT_EQ(machine.state(now).faulty, i >= psd::StuckWatch::kReadings);
  }
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
}  // namespace drivers
