// tests/server/serve/foxglove_hub_fixture.hpp: a hub with clients that only record its messages.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/serve/foxglove/hub.hpp"

namespace server::foxglove {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// A socket that keeps its messages; `slow` makes it drop like a full ring.
class FakeSocket final : public net::WsClient {
 public:
  explicit FakeSocket(std::uint32_t id, net::Role role = net::Role::Operator)
      : id_(id), who_{.role = role} {}
  std::uint32_t id() const override { return id_; }
  const std::string& subprotocol() const override { return peer_; }
  const std::map<std::string, std::string>& query() const override { return query_; }
  const net::Visitor& who() const override { return who_; }
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
  net::Visitor who_;
  std::string peer_{"fake"};
  std::map<std::string, std::string> query_{};
};

/// k_r from 0 to 1, and a read-only text.
class Gains final : public ParameterSource {
 public:
  std::vector<Parameter> list() const override {
    return {{"k_r", k_r, "float64"}, {"controller", "modified", ""}};
  }
  std::string set(ClientId /*client*/, const std::string& name, const json& value) override {
    if (name == "controller") return "is read only";
    if (name != "k_r") return "is not a parameter";
    if (!value.is_number() || value < 0 || value > 1) return "must be from 0 to 1";
    k_r = value;
    return "";
  }
  double k_r = 0.6;
};

inline std::string message_bytes(std::uint32_t subscription,
                                 std::uint64_t t_ns,
                                 const std::string& text) {
  const MessageHeader header = message_header(subscription, t_ns);
  return std::string(reinterpret_cast<const char*>(header.data()), header.size()) + text;
}

inline Payload payload(const std::string& text) {
  return std::make_shared<const std::string>(text);
}

inline std::string service_request(std::uint32_t service,
                                   std::uint32_t call,
                                   const std::string& body) {
  // Same layout as the response, another opcode.
  std::string bytes = service_response(service, call, "json", body);
  bytes[0] = 2;
  return bytes;
}

inline std::string client_message(std::uint32_t channel, const std::string& body) {
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
  /// The same for a viewer, who only watches.
  std::shared_ptr<FakeSocket> viewer(std::uint32_t id) {
    const auto socket = std::make_shared<FakeSocket>(id, net::Role::Viewer);
    endpoint_.on_open(socket);
    socket->texts.clear();
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

}  // namespace server::foxglove
