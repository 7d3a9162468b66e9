// tests/server/serve/foxglove_hub_test.cpp: subscriptions, events and time of a hub.
#include <string>
#include <vector>

#include "tests/server/serve/foxglove_hub_fixture.hpp"
#include <gtest/gtest.h>

namespace server::foxglove {
namespace {

TEST_F(FoxgloveHub, GreetsWithServerInfoChannelsAndServices) {
  const auto socket = connect(1);
  ASSERT_EQ(3u, socket->texts.size());
  EXPECT_EQ("serverInfo", socket->texts[0].at("op"));
  const json channels = socket->texts[1].at("channels");
  ASSERT_EQ(3u, channels.size());
  EXPECT_EQ("/scan", channels[0].at("topic"));
  EXPECT_EQ("json", channels[0].at("encoding"));
  EXPECT_EQ("flatbuffer", channels[2].at("encoding"));
  EXPECT_EQ("tautline.wire.Frame", channels[2].at("schemaName"));
  EXPECT_EQ(2u, socket->texts[2].at("services").size());
  // The next client gets the same session id; another hub has another one.
  EXPECT_EQ(socket->texts[0].at("sessionId"), connect(2)->texts[0].at("sessionId"));
  Hub other;
  const auto stranger = std::make_shared<FakeSocket>(1);
  other.endpoint("/ws").on_open(stranger);
  EXPECT_NE(socket->texts[0].at("sessionId"), stranger->texts[0].at("sessionId"));
}

TEST_F(FoxgloveHub, SendsToSubscribersByTheirOwnIds) {
  const auto a = greeted(1);
  const auto b = greeted(2);
  EXPECT_FALSE(hub_.wanted(scan_));
  subscribe(*a, 70, scan_);
  subscribe(*b, 9, scan_);
  EXPECT_TRUE(hub_.wanted(scan_));
  EXPECT_FALSE(hub_.wanted(state_));
  hub_.publish(scan_, 5, payload("{}"));
  ASSERT_EQ(1u, a->data.size());
  EXPECT_EQ(message_bytes(70, 5, "{}"), a->data[0].bytes);
  EXPECT_EQ(1u, a->data[0].keep);
  EXPECT_EQ(message_bytes(9, 5, "{}"), b->data.at(0).bytes);

  text(*a, {{"op", "unsubscribe"}, {"subscriptionIds", {70}}});
  EXPECT_EQ(std::vector<std::uint32_t>{scan_}, a->forgotten);
  hub_.publish(scan_, 6, payload("{}"));
  EXPECT_EQ(1u, a->data.size());
  EXPECT_EQ(2u, b->data.size());
  endpoint_.on_close(*b);
  EXPECT_FALSE(hub_.wanted(scan_));
}

TEST_F(FoxgloveHub, ALateSubscriberGetsTheNewestMessageOfEveryChannel) {
  hub_.publish(state_, 3, payload("old"));
  hub_.publish(state_, 4, payload("new"));
  hub_.publish_event(scan_, 4, payload("scan"));
  const auto socket = greeted(1);
  subscribe(*socket, 1, state_);
  subscribe(*socket, 2, scan_);
  subscribe(*socket, 3, telemetry_);  // nothing was ever published there
  ASSERT_EQ(2u, socket->data.size());
  EXPECT_EQ(message_bytes(1, 4, "new"), socket->data[0].bytes);
  EXPECT_EQ(message_bytes(2, 4, "scan"), socket->data[1].bytes);
}

TEST_F(FoxgloveHub, AChannelEncodedOnDemandIsEncodedForItsFirstSubscriber) {
  int encoded = 0;
  Payload now = payload("one");
  const ChannelId strip = hub_.add_channel({"/strip", "foxglove.SceneUpdate", [&] {
                                              ++encoded;
                                              return Stamped{9, now};
                                            }});
  const auto first = greeted(1);
  subscribe(*first, 1, strip);
  EXPECT_EQ(message_bytes(1, 9, "one"), first->data.at(0).bytes);
  const auto second = greeted(2);
  subscribe(*second, 1, strip);  // with a subscriber, the last message sent is the newest
  EXPECT_EQ(message_bytes(1, 9, "one"), second->data.at(0).bytes);
  EXPECT_EQ(1, encoded);
  hub_.publish(strip, 10, payload("two"));
  endpoint_.on_close(*first);
  endpoint_.on_close(*second);
  now = nullptr;  // another run has begun: older messages do not belong to it
  const auto third = greeted(3);
  subscribe(*third, 1, strip);
  EXPECT_TRUE(third->data.empty());
  EXPECT_EQ(2, encoded);
}

TEST_F(FoxgloveHub, AClientThatConnectsAtRestGetsTheRunClock) {
  EXPECT_TRUE(connect(1)->data.empty());
  hub_.broadcast_time(7, steady_clock::now());
  hub_.broadcast_time(8, steady_clock::now());  // too soon to be sent, not to be known
  const auto late = connect(2);
  ASSERT_EQ(1u, late->data.size());
  EXPECT_EQ(std::string("\x02\x08\0\0\0\0\0\0\0", 9), late->data[0].bytes);
}

TEST_F(FoxgloveHub, WrongSubscriptionsAreStatusMessages) {
  const auto socket = greeted(1);
  subscribe(*socket, 1, 99);
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("no channel with id 99"));
  subscribe(*socket, 1, 0);
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("no channel with id 0"));
  subscribe(*socket, 1, scan_);
  EXPECT_TRUE(socket->texts.empty());
  subscribe(*socket, 1, state_);
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("in use"));
  subscribe(*socket, 2, scan_);
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("subscribed already"));
  text(*socket, {{"op", "unsubscribe"}, {"subscriptionIds", {5}}});
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("no subscription 5"));
}

