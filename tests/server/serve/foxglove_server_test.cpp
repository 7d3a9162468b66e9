// tests/server/serve/foxglove_server_test.cpp: the hub behind the real server, over loopback
// sockets.
#include <string>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/serve/foxglove/hub.hpp"

namespace server::foxglove {
namespace {

using net::test::Frame;
using net::test::RunningServer;
using net::test::WsTestClient;
using nlohmann::json;

class FoxgloveServer : public testing::Test {
 protected:
  FoxgloveServer() {
    channel_ = hub_.add_channel({"/telemetry", "tautline.wire.Frame"});
    hub_.add_service("/reset", [](ClientId, const json&, const ServiceReply& reply) {
      reply.success({{"ok", true}});
    });
    hub_.on_client_gone([this](ClientId) { ++gone_; });
    running_.server.add(hub_.endpoint("/ws"));
    running_.start();
  }
  static json read_text(WsTestClient& client) {
    const Frame frame = client.read();
    return frame.opcode == 1 ? json::parse(frame.payload) : json();
  }
  void greet(WsTestClient& client) {
    for (const char* op : {"serverInfo", "advertise", "advertiseServices"}) {
      ASSERT_EQ(op, read_text(client).at("op"));
    }
  }
  bool publish(const std::string& text) {
    return running_.on_io([&] {
      hub_.publish(channel_, 1, std::make_shared<const std::string>(text));
      return hub_.wanted(channel_);
    });
  }

  Hub hub_{};
  ChannelId channel_ = 0;
  int gone_ = 0;  // io thread only
  RunningServer running_{};
};

TEST_F(FoxgloveServer, SubscribesReceivesCallsAndLeaves) {
  {
    WsTestClient client(running_.port(), "foxglove.sdk.v1");
    greet(client);
    client.send_text(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]})");
    ASSERT_TRUE(net::test::eventually(
        [&] { return running_.on_io([&] { return hub_.wanted(channel_); }); }));
    EXPECT_TRUE(publish("frame"));
    const Frame frame = client.read();
    EXPECT_EQ(2, frame.opcode);
    EXPECT_EQ(std::string("\x01\x07\0\0\0\x01\0\0\0\0\0\0\0", 13) + "frame", frame.payload);

    client.send_binary(std::string("\x02\x01\0\0\0\x05\0\0\0\x04\0\0\0json{}", 19));
    EXPECT_EQ(std::string("\x03\x01\0\0\0\x05\0\0\0\x04\0\0\0json", 17) + R"({"ok":true})",
              client.read().payload);
  }
  EXPECT_TRUE(net::test::eventually([&] { return running_.on_io([&] { return gone_; }) == 1; }));
  EXPECT_FALSE(publish("nobody listens"));
}

TEST_F(FoxgloveServer, TenMalformedMessagesAreStatusMessagesOnOneConnection) {
  WsTestClient client(running_.port());
  greet(client);
  const std::vector<std::string> texts{"", "{", "[]", R"({"op":"dance"})", std::string(5000, '[')};
  const std::vector<std::string> binaries{
      "", "\x01", "\x02\x01", "\x7f", std::string("\x02\x01\0\0\0\x05\0\0\0\xff\xff\xff\xff", 13)};
  for (const std::string& text : texts) {
    client.send_text(text);
    EXPECT_EQ("status", read_text(client).value("op", "")) << text.substr(0, 50);
  }
  for (const std::string& binary : binaries) {
    client.send_binary(binary);
    EXPECT_EQ("status", read_text(client).value("op", "")) << binary.size();
  }
  client.send_text(R"({"op":"getParameters","parameterNames":[],"id":"x"})");
  EXPECT_EQ("parameterValues", read_text(client).at("op"));
}

}  // namespace
}  // namespace server::foxglove
