// server/net/server.hpp: HTTP and WebSocket on one port and one thread; Beast stays behind it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/net/router.hpp"

namespace server::net {

/// The server cannot start: what() says why and what to do.
class ServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  // 0: any free one
  std::string token{};        // asked for when set
  bool insecure = false;      // beyond loopback without a token
  std::vector<std::string> allow_hosts{};    // further names in the Host header
  std::vector<std::string> allow_origins{};  // further origins, "https://viewer.example"
  std::filesystem::path web_root{};

  std::size_t max_connections = 1200;
  std::size_t max_header = 8 * 1024;    // [bytes]
  std::size_t max_body = 1024 * 1024;   // [bytes]
  std::size_t max_frame = 1024 * 1024;  // [bytes] of a WebSocket message
  std::chrono::milliseconds header_timeout{10'000};
  std::chrono::milliseconds body_timeout{30'000};
  std::chrono::milliseconds idle_timeout{60'000};
  std::chrono::milliseconds websocket_idle{30'000};  // pinged at half of it
};

/// One WebSocket peer. All calls on the io thread. Calls after it has gone do nothing.
class WsClient {
 public:
  virtual ~WsClient() = default;
  virtual std::uint64_t id() const = 0;
  virtual bool loopback() const = 0;

  /// Queues a message that must arrive; a peer that lets too many pile up is disconnected.
  virtual void send_text(std::shared_ptr<const std::string> text) = 0;
  virtual void send_binary(std::shared_ptr<const std::string> bytes) = 0;

  /// Puts a message into the slot `key`: the newest replaces one that has not gone out yet, so that
  /// a slow peer costs no memory and delays nobody. `header` (at most 16 bytes) is sent before
  /// `payload`, which all peers share. False when it replaced an unsent one.
  virtual bool send_latest(std::uint64_t key,
                           std::span<const std::byte> header,
                           std::shared_ptr<const std::string> payload) = 0;
  virtual void drop_latest(std::uint64_t key) = 0;
  virtual void close(std::string_view reason) = 0;
};

struct WsHandlers {
  std::function<void(const std::shared_ptr<WsClient>&)> on_open{};
  std::function<void(const std::shared_ptr<WsClient>&, bool binary, std::string_view)> on_message{};
  std::function<void(const std::shared_ptr<WsClient>&)> on_close{};
};

class Server {
 public:
  /// Binds and listens; throws ServerError when it may not or cannot. `router` and the handlers are
  /// called on the thread of run() and must outlive it.
  Server(ServerOptions options, const Router& router, WsHandlers handlers);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// "http://127.0.0.1:8080": what a browser on this machine is given.
  std::string url() const;

  void run();   // until stop()
  void stop();  // from any thread or a signal watcher
  void post(std::function<void()> work);  // from any thread, done on the io thread
  /// Calls `work` again and again on the io thread. Before run().
  void every(std::chrono::milliseconds period, std::function<void()> work);
  /// `on_signal` on SIGINT and SIGTERM, on the io thread.
  void on_termination(std::function<void()> on_signal);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server::net
