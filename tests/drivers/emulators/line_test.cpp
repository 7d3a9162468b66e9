// tests/drivers/emulators/line_test.cpp: byte times, faults and wrong rates.
#include "drivers/emulators/line.hpp"

#include "tests/drivers/hex.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::emulators {
namespace {

Bytes left_by(Line& line, double now) {
  Bytes out;
  for (std::size_t before = 1; before != out.size();) {
    before = out.size();
    line.leave(now, out);
  }
  return out;
}

TEST(Line, EveryByteTakesTenBitTimes) {
  Line line(9600);
  const Sending sending = line.say(hex("01 02 03"), 1.0);
  EXPECT_DOUBLE_EQ(sending.begin, 1.0);
  EXPECT_NEAR(sending.end, 1.0 + 30.0 / 9600, 1e-12);
  EXPECT_TRUE(sending.intact);
  EXPECT_EQ(left_by(line, 1.0 + 9.9 / 9600), Bytes{});
  EXPECT_EQ(left_by(line, 1.0 + 20.1 / 9600), hex("01 02"));
  EXPECT_EQ(left_by(line, 2.0), hex("03"));
}

TEST(Line, TelegramsAreSentOneAfterAnother) {
  Line line(9600);
  line.say(hex("01"), 1.0);
  const Sending second = line.say(hex("02"), 1.0);
  EXPECT_NEAR(second.begin, 1.0 + 10.0 / 9600, 1e-12);
}

TEST(Line, AbortedBytesNeverArrive) {
  Line line(9600);
  line.say(hex("01 02 03"), 0);
  EXPECT_TRUE(line.cut(15.0 / 9600));
  EXPECT_EQ(left_by(line, 1.0), hex("01"));
  EXPECT_FALSE(line.cut(2.0));
}

TEST(Line, BytesBeingSentKeepTheirRate) {
  Line line(9600);
  line.say(hex("01"), 0);
  line.set_baud(500000);
  line.say(hex("02"), 0);
  Bytes out;
  EXPECT_EQ(line.leave(1.0, out), 9600U);
  EXPECT_EQ(out, hex("01"));
  EXPECT_EQ(line.leave(1.0, out), 500000U);
  EXPECT_EQ(out, hex("01 02"));
}

TEST(Line, BytesFromTheHostArriveOneByOne) {
  Line line(9600);
  line.hear(hex("0A 0B"), 1.0);
  Bytes heard;
  const auto keep = [&](std::uint8_t byte, double) { heard.push_back(byte); };
  line.deliver(1.0 + 10.1 / 9600, keep);
  EXPECT_EQ(heard, hex("0A"));
  EXPECT_EQ(line.quiet(5.0), 0);  // one is still under way
  line.deliver(1.1, keep);
  EXPECT_EQ(heard, hex("0A 0B"));
  EXPECT_NEAR(line.quiet(1.1), 0.1 - 20.0 / 9600, 1e-9);
}

TEST(Line, FaultsOccurAtTheGivenProbability) {
  Line line(500000, 7);
  line.faults.drop = 0.1;
  const Bytes all(10000, 0x55);
  EXPECT_FALSE(line.say(all, 0).intact);
  const double kept = static_cast<double>(left_by(line, 10).size());
  EXPECT_NEAR(kept, 9000, 150);  // five standard deviations

  Line flips(500000, 7);
  flips.faults.flip = 0.1;
  flips.say(all, 0);
  const Bytes got = left_by(flips, 10);
  ASSERT_EQ(got.size(), all.size());
  const auto changed = std::ranges::count_if(got, [](std::uint8_t b) { return b != 0x55; });
  EXPECT_NEAR(static_cast<double>(changed), 1000, 150);
}

TEST(Line, DamageChangesOneByteOfATelegram) {
  Line line(500000, 3);
  line.faults.damage = 0.5;
  const Bytes telegram(100, 0xAA);
  int damaged = 0;
  for (int i = 0; i < 1000; ++i) {
    const bool intact = line.say(telegram, i).intact;
    const Bytes got = left_by(line, i + 0.5);
    EXPECT_EQ(intact, got == telegram);
    if (intact) continue;
    ++damaged;
    const bool lost = got.size() + 1 == telegram.size();
    const auto flipped = std::ranges::count_if(got, [](std::uint8_t b) { return b != 0xAA; });
    EXPECT_TRUE(lost ? flipped == 0 : flipped == 1);
  }
  EXPECT_NEAR(damaged, 500, 80);
}

TEST(Line, SameSeedSameFaults) {
  const auto fate = [](std::uint64_t seed) {
    Line line(9600, seed);
    line.faults = {.drop = 0.2, .flip = 0.2};
    line.say(Bytes(200, 1), 0);
    return left_by(line, 10);
  };
  EXPECT_EQ(fate(5), fate(5));
  EXPECT_NE(fate(5), fate(6));
}

TEST(Misread, TheRightRateReadsTheBytesSent) {
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(misread(all, 9600, 9600), all);
}

TEST(Misread, AnotherRateReadsGarbage) {
  const Bytes telegram = hex("02 00 01 00 31 15 12");
  // One byte at 9600 lasts 52 bytes at 500000, most of them breaks.
  const Bytes fast = misread(telegram, 9600, 500000);
  EXPECT_NE(fast, telegram);
  // Seven bytes at 500000 are over before one at 9600 is.
  const Bytes slow = misread(telegram, 500000, 9600);
  EXPECT_EQ(slow.size(), 1U);
  EXPECT_NE(misread(telegram, 38400, 19200), telegram);
  EXPECT_TRUE(misread({}, 9600, 38400).empty());
}

}  // namespace
}  // namespace drivers::emulators
