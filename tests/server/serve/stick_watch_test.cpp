// tests/server/serve/stick_watch_test.cpp: late, disordered and resumed sticks; the clock is an
// argument.
#include "server/serve/stick_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr std::uint64_t kAnn = 1;
const StickWatch::Time kStart{seconds(1000)};
const algo::Joystick kMiddle{};
const algo::Joystick kPushed{0.5, 0};

StickStamp at(std::uint64_t sequence, StickWatch::Time sent) {
  return {sequence, clock_seconds(sent)};
}

/// A client that has let go of its stick once.
StickWatch watch() {
  StickWatch out;
  out.connected(kAnn, kStart);
  EXPECT_FALSE(out.refusal(kAnn, kMiddle, {}, kStart));
  return out;
}

TEST(StickWatchTest, NothingResumesAfterAConnection) {
  StickWatch sticks;
  sticks.connected(kAnn, kStart);
  // A stick that is pushed all the time stays barred, however long.
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(sticks.refusal(kAnn, kPushed, {}, kStart + milliseconds(50 * i))) << i;
  }
  EXPECT_EQ(sticks.dropped().barred, 100U);
  EXPECT_FALSE(sticks.refusal(kAnn, kMiddle, {}, kStart + seconds(5)));
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, {}, kStart + seconds(5)));
}

TEST(StickWatchTest, ASecondOfSilenceIsTheMiddle) {
  StickWatch sticks;
  sticks.connected(kAnn, kStart);
  EXPECT_TRUE(sticks.refusal(kAnn, kPushed, {}, kStart + milliseconds(900)));
  EXPECT_TRUE(sticks.refusal(kAnn, kPushed, {}, kStart + milliseconds(1800)));
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, {}, kStart + milliseconds(2800)));
}

TEST(StickWatchTest, NoneOlderThanHalfASecondIsObeyed) {
  StickWatch sticks = watch();
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, at(1, kStart), kStart + milliseconds(500)));
  const auto late = sticks.refusal(kAnn, kPushed, at(2, kStart), kStart + milliseconds(601));
  EXPECT_THAT(late.value_or(""), HasSubstr("0.6 s old"));
  EXPECT_EQ(sticks.dropped().late, 1U);
  // Those behind it are young, but the hand has not let go since.
  const auto now = kStart + milliseconds(650);
  EXPECT_THAT(sticks.refusal(kAnn, kPushed, at(3, now), now).value_or(""), HasSubstr("middle"));
  EXPECT_FALSE(sticks.refusal(kAnn, kMiddle, at(4, now), now));
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, at(5, now), now));
}

TEST(StickWatchTest, OneFromTheFutureSaysThatTheClocksDiffer) {
  StickWatch sticks = watch();
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, at(1, kStart + milliseconds(90)), kStart));
  const auto why = sticks.refusal(kAnn, kPushed, at(2, kStart + seconds(3)), kStart);
  EXPECT_THAT(why.value_or(""), HasSubstr("clock"));
}

TEST(StickWatchTest, AnOlderOneThatComesLaterIsDropped) {
  StickWatch sticks = watch();
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, at(7, kStart), kStart));
  EXPECT_TRUE(sticks.refusal(kAnn, kPushed, at(6, kStart), kStart));
  EXPECT_TRUE(sticks.refusal(kAnn, kPushed, at(7, kStart), kStart));
  EXPECT_FALSE(sticks.refusal(kAnn, kPushed, at(8, kStart), kStart));
  EXPECT_EQ(sticks.dropped().out_of_order, 2U);
  // Counting starts again with another connection.
  sticks.gone(kAnn);
  sticks.connected(kAnn, kStart);
  EXPECT_FALSE(sticks.refusal(kAnn, kMiddle, at(1, kStart), kStart));
}

TEST(StickWatchTest, AScriptIsJudgedByAgeAlone) {
  StickWatch sticks;
  EXPECT_FALSE(sticks.refusal(0, kPushed, {}, kStart));
  EXPECT_TRUE(sticks.refusal(0, kPushed, at(1, kStart), kStart + seconds(1)));
  EXPECT_FALSE(sticks.refusal(0, kPushed, at(1, kStart), kStart));
}

}  // namespace
}  // namespace server
