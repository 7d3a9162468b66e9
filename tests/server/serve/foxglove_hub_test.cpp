// tests/server/serve/foxglove_hub_test.cpp: subscriptions, parameters, services and publishing of a
// hub, with clients that only record its messages.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/serve/foxglove/hub.hpp"

namespace server::foxglove {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// A socket that keeps its messages; `slow` makes it drop like a full ring.
class FakeSocket final : public net::WsClient {
 public:
  explicit FakeSocket(std::uint32_t id) : id_(id) {}
  std::uint32_t id() const override { return id_; }
  const std::string& subprotocol() const override { return peer_; }
  const std::map<std::string, std::string>& query() const override { return query_; }
  bool open() const override { return true; }
  void send_control(net::FrameKind kind, Payload payload) override {
    if (kind == net::FrameKind::Text) {
      texts.push_back(json::parse(*payload));
    } else {
      binaries.push_back(*payload);
    }
  }
  bool send_latest(std::uint32_t key,
                   std::span<const std::byte> header,
                   const Payload& payload,
                   std::size_t keep) override {
    std::string bytes(reinterpret_cast<const char*>(header.data()), header.size());
    data.push_back({key, bytes + (payload ? *payload : ""), keep});
    return !slow;
  }
  void ride(std::span<const std::byte> message) override {
    rider.assign(reinterpret_cast<const char*>(message.data()), message.size());
  }
  void forget(std::uint32_t key) override { forgotten.push_back(key); }
  void close(std::uint16_t, std::string_view) override { ADD_FAILURE() << "the hub never closes"; }
  net::WsCounters counters() const override { return {}; }

  struct Data {
    std::uint32_t key = 0;
    std::string bytes{};
    std::size_t keep = 0;
  };
  std::vector<json> texts{};
  std::vector<std::string> binaries{};
  std::vector<Data> data{};
  std::string rider{};  // not taken by a message here
  std::vector<std::uint32_t> forgotten{};
  bool slow = false;

 private:
  std::uint32_t id_;
  std::string peer_{"fake"};
  std::map<std::string, std::string> query_{};
};

/// k_r from 0 to 1, and a read-only text.
class Gains final : public ParameterSource {
 public:
  std::vector<Parameter> list() const override {
    return {{"k_r", k_r, "float64"}, {"controller", "modified", ""}};
  }
  std::string set(const std::string& name, const json& value) override {
    if (name == "controller") return "is read only";
    if (name != "k_r") return "is not a parameter";
    if (!value.is_number() || value < 0 || value > 1) return "must be from 0 to 1";
    k_r = value;
    return "";
  }
  double k_r = 0.6;
};

std::string message_bytes(std::uint32_t subscription, std::uint64_t t_ns, const std::string& text) {
  const MessageHeader header = message_header(subscription, t_ns);
  return std::string(reinterpret_cast<const char*>(header.data()), header.size()) + text;
}

Payload payload(const std::string& text) {
  return std::make_shared<const std::string>(text);
}

std::string service_request(std::uint32_t service, std::uint32_t call, const std::string& body) {
  // Same layout as the response, another opcode.
  std::string bytes = service_response(service, call, "json", body);
  bytes[0] = 2;
  return bytes;
}

std::string client_message(std::uint32_t channel, const std::string& body) {
  return std::string("\x01") + static_cast<char>(channel) + std::string(3, '\0') + body;
}

class FoxgloveHub : public testing::Test {
 protected:
  FoxgloveHub() {
    hub_.set_parameters(gains_);
    hub_.add_service("/double", [](ClientId, const json& request, const ServiceReply& reply) {
      reply.success({{"ok", true}, {"value", 2 * request.at("value").get<int>()}});
    });
    hub_.add_service("/later", [this](ClientId, const json&, const ServiceReply& reply) {
      waiting_.push_back(reply);
    });
    hub_.on_publish("/goal_pose", [this](ClientId client, const json& message) {
      published_.push_back(std::to_string(client) + ' ' + message.dump());
      return message.contains("refuse") ? std::string("the goal lies in an obstacle") : "";
    });
    hub_.on_publisher_gone([this](ClientId client, const std::string& topic) {
      gone_.push_back(std::to_string(client) + ' ' + topic);
    });
    hub_.on_client_gone([this](ClientId client) { gone_.push_back(std::to_string(client)); });
  }

