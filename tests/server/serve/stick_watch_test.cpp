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

constexpr std::uint64_t kAnnsLink = 1;
const StickWatch::Time kStickStart{seconds(1000)};
const algo::Joystick kMiddle{};
const algo::Joystick kPushed{0.5, 0};

StickStamp at(std::uint64_t sequence, StickWatch::Time sent) {
  return {sequence, clock_seconds(sent)};
}

/// A client that has let go of its stick once.
StickWatch watch() {
  StickWatch out;
  out.connected(kAnnsLink, kStickStart);
  EXPECT_FALSE(out.refusal(kAnnsLink, kMiddle, {}, kStickStart));
  return out;
}

TEST(StickWatchTest, NothingResumesAfterAConnection) {
  StickWatch sticks;
  sticks.connected(kAnnsLink, kStickStart);
  // A stick that is pushed all the time stays barred, however long.
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(sticks.refusal(kAnnsLink, kPushed, {}, kStickStart + milliseconds(50 * i))) << i;
  }
  EXPECT_EQ(sticks.dropped().barred, 100U);
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kMiddle, {}, kStickStart + seconds(5)));
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kPushed, {}, kStickStart + seconds(5)));
}

TEST(StickWatchTest, ASecondOfSilenceIsTheMiddle) {
  StickWatch sticks;
  sticks.connected(kAnnsLink, kStickStart);
  EXPECT_TRUE(sticks.refusal(kAnnsLink, kPushed, {}, kStickStart + milliseconds(900)));
  EXPECT_TRUE(sticks.refusal(kAnnsLink, kPushed, {}, kStickStart + milliseconds(1800)));
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kPushed, {}, kStickStart + milliseconds(2800)));
}

TEST(StickWatchTest, NoneOlderThanHalfASecondIsObeyed) {
  StickWatch sticks = watch();
  EXPECT_FALSE(
      sticks.refusal(kAnnsLink, kPushed, at(1, kStickStart), kStickStart + milliseconds(500)));
  const auto late =
      sticks.refusal(kAnnsLink, kPushed, at(2, kStickStart), kStickStart + milliseconds(601));
  EXPECT_THAT(late.value_or(""), HasSubstr("0.6 s old"));
  EXPECT_EQ(sticks.dropped().late, 1U);
  // Those behind it are young, but the hand has not let go since.
  const auto now = kStickStart + milliseconds(650);
  EXPECT_THAT(sticks.refusal(kAnnsLink, kPushed, at(3, now), now).value_or(""),
              HasSubstr("middle"));
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kMiddle, at(4, now), now));
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kPushed, at(5, now), now));
}

TEST(StickWatchTest, OneFromTheFutureSaysThatTheClocksDiffer) {
  StickWatch sticks = watch();
  EXPECT_FALSE(
      sticks.refusal(kAnnsLink, kPushed, at(1, kStickStart + milliseconds(90)), kStickStart));
  const auto why = sticks.refusal(kAnnsLink, kPushed, at(2, kStickStart + seconds(3)), kStickStart);
  EXPECT_THAT(why.value_or(""), HasSubstr("clock"));
}

TEST(StickWatchTest, AnOlderOneThatComesLaterIsDropped) {
  StickWatch sticks = watch();
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kPushed, at(7, kStickStart), kStickStart));
  EXPECT_TRUE(sticks.refusal(kAnnsLink, kPushed, at(6, kStickStart), kStickStart));
  EXPECT_TRUE(sticks.refusal(kAnnsLink, kPushed, at(7, kStickStart), kStickStart));
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kPushed, at(8, kStickStart), kStickStart));
  EXPECT_EQ(sticks.dropped().out_of_order, 2U);
  // Counting starts again with another connection.
  sticks.gone(kAnnsLink);
  sticks.connected(kAnnsLink, kStickStart);
  EXPECT_FALSE(sticks.refusal(kAnnsLink, kMiddle, at(1, kStickStart), kStickStart));
}

TEST(StickWatchTest, AScriptIsJudgedByAgeAlone) {
  StickWatch sticks;
  EXPECT_FALSE(sticks.refusal(0, kPushed, {}, kStickStart));
  EXPECT_TRUE(sticks.refusal(0, kPushed, at(1, kStickStart), kStickStart + seconds(1)));
  EXPECT_FALSE(sticks.refusal(0, kPushed, at(1, kStickStart), kStickStart));
}

}  // namespace
}  // namespace server