TEST_F(FoxgloveHub, GarbageIsAStatusMessage) {
  const auto socket = greeted(1);
  endpoint_.on_text(*socket, "nonsense");
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("bad JSON"));
  endpoint_.on_text(*socket, std::string(100'000, '['));
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("deeper"));
  endpoint_.on_binary(*socket, "");
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("empty"));
  endpoint_.on_binary(*socket, client_message(4, "{}"));
  EXPECT_NE(std::string::npos, status_of(*socket, 2).find("not advertised"));
}

TEST_F(FoxgloveHub, EventsGoToARingAndDropsAreReportedOncePerEpisode) {
  const ChannelId log = hub_.add_channel({"/log", "foxglove.Log"});
  const auto socket = greeted(1);
  subscribe(*socket, 1, log);
  hub_.publish_event(log, 1, payload("a"));
  EXPECT_EQ(Hub::kEventRing, socket->data.at(0).keep);
  EXPECT_TRUE(socket->texts.empty());
  socket->slow = true;
  hub_.publish_event(log, 2, payload("b"));
  hub_.publish_event(log, 3, payload("c"));
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("Send buffer limit reached"));
  socket->slow = false;
  hub_.publish_event(log, 4, payload("d"));
  socket->slow = true;
  hub_.publish_event(log, 5, payload("e"));
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("Send buffer limit reached"));
}

TEST_F(FoxgloveHub, TimeGoesToAllClientsAtMostTenTimesASecond) {
  const auto socket = greeted(1);
  const steady_clock::time_point start{};
  for (int ms = 0; ms <= 1000; ms += 26) {
    hub_.broadcast_time(static_cast<std::uint64_t>(ms) * 1'000'000, start + milliseconds(ms));
  }
  // Every fourth call, 0, 104, ..., 936: ten.
  ASSERT_EQ(10u, socket->data.size());
  EXPECT_EQ(std::string("\x02\0\0\0\0\0\0\0\0", 9), socket->data[0].bytes);
  // 104 ms = 104000000 ns = 0x0632ea00.
  EXPECT_EQ(std::string("\x02\x00\xea\x32\x06\0\0\0\0", 9), socket->data[1].bytes);
}

TEST_F(FoxgloveHub, TimeIsSentWithTheClientsNextMessage) {
  const auto served = greeted(1);
  const auto idle = greeted(2);
  subscribe(*served, 7, scan_);
  hub_.publish(scan_, 1, payload("x"));
  served->data.clear();
  const steady_clock::time_point start{};
  hub_.broadcast_time(104'000'000, start);
  EXPECT_TRUE(served->data.empty());
  EXPECT_EQ(std::string("\x02\x00\xea\x32\x06\0\0\0\0", 9), served->rider);
  ASSERT_EQ(1U, idle->data.size());
  // Nothing was published since: the time is sent at once, and no rider is needed.
  hub_.broadcast_time(208'000'000, start + milliseconds(104));
  ASSERT_EQ(1U, served->data.size());
  EXPECT_EQ("", served->rider);
}

TEST_F(FoxgloveHub, AnnouncesToAllClients) {
  const auto a = greeted(1);
  const auto b = greeted(2);
  hub_.announce(StatusLevel::Info, "a new run");
  EXPECT_EQ("a new run", status_of(*a, 0));
  EXPECT_EQ("a new run", status_of(*b, 0));
}

TEST_F(FoxgloveHub, RefusesADoubleChannelAndAnUnknownSchema) {
  EXPECT_THROW(hub_.add_channel({"/scan", "foxglove.LaserScan"}), std::invalid_argument);
  EXPECT_THROW(hub_.add_channel({"/x", "foxglove.None"}), std::out_of_range);
  EXPECT_THROW(hub_.publish(99, 0, payload("")), std::out_of_range);
}

}  // namespace
}  // namespace server::foxglove