  std::shared_ptr<FakeSocket> connect(std::uint32_t id) {
    const auto socket = std::make_shared<FakeSocket>(id);
    endpoint_.on_open(socket);
    return socket;
  }
  /// A client that has read its greeting.
  std::shared_ptr<FakeSocket> greeted(std::uint32_t id) {
    const auto socket = connect(id);
    socket->texts.clear();
    return socket;
  }
  void text(FakeSocket& socket, const json& op) { endpoint_.on_text(socket, op.dump()); }
  void subscribe(FakeSocket& socket, std::uint32_t id, ChannelId channel) {
    text(socket,
         {{"op", "subscribe"},
          {"subscriptions", json::array({{{"id", id}, {"channelId", channel}}})}});
  }
  void advertise_goal(FakeSocket& socket, std::uint32_t id, const std::string& topic) {
    text(socket,
         {{"op", "advertise"},
          {"channels",
           json::array(
               {{{"id", id}, {"topic", topic}, {"encoding", "json"}, {"schemaName", "x"}}})}});
  }
  /// The only text since the last call, which must be a status.
  std::string status_of(FakeSocket& socket, int level) {
    if (socket.texts.size() != 1) return "texts: " + std::to_string(socket.texts.size());
    const json status = socket.texts[0];
    socket.texts.clear();
    EXPECT_EQ("status", status.at("op"));
    EXPECT_EQ(level, status.at("level"));
    return status.at("message");
  }

