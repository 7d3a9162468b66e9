// tests/fuzz/foxglove_fuzz.cpp: the hub answers or ignores any message of a client; it never throws
// and never closes. A line break ends a message; a message that begins with a brace is text.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "server/serve/bridge.hpp"

namespace {

class SilentClient final : public server::net::WsClient {
 public:
  std::uint32_t id() const override { return 1; }
  const std::string& subprotocol() const override { return peer_; }
  const std::map<std::string, std::string>& query() const override { return query_; }
  const server::net::Visitor& who() const override { return who_; }
  bool open() const override { return true; }
  void send_control(server::net::FrameKind, server::net::Payload) override {}
  bool send_latest(std::uint32_t,
                   std::span<const std::byte> header,
                   const server::net::Payload&,
                   std::size_t) override {
    if (header.size() > 16) std::abort();
    return true;
  }
  void ride(std::span<const std::byte> message) override {
    if (message.size() > 16) std::abort();
  }
  void forget(std::uint32_t) override {}
  void close(std::uint16_t, std::string_view) override { std::abort(); }
  server::net::WsCounters counters() const override { return {}; }

 private:
  std::string peer_{"fuzz"};
  server::net::Visitor who_{.role = server::net::Role::Admin};
  std::map<std::string, std::string> query_{};
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static server::Scheduler scheduler(1);
  // Without a run: requests are refused, parsing is the same.
  server::Session session({.scheduler = scheduler});
  server::Bridge bridge(session,
                        {.load = [](const auto&, const auto&) { return false; },
                         .reset = [](const auto&) { return false; }});
  const server::net::WsEndpoint endpoint = bridge.hub().endpoint("/ws");
  const auto client = std::make_shared<SilentClient>();
  endpoint.on_open(client);
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (!rest.empty()) {
    const std::string_view message = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), message.size() + 1));
    if (message.empty()) continue;
    if (message.front() == '{') {
      endpoint.on_text(*client, message);
    } else {
      endpoint.on_binary(*client, message);
    }
  }
  endpoint.on_close(*client);
  return 0;
}
