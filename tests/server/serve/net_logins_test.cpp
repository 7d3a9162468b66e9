// tests/server/serve/net_logins_test.cpp: guesses and cookies, with a simulated clock.
#include <string>

#include <gtest/gtest.h>

#include "server/serve/net/logins.hpp"

namespace server::net {
namespace {

using namespace std::chrono_literals;

Address from(const std::string& text) {
  return Address::parse(text).value();
}

TEST(NetGuesses, TenAtOnceAndOneEveryFiveSeconds) {
  Clock::time_point now{};
  GuessThrottle throttle(now);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(throttle.wrong(from("10.0.0.1"), now).wait) << i;
  EXPECT_EQ(5s, throttle.wrong(from("10.0.0.1"), now).wait);
  EXPECT_EQ(5s, throttle.wrong(from("10.0.0.1"), now).wait);
  now += 5s;
  EXPECT_FALSE(throttle.wrong(from("10.0.0.1"), now).wait);
  EXPECT_TRUE(throttle.wrong(from("10.0.0.1"), now).wait);
  EXPECT_FALSE(throttle.wrong(from("10.0.0.2"), now).wait) << "another visitor";
  now += 10min;  // no more than ten are ever saved up
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(throttle.wrong(from("10.0.0.1"), now).wait) << i;
  EXPECT_TRUE(throttle.wrong(from("10.0.0.1"), now).wait);
}

TEST(NetGuesses, GuessesFasterThanAPersonAreNotChecked) {
  Clock::time_point now{};
  GuessThrottle throttle(now);
  int looked_at = 0;
  for (int i = 0; i < 10'000; ++i, now += 1ms) {  // ten seconds of a thousand guesses a second
    if (throttle.may_look(from("10.0.0.1"), now)) ++looked_at;
    throttle.wrong(from("10.0.0.1"), now);
  }
  EXPECT_LE(looked_at, 50 + 10 * 10 + 1);
  EXPECT_TRUE(throttle.may_look(from("10.0.0.2"), now));
  now += 1s;
  EXPECT_TRUE(throttle.may_look(from("10.0.0.1"), now));
}

TEST(NetGuesses, AnIpv6VisitorCountsOnceAndManyAddressesTakeNoMoreMemory) {
  Clock::time_point now{};
  GuessThrottle throttle(now);
  for (int i = 0; i < 10; ++i) throttle.wrong(from("2001:db8:0:1::" + std::to_string(i)), now);
  EXPECT_TRUE(throttle.wrong(from("2001:db8:0:1::99"), now).wait);
  EXPECT_EQ(1u, throttle.addresses());
  for (int i = 0; i < 20'000; ++i) {
    throttle.wrong(from("10." + std::to_string(i >> 16) + '.' + std::to_string(i >> 8 & 255) + '.' +
                        std::to_string(i & 255)),
                   now);
  }
  EXPECT_EQ(GuessThrottle::kAddresses, throttle.addresses());
  EXPECT_TRUE(throttle.wrong(from("192.0.2.1"), now).wait) << "beyond them all share one account";
  EXPECT_TRUE(throttle.may_look(from("192.0.2.2"), now)) << "the right token still passes";
  now += 1min;
  EXPECT_FALSE(throttle.wrong(from("192.0.2.1"), now).wait) << "those who stopped are forgotten";
}

TEST(NetGuesses, TheLogIsLimitedPerAddressAndInTotal) {
  Clock::time_point now{};
  GuessThrottle throttle(now);
  EXPECT_EQ("A wrong token came from 10.0.0.1.", throttle.wrong(from("10.0.0.1"), now).line);
  for (int i = 0; i < 30; ++i) EXPECT_EQ("", throttle.wrong(from("10.0.0.1"), now).line);
  EXPECT_EQ("", throttle.overdue(now));
  now += 60s;
  EXPECT_EQ("30 wrong tokens came from 10.0.0.1.", throttle.overdue(now));
  EXPECT_EQ("", throttle.overdue(now));
  int lines = 0;
  for (int i = 0; i < 200; ++i) {
    if (!throttle.wrong(from("10.0.1." + std::to_string(i)), now).line.empty()) ++lines;
  }
  EXPECT_LE(lines, 20);
  now += 60s;
  EXPECT_EQ("Somebody at 10.0.0.9 has logged in as viewer.",
            throttle.right(from("10.0.0.9"), Role::Viewer, now));
}

TEST(NetLoginSessions, LastWhileTheyAreUsed) {
  Clock::time_point now{};
  LoginSessions logins;
  const std::string id = logins.open(Role::Operator, now);
  EXPECT_EQ(32u, id.size());
  now += LoginSessions::kIdle;
  EXPECT_TRUE(logins.use(id, now));
  EXPECT_FALSE(logins.use("", now));
  EXPECT_FALSE(logins.use(id.substr(1), now));
  now += LoginSessions::kIdle - 1s;
  logins.keep(id, now);  // a WebSocket is open
  now += 2s;
  EXPECT_TRUE(logins.use(id, now));
  EXPECT_TRUE(logins.renew(id, now));
  EXPECT_FALSE(logins.renew(id, now + 1h));
  now += LoginSessions::kIdle + 1s;
  EXPECT_FALSE(logins.use(id, now));
  logins.keep(id, now - 2 * LoginSessions::kIdle);
}

TEST(NetLoginSessions, ViewersDisplaceNoOperator) {
  Clock::time_point now{};
  LoginSessions logins;
  const std::string driver = logins.open(Role::Operator, now);
  for (int i = 0; i < 1000; ++i) logins.open(Role::Viewer, now += 1s);
  EXPECT_EQ(Role::Operator, logins.use(driver, now));
}

TEST(NetLoginSessions, TheLeastRecentlyUsedIsDroppedWhenFull) {
  Clock::time_point now{};
  LoginSessions logins;
  const std::string driver = logins.open(Role::Operator, now);
  const std::string idle = logins.open(Role::Operator, now);
  for (int i = 0; i < 300; ++i) {
    now += 1s;
    logins.keep(driver, now);
    logins.open(Role::Operator, now);
  }
  EXPECT_EQ(256u, logins.size());
  EXPECT_TRUE(logins.use(driver, now));
  EXPECT_FALSE(logins.use(idle, now));
}

}  // namespace
}  // namespace server::net