  Hub hub_{};
  Gains gains_{};
  net::WsEndpoint endpoint_ = hub_.endpoint("/ws");
  ChannelId scan_ = hub_.add_channel({"/scan", "foxglove.LaserScan"});
  ChannelId state_ = hub_.add_channel({"/state", "tautline.State"});
  ChannelId telemetry_ = hub_.add_channel({"/telemetry", "tautline.wire.Frame"});
  std::vector<ServiceReply> waiting_{};
  std::vector<std::string> published_{};
  std::vector<std::string> gone_{};
};

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

TEST_F(FoxgloveHub, ParametersAreReadWrittenAndWatched) {
  const auto setter = greeted(1);
  const auto watcher = greeted(2);
  const auto other = greeted(3);
  text(*watcher, {{"op", "subscribeParameterUpdates"}, {"parameterNames", json::array()}});
  text(*other, {{"op", "subscribeParameterUpdates"}, {"parameterNames", {"controller", "x"}}});

  text(*setter, {{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", "all"}});
  ASSERT_EQ(1u, setter->texts.size());
  EXPECT_EQ(2u, setter->texts[0].at("parameters").size());
  EXPECT_EQ("all", setter->texts[0].at("id"));
  setter->texts.clear();

  text(*setter,
       {{"op", "setParameters"},
        {"parameters", json::array({{{"name", "k_r"}, {"value", 0.25}}})},
        {"id", "s"}});
  EXPECT_EQ(0.25, gains_.k_r);
  const json values = json::parse(R"([{"name":"k_r","value":0.25,"type":"float64"}])");
  ASSERT_EQ(1u, setter->texts.size());
  EXPECT_EQ(values, setter->texts[0].at("parameters"));
  EXPECT_EQ("s", setter->texts[0].at("id"));
  ASSERT_EQ(1u, watcher->texts.size());
  EXPECT_EQ(values, watcher->texts[0].at("parameters"));
  EXPECT_FALSE(watcher->texts[0].contains("id"));
  EXPECT_TRUE(other->texts.empty());

  text(*watcher, {{"op", "unsubscribeParameterUpdates"}, {"parameterNames", json::array()}});
  gains_.k_r = 0.5;
  hub_.parameters_changed();
  EXPECT_EQ(1u, watcher->texts.size());
  ASSERT_EQ(1u, other->texts.size());
  EXPECT_EQ("controller", other->texts[0].at("parameters").at(0).at("name"));
}

TEST_F(FoxgloveHub, ARefusedParameterIsASentenceAndTheOldValue) {
  const auto socket = greeted(1);
  const std::vector<std::pair<json, std::string>> cases{
      {{{"name", "k_r"}, {"value", 7}}, "k_r: must be from 0 to 1"},
      {{{"name", "k_r"}, {"value", "much"}}, "k_r: must be from 0 to 1"},
      {{{"name", "k_r"}}, "k_r: a parameter cannot be unset"},
      {{{"name", "nothing"}, {"value", 1}}, "nothing: is not a parameter"},
      {{{"name", "controller"}, {"value", "x"}}, "controller: is read only"}};
  for (const auto& [parameter, sentence] : cases) {
    text(*socket, {{"op", "setParameters"}, {"parameters", json::array({parameter})}});
    ASSERT_EQ(2u, socket->texts.size());
    EXPECT_EQ(sentence, socket->texts[0].at("message").get<std::string>());
    EXPECT_EQ(1, socket->texts[0].at("level"));
    EXPECT_EQ("parameterValues", socket->texts[1].at("op"));
    for (const json& value : socket->texts[1].at("parameters")) {
      EXPECT_TRUE(value.at("name") != "k_r" || value.at("value") == 0.6) << value;
    }
    socket->texts.clear();
  }
}

TEST_F(FoxgloveHub, ServicesAnswerNowOrLaterOrFailWithASentence) {
  const auto socket = greeted(1);
  endpoint_.on_binary(*socket, service_request(1, 8, R"({"value":21})"));
  ASSERT_EQ(1u, socket->binaries.size());
  EXPECT_EQ(service_response(1, 8, "json", R"({"ok":true,"value":42})"), socket->binaries[0]);

  endpoint_.on_binary(*socket, service_request(2, 9, ""));
  EXPECT_EQ(1u, socket->binaries.size());
  waiting_.at(0).success({{"ok", true}});
  waiting_.at(0).failure("only the first answer counts");
  waiting_.clear();
  EXPECT_EQ(2u, socket->binaries.size());
  EXPECT_TRUE(socket->texts.empty());

  const auto failure = [&](const std::string& request) -> std::string {
    socket->texts.clear();
    endpoint_.on_binary(*socket, request);
    if (socket->texts.size() != 1) return "";
    EXPECT_EQ("serviceCallFailure", socket->texts[0].at("op"));
    EXPECT_EQ(3, socket->texts[0].at("callId"));
    return socket->texts[0].at("message");
  };
  EXPECT_NE(std::string::npos, failure(service_request(77, 3, "{}")).find("no service with id 77"));
  EXPECT_NE(std::string::npos, failure(service_request(0, 3, "{}")).find("no service with id 0"));
  EXPECT_NE(std::string::npos, failure(service_request(1, 3, "{")).find("bad JSON"));
  EXPECT_NE("", failure(service_request(1, 3, "{}")));  // the handler misses 'value'
  std::string ros = service_response(1, 3, "ros1", "{}");
  ros[0] = 2;
  EXPECT_NE(std::string::npos, failure(ros).find("'ros1'"));

  socket->texts.clear();
  endpoint_.on_binary(*socket, service_request(2, 3, "{}"));
  waiting_.clear();
  ASSERT_EQ(1u, socket->texts.size());
  EXPECT_EQ("the service did not answer", socket->texts[0].at("message"));
}

TEST_F(FoxgloveHub, PublishedMessagesReachTheHandlerAndRefusalsComeBack) {
  const auto socket = greeted(4);
  advertise_goal(*socket, 1, "/goal_pose");
  EXPECT_TRUE(socket->texts.empty());
  endpoint_.on_binary(*socket, client_message(1, R"({"x":1})"));
  EXPECT_EQ(std::vector<std::string>{R"(4 {"x":1})"}, published_);
  EXPECT_TRUE(socket->texts.empty());
  endpoint_.on_binary(*socket, client_message(1, R"({"refuse":1})"));
  EXPECT_EQ("/goal_pose: the goal lies in an obstacle", status_of(*socket, 1));
  endpoint_.on_binary(*socket, client_message(1, "{"));
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("bad JSON"));
  hub_.warn(4, "found out later");
  EXPECT_EQ("found out later", status_of(*socket, 1));
  hub_.warn(5, "nobody");
}

TEST_F(FoxgloveHub, WrongAdvertisementsAreStatusMessages) {
  const auto socket = greeted(1);
  advertise_goal(*socket, 1, "/nowhere");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("'/nowhere'; there are: /goal_pose"));
  text(*socket,
       {{"op", "advertise"},
        {"channels", json::array({{{"id", 1}, {"topic", "/goal_pose"}, {"encoding", "cdr"}}})}});
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("not 'cdr'"));
  advertise_goal(*socket, 1, "/goal_pose");
  advertise_goal(*socket, 1, "/goal_pose");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("in use"));
  text(*socket, {{"op", "unadvertise"}, {"channelIds", {9}}});
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("no channel with id 9"));
  for (std::uint32_t id = 2; id <= 65; ++id) advertise_goal(*socket, id, "/goal_pose");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("at most 64"));
}

TEST_F(FoxgloveHub, ReportsWhenAPublisherOrAClientIsGone) {
  const auto socket = greeted(3);
  advertise_goal(*socket, 1, "/goal_pose");
  advertise_goal(*socket, 2, "/goal_pose");
  text(*socket, {{"op", "unadvertise"}, {"channelIds", {1}}});
  EXPECT_EQ(std::vector<std::string>{"3 /goal_pose"}, gone_);
  endpoint_.on_close(*socket);
  EXPECT_EQ((std::vector<std::string>{"3 /goal_pose", "3 /goal_pose", "3"}), gone_);
  EXPECT_EQ(0u, hub_.clients());
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
