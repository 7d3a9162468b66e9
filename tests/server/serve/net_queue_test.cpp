// tests/server/serve/net_queue_test.cpp: order, fairness and bounds of one client's send queue.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/serve/net/send_queue.hpp"

namespace server::net {
namespace {

Payload text(const std::string& value) {
  return std::make_shared<const std::string>(value);
}

Outgoing control(const std::string& value) {
  Outgoing message;
  message.kind = FrameKind::Text;
  message.payload = text(value);
  return message;
}

/// All messages in the order in which they would be written.
std::vector<std::string> drain(SendQueue& queue) {
  std::vector<std::string> out;
  Outgoing message;
  while (queue.next(message)) out.push_back(*message.payload);
  return out;
}

using Texts = std::vector<std::string>;

TEST(NetSendQueue, ControlComesFirstAndInOrder) {
  SendQueue queue({});
  queue.push_latest(1, {}, text("data"), 1);
  EXPECT_TRUE(queue.push_control(control("a")));
  EXPECT_TRUE(queue.push_control(control("b")));
  EXPECT_EQ((Texts{"a", "b", "data"}), drain(queue));
}

TEST(NetSendQueue, TheLatestMessageOfAKeyReplacesTheOlderAtItsPlace) {
  SendQueue queue({});
  EXPECT_TRUE(queue.push_latest(1, {}, text("one old"), 1));
  EXPECT_TRUE(queue.push_latest(2, {}, text("two"), 1));
  EXPECT_FALSE(queue.push_latest(1, {}, text("one new"), 1));
  EXPECT_EQ(1u, queue.dropped());
  EXPECT_EQ((Texts{"one new", "two"}), drain(queue));
}

TEST(NetSendQueue, ABusyKeyDoesNotStarveAnother) {
  SendQueue queue({});
  Texts sent;
  Outgoing message;
  queue.push_latest(1, {}, text("busy"), 1);
  queue.push_latest(2, {}, text("rare"), 1);
  for (int i = 0; i < 3 && queue.next(message); ++i) {
    sent.push_back(*message.payload);
    queue.push_latest(1, {}, text("busy"), 1);
  }
  EXPECT_EQ((Texts{"busy", "rare", "busy"}), sent);
}

TEST(NetSendQueue, ARingKeepsTheNewestInOrderAndTakesTurns) {
  SendQueue queue({});
  for (int i = 0; i < 5; ++i) {
    // 0, 1, 2 fit; 3 and 4 push out 0 and 1.
    EXPECT_EQ(i < 3, queue.push_latest(1, {}, text("e" + std::to_string(i)), 3));
  }
  queue.push_latest(2, {}, text("state"), 1);
  EXPECT_EQ((Texts{"e2", "state", "e3", "e4"}), drain(queue));
}

TEST(NetSendQueue, ARingMayGrow) {
  SendQueue queue({});
  queue.push_latest(1, {}, text("a"), 2);
  queue.push_latest(1, {}, text("b"), 2);
  queue.push_latest(1, {}, text("c"), 2);  // b, c with the oldest not at the front of the memory
  queue.push_latest(1, {}, text("d"), 4);
  EXPECT_EQ((Texts{"b", "c", "d"}), drain(queue));
}

TEST(NetSendQueue, CountsWaitingMessages) {
  SendQueue queue({});
  const std::array<std::byte, 13> header{};
  queue.push_latest(1, header, text("12345"), 1);
  queue.push_control(control("123"));
  EXPECT_EQ(2u, queue.messages());
  EXPECT_EQ(13u + 5u + 3u, queue.bytes());
  queue.push_latest(1, header, text("1"), 1);
  EXPECT_EQ(13u + 1u + 3u, queue.bytes());
  queue.forget(1);
  EXPECT_EQ(3u, queue.bytes());
  EXPECT_EQ((Texts{"123"}), drain(queue));
  EXPECT_EQ(0u, queue.bytes());
  EXPECT_EQ(0u, queue.messages());
}

TEST(NetSendQueue, AForgottenKeyCanBeUsedAgain) {
  SendQueue queue({});
  queue.push_latest(1, {}, text("old"), 1);
  queue.forget(1);
  queue.push_latest(1, {}, text("new"), 1);
  EXPECT_EQ((Texts{"new"}), drain(queue));
}

TEST(NetSendQueue, ControlIsBoundedInMessagesAndBytes) {
  SendQueue few({.control_messages = 2, .control_bytes = 1000});
  EXPECT_TRUE(few.push_control(control("1")));
  EXPECT_TRUE(few.push_control(control("2")));
  EXPECT_FALSE(few.push_control(control("3")));
  SendQueue small({.control_messages = 100, .control_bytes = 10});
  EXPECT_TRUE(small.push_control(control("1234567890")));
  EXPECT_FALSE(small.push_control(control("1")));
  Outgoing out;
  EXPECT_TRUE(small.next(out));
  EXPECT_TRUE(small.push_control(control("1")));
}

TEST(NetSendQueue, RefusesALongHeader) {
  SendQueue queue({});
  const std::array<std::byte, 17> header{};
  EXPECT_THROW(queue.push_latest(1, header, text(""), 1), std::invalid_argument);
}

TEST(NetSubprotocol, IsTheFirstAcceptedOneOffered) {
  const std::vector<std::string> accepted{"a", "b"};
  EXPECT_EQ("a", choose_subprotocol(accepted, {"b", "a"}));
  EXPECT_EQ("b", choose_subprotocol(accepted, {"c", "b"}));
  EXPECT_EQ("", choose_subprotocol(accepted, {"ab", "A", ""}));
}

}  // namespace
}  // namespace server::net
