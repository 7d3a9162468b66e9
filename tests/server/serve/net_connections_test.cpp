// tests/server/serve/net_connections_test.cpp: limits on connections, without sockets.
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "server/serve/net/connections.hpp"

namespace server::net {
namespace {

using namespace std::chrono_literals;
using Room = Connections::Room;
using Kind = Connections::Kind;

struct FakeConnection final : Connection {
  explicit FakeConnection(std::optional<Clock::time_point> since) : idle(since) {}
  void check(Clock::time_point) override {}
  void go_away() override {}
  void abort() noexcept override { open = false; }
  std::optional<Clock::time_point> idle_since(Clock::time_point) const override { return idle; }
  std::optional<Clock::time_point> idle;
  bool open = true;
};
using Fake = std::shared_ptr<FakeConnection>;

Address at(const std::string& text) {
  return Address::parse(text).value();
}

class NetConnections : public testing::Test {
 protected:
  /// An accepted connection, idle from now on; null when there was no room.
  Fake enter(const std::string& from, Kind kind = Kind::Request, bool busy = false) {
    now_ += 1ms;
    room_ = open_.make_room(at(from), false, now_);
    if (room_ != Room::Yes) return nullptr;
    const auto made = std::make_shared<FakeConnection>(busy ? std::nullopt : std::optional(now_));
    last_ = open_.add(made, at(from), kind, false);
    return made;
  }

  Clock::time_point now_{};
  Connections open_{{.total = 40, .per_address = 16, .kept = 8}};
  Room room_ = Room::Yes;
  Connections::Number last_ = 0;
};

TEST_F(NetConnections, BeyondItsShareAVisitorReplacesItsOwnLongestIdleConnection) {
  const Fake busy = enter("10.0.0.1", Kind::Request, true);
  const Fake first = enter("10.0.0.1");
  const Fake second = enter("10.0.0.1");
  for (int i = 0; i < 13; ++i) ASSERT_TRUE(enter("10.0.0.1"));
  EXPECT_EQ(16u, open_.size());
  EXPECT_TRUE(enter("10.0.0.1"));
  EXPECT_EQ(16u, open_.size());
  EXPECT_FALSE(first->open);
  EXPECT_TRUE(second->open);
  EXPECT_TRUE(busy->open);
  EXPECT_TRUE(enter("10.0.0.2")->open);
}

TEST_F(NetConnections, OnlyAVisitorWithAllConnectionsInUseIsRefused) {
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(enter("10.0.0.1", Kind::Request, true));
  EXPECT_FALSE(enter("10.0.0.1"));
  EXPECT_EQ(Room::AddressFull, room_);
  EXPECT_TRUE(enter("10.0.0.2"));
}

TEST_F(NetConnections, WhenFullANewcomerReplacesAConnectionOfTheLargestUser) {
  Fake first;
  for (int i = 0; i < 16; ++i) {
    const Fake one = enter("10.0.0.1");
    if (!first) first = one;
  }
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(enter("10.0.0.2"));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(enter("10.0.0.3"));
  EXPECT_EQ(32u, open_.size());  // eight are kept
  EXPECT_TRUE(enter("10.0.0.4"));
  EXPECT_EQ(32u, open_.size());
  EXPECT_FALSE(first->open);
}

TEST_F(NetConnections, RoomIsReservedForThisMachineAndRecentDrivers) {
  for (int i = 0; i < 32; ++i) {  // all of them at work, each for another
    ASSERT_TRUE(enter("10.0.1." + std::to_string(i), Kind::Request, true));
  }
  open_.welcome(at("10.0.0.9"), now_);
  EXPECT_FALSE(enter("10.0.0.1"));
  EXPECT_EQ(Room::ServerFull, room_);
  EXPECT_TRUE(enter("127.0.0.1"));
  EXPECT_TRUE(enter("10.0.0.9"));
  EXPECT_FALSE(enter("10.0.0.8"))
      << "although both are idle: no visitor loses their only connection to another";
  now_ += Connections::kKnownFor + 1s;
  EXPECT_FALSE(enter("10.0.0.8"));
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(enter("::1", Kind::Request, true));
  EXPECT_TRUE(enter("127.0.0.1")) << "in place of the idle one of 10.0.0.9 or of its own";
}

TEST_F(NetConnections, ManyUnknownDriversDoNotFillTheMemory) {
  for (int i = 0; i < 100'000; ++i) {
    now_ += 1ms;
    open_.welcome(at("10." + std::to_string(i >> 16) + '.' + std::to_string(i >> 8 & 255) + '.' +
                     std::to_string(i & 255)),
                  now_);
  }
  for (int i = 0; i < 32; ++i) {
    ASSERT_TRUE(enter("172.16.1." + std::to_string(i), Kind::Request, true));
  }
  EXPECT_TRUE(enter("10.1.134.159")) << "the newest is known";
  EXPECT_FALSE(enter("10.0.0.0"));
}

TEST_F(NetConnections, AnAddressKeepsPlacesForRequestsBesideItsSockets) {
  for (int i = 0; i < 14; ++i) {
    EXPECT_TRUE(open_.may_open_socket(at("10.0.0.1")));
    ASSERT_TRUE(enter("10.0.0.1", Kind::WebSocket, true));
  }
  EXPECT_FALSE(open_.may_open_socket(at("10.0.0.1")));
  EXPECT_TRUE(open_.may_open_socket(at("10.0.0.2")));
  EXPECT_TRUE(enter("10.0.0.1"));
  open_.remove(1);
  EXPECT_TRUE(open_.may_open_socket(at("10.0.0.1")));
}

TEST_F(NetConnections, AProxysConnectionCountsForItsClient) {
  const Address proxy = at("10.9.9.9");
  std::vector<Connections::Number> numbers;
  for (int i = 0; i < 20; ++i) {  // more than one address may have
    ASSERT_EQ(Room::Yes, open_.make_room(proxy, true, now_));
    numbers.push_back(
        open_.add(std::make_shared<FakeConnection>(std::nullopt), proxy, Kind::Request, true));
  }
  const Address client = at("10.0.0.1");
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(Room::Yes, open_.charge(numbers[i], client, now_));
  }
  EXPECT_EQ(Room::AddressFull, open_.charge(numbers[16], client, now_));
  EXPECT_EQ(Room::Yes, open_.charge(numbers[16], at("10.0.0.2"), now_));
  open_.release(numbers[0]);
  EXPECT_EQ(Room::Yes, open_.charge(numbers[17], client, now_));
  for (const auto number : numbers) open_.remove(number);
  EXPECT_TRUE(open_.empty());
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(enter("10.0.0.1")) << "nothing is left in the books";
}

TEST_F(NetConnections, TheLogReportsItOnceAMinute) {
  for (int i = 0; i < 100; ++i) enter("10.0.0.1");
  EXPECT_EQ("84 connections were closed or refused to make room for others, lately of 10.0.0.1.",
            open_.report(now_));
  enter("10.0.0.1");
  EXPECT_EQ("", open_.report(now_));
  now_ += 1min;
  EXPECT_NE("", open_.report(now_));
  EXPECT_EQ("", open_.report(now_ + 1min));
}

}  // namespace
}  // namespace server::net
