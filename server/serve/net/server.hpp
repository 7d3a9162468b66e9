// server/serve/net/server.hpp: HTTP and WebSocket on one port and one thread; hides Beast.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "server/serve/net/access.hpp"
#include "server/serve/net/router.hpp"
#include "server/serve/net/websocket.hpp"

namespace server::net {

struct Limits {
  std::size_t connections = 2048;             // fewer if the system allows fewer files
  std::size_t connections_per_address = 256;  // an IPv6 /64 is one address
  std::size_t connections_kept = 64;          // of all, for this machine and for drivers
  std::size_t header_bytes = 8192;
  std::size_t body_bytes = 1u << 20;
  std::size_t frame_bytes = 1u << 20;       // of one WebSocket message
  std::size_t control_messages = 1024;      // unsent control messages of one client
  std::size_t control_bytes = 4u << 20;     // their bytes
  std::size_t unsent_kernel_bytes = 32768;  // stale frames of a slow client in the kernel
};

struct Timeouts {
  std::chrono::milliseconds header{10'000};       // from first byte (or connect) to complete header
  std::chrono::milliseconds body{30'000};         // complete body; also a response, plus its size
  std::chrono::milliseconds idle{60'000};         // between two requests
  std::chrono::milliseconds ws_silence{30'000};   // WebSocket: closed without a sign of life
  std::chrono::milliseconds ws_ping{15'000};      // pinged after this time of silence
  std::chrono::milliseconds ws_stalled{300'000};  // one write without progress, peer alive
  std::chrono::milliseconds closing{2'000};       // closing handshakes and lingering closes
};

struct ServerOptions {
  std::string address = "127.0.0.1";  // an IP address or "localhost"
  std::uint16_t port = 8080;          // 0: any free port, see Server::port()
  AccessOptions access{};
  std::filesystem::path web_root{};  // the built page; empty: none
  Limits limits{};
  Timeouts timeouts{};
  /// Runs a job, such as reading a file, on another thread. Empty: on the io thread.
  std::function<void(std::function<void()>)> offload{};
  /// Called on the io thread with each log line. May be empty.
  std::function<void(std::string_view)> log{};
};

/// The server cannot be set up; what() gives the reason and a remedy.
class ServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Everything runs on the thread that calls run(): handlers, callbacks, timers. Only post() and
/// stop() may be called from other threads. Add routes and endpoints before run().
class Server {
 public:
  /// Opens the port, so that port() is known and clients may already connect. They are answered
  /// once run() runs. Throws ServerError: address not usable, port taken, or an address beyond
  /// loopback without a token or insecure.
  explicit Server(ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  Router& router();
  void add(WsEndpoint endpoint);

  std::uint16_t port() const;
  /// "http://127.0.0.1:8080/", with the real port.
  std::string url() const;

  /// Serves until stop(), then tells WebSocket clients (1001) and closes everything. When it
  /// returns, on_close has been called for every on_open.
  void run();
  void stop();
  /// Runs `fn` on the io thread, soon.
  void post(std::function<void()> fn);
  /// Runs `fn` on the io thread every `period` > 0, by absolute deadlines; missed ones are skipped.
  /// Call before run() or on the io thread. An exception from `fn` is logged.
  void every(std::chrono::milliseconds period, std::function<void()> fn);

  /// Runs `fn` once on the io thread, `delay` from now. Call as every().
  void after(std::chrono::milliseconds delay, std::function<void()> fn);
  /// A function that any thread may call to have `fn` run on the io thread, soon. It allocates
  /// nothing and never blocks; calls before `fn` runs count as one. Create it before run(); the
  /// server must outlive its calls. Throws ServerError if the system has no more files.
  std::function<void()> bell(std::function<void()> fn);

  /// Open connections, HTTP and WebSocket. Io thread only.
  std::size_t connections() const;
  /// Their limit, which the system may have lowered.
  std::size_t most_connections() const;
  const Access& access() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server::net
