// tests/server/serve/viewer.hpp: a viewer at the program's WebSocket.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <nlohmann/json.hpp>

namespace server {

using namespace std::chrono_literals;
using net::test::WsTestClient;

/// A viewer that has read the greetings and knows channels and services by name.
class Viewer {
 public:
  explicit Viewer(std::uint16_t port) : client(port) {
    while (channels.empty() || services.empty()) {
      const net::test::Frame frame = client.read();
      if (frame.opcode < 0) return;
      if (frame.opcode != 1) continue;
      const json message = json::parse(frame.payload);
      if (message["op"] == "advertise") {
        for (const json& c : message["channels"]) channels[c["topic"]] = c["id"];
      }
      if (message["op"] == "advertiseServices") {
        for (const json& s : message["services"]) services[s["name"]] = s["id"];
      }
    }
  }
  void subscribe(const std::string& topic) const {
    const json message = {{"op", "subscribe"},
                          {"subscriptions", {{{"id", 1}, {"channelId", channels.at(topic)}}}}};
    client.send_text(message.dump());
  }
  /// A frame of subscription 1 comes within a second or two.
  bool receives() {
    for (int i = 0; i < 500; ++i) {
      const net::test::Frame frame = client.read(2s);
      if (frame.opcode < 0) return false;
      if (frame.opcode == 2 && !frame.payload.empty() && frame.payload[0] == 1) return true;
    }
    return false;
  }
  /// The payloads of messages of subscription 1, until there are `count` or none comes any more.
  std::vector<std::string> messages(std::size_t count) {
    constexpr std::size_t kHeader = 13;  // opcode, subscription, time
    std::vector<std::string> out;
    while (out.size() < count) {
      const net::test::Frame frame = client.read(2s);
      if (frame.opcode < 0) break;
      if (frame.opcode != 2 || frame.payload.size() < kHeader || frame.payload[0] != 1) continue;
      out.push_back(frame.payload.substr(kHeader));
    }
    return out;
  }
  /// The sentence of the next status message or service failure; empty when none comes.
  std::string complaint() {
    for (int i = 0; i < 500; ++i) {
      const net::test::Frame frame = client.read(2s);
      if (frame.opcode < 0 || frame.opcode == 8) return {};
      if (frame.opcode != 1) continue;
      const json message = json::parse(frame.payload);
      if (message["op"] == "status" || message["op"] == "serviceCallFailure") {
        return message["message"];
      }
    }
    return {};
  }

  WsTestClient client;
  std::map<std::string, std::uint32_t> channels{};
  std::map<std::string, std::uint32_t> services{};
};

}  // namespace server
