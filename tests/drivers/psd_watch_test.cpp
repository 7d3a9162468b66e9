// tests/drivers/psd_watch_test.cpp: counts that stand still, and a clock that jumps.
#include "drivers/psd_watch.hpp"

#include <random>

#include <gtest/gtest.h>

namespace drivers::psd {
namespace {

/// Counts with noise; those of `still` do not move.
class Counts {
 public:
  Reading next(unsigned still = 0, unsigned share = 100) {
    for (std::size_t i = 0; i < kSensors; ++i) {
      if (((still >> i) & 1U) != 0 || random_() % 100 >= share) continue;
      reading_.counts[i] = static_cast<std::uint16_t>((reading_.counts[i] + 1) % 4096);
    }
    return reading_;
  }

 private:
  std::mt19937_64 random_{5};
  Reading reading_{0, {100, 200, 300, 400}};
};

TEST(StuckWatch, OneStillCountAmongLiveOnesIsFoundInTime) {
  for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
    Counts counts;
    StuckWatch watch;
    for (int i = 0; i < 100; ++i) watch.see(counts.next());
    EXPECT_FALSE(watch.stuck());
    for (std::size_t i = 1; i < StuckWatch::kReadings; ++i) {
      watch.see(counts.next(1U << sensor));
      EXPECT_FALSE(watch.stuck()) << i;
    }
    watch.see(counts.next(1U << sensor));
    EXPECT_EQ(watch.stuck(), sensor);
    EXPECT_FALSE(watch.frozen());
    watch.see(counts.next());
    EXPECT_FALSE(watch.stuck());
  }
}

TEST(StuckWatch, AllStillCountsAreAFrozenConverter) {
  Counts counts;
  StuckWatch watch;
  watch.see(counts.next());
  for (std::size_t i = 0; i < StuckWatch::kReadings; ++i) {
    EXPECT_FALSE(watch.frozen()) << i;
    watch.see(counts.next(15));
  }
  EXPECT_TRUE(watch.frozen());
  EXPECT_FALSE(watch.stuck());
  watch.restart();
  EXPECT_FALSE(watch.frozen());
}

/// Where counts change seldom, one that does not is no sign of a fault.
TEST(StuckWatch, AQuietAdapterIsNotStuck) {
  Counts counts;
  StuckWatch watch;
  for (int i = 0; i < 2000; ++i) {
    watch.see(counts.next(0, 30));
    EXPECT_FALSE(watch.stuck() || watch.frozen()) << i;
  }
}

TEST(ClockWatch, StepsOfTheTwoClocksAreCompared) {
  ClockWatch watch;
  watch.see(10.0, 4'294'967'290U);
  watch.see(10.04, 34);  // wrapped after 6 ms
  watch.see(10.30, 72);  // held back by this computer
  watch.see(10.30, 110);
  watch.see(10.31, 340);
  watch.see(12.31, 2340);  // a long silence
  EXPECT_EQ(watch.jumps(), 0U);
  EXPECT_FALSE(watch.jump(12.31));
  watch.see(12.35, 4380);
  ASSERT_TRUE(watch.jump(12.36));
  EXPECT_NEAR(*watch.jump(12.36), 2.0, 1e-9);
  EXPECT_TRUE(watch.jump(12.35 + ClockWatch::kDistrust));
  EXPECT_FALSE(watch.jump(12.36 + ClockWatch::kDistrust));
}

TEST(ClockWatch, AClockThatStandsOrGoesBackJumps) {
  ClockWatch watch;
  watch.see(10.0, 1000);
  watch.see(10.04, 1000);
  EXPECT_EQ(watch.jumps(), 1U);
  watch.see(10.08, 1040);
  EXPECT_EQ(watch.jumps(), 1U);
  watch.see(10.12, 38);  // restarted
  EXPECT_EQ(watch.jumps(), 2U);
  EXPECT_NEAR(*watch.jump(10.2), -1.042, 1e-9);
}

}  // namespace
}  // namespace drivers::psd
