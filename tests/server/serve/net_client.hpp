// tests/server/serve/net_client.hpp: plain-socket HTTP and WebSocket clients and a server on its
// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/serve/net/server.hpp"

namespace server::net::test {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

/// How long a client waits for an answer; sanitizers on a busy machine are slow.
constexpr std::chrono::milliseconds kPatience = 20s;

/// A blocking TCP connection to 127.0.0.1 with the timeout `patience`.
class Client {
 public:
  /// @param receive_buffer  bytes, 0: the system's default
  /// @param from            own address, one of 127.x.y.z; null: the system's choice, 127.0.0.1
  explicit Client(std::uint16_t port, int receive_buffer = 0, const char* from = nullptr)
      : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (from != nullptr) {
      sockaddr_in own{};
      own.sin_family = AF_INET;
      own.sin_addr.s_addr = ::inet_addr(from);
      if (::bind(fd_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
        throw std::runtime_error("cannot connect from that address");
      }
    }
    if (receive_buffer > 0) {
      ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
      throw std::runtime_error("cannot connect to the server under test");
    }
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  Client(Client&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), input_(std::move(other.input_)) {}
  Client& operator=(Client&&) = delete;
  ~Client() { close(); }

  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  /// @return false when the other end has closed
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// Waits for more input. @return false on end of stream or when nothing came in time
  bool receive(std::chrono::milliseconds patience = kPatience) {
    pollfd wait{fd_, POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(patience.count())) <= 0) return false;
    char buffer[65536];
    const ssize_t n = ::recv(fd_, buffer, sizeof buffer, 0);
    if (n <= 0) {
      ended_ = true;
      return false;
    }
    input_.append(buffer, static_cast<std::size_t>(n));
    return true;
  }
  /// Exactly `size` bytes, or nothing.
  std::optional<std::string> take(std::size_t size,
                                  std::chrono::milliseconds patience = kPatience) {
    while (input_.size() < size) {
      if (!receive(patience)) return std::nullopt;
    }
    std::string bytes = input_.substr(0, size);
    input_.erase(0, size);
    return bytes;
  }
  /// All bytes up to and including `end`, or nothing.
  std::optional<std::string> take_through(std::string_view end,
                                          std::chrono::milliseconds patience = kPatience) {
    while (input_.find(end) == std::string::npos) {
      if (!receive(patience)) return std::nullopt;
    }
    return take(input_.find(end) + end.size());
  }
  /// True when the server ends the connection in time; input until then is discarded.
  bool ends_within(std::chrono::milliseconds patience) {
    const auto deadline = steady_clock::now() + patience;
    while (!ended_ && steady_clock::now() < deadline) {
      receive(
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now()) +
          1ms);
    }
    return ended_;
  }
  const std::string& input() const { return input_; }
  /// Its file descriptor, for a reader of many clients.
  int fd() const { return fd_; }

 private:
  int fd_ = -1;
  std::string input_{};
  bool ended_ = false;
};

struct Answer {
  int status = 0;  // 0: none came
  std::map<std::string, std::string> headers{};
  std::string body{};
};

/// Reads one response. `has_body` false for HEAD and 101.
inline Answer read_answer(Client& client, bool has_body = true) {
  Answer answer;
  const auto head = client.take_through("\r\n\r\n");
  if (!head) return answer;
  answer.status = std::atoi(head->substr(9, 3).c_str());
  std::size_t line = head->find("\r\n") + 2;
  while (line < head->size() - 2) {
    const std::size_t end = head->find("\r\n", line);
    const std::size_t colon = head->find(": ", line);
    answer.headers[head->substr(line, colon - line)] = head->substr(colon + 2, end - colon - 2);
    line = end + 2;
  }
  const auto length = answer.headers.find("Content-Length");
  if (has_body && length != answer.headers.end()) {
    answer.body = client.take(std::stoul(length->second)).value_or("");
  }
  const auto coding = answer.headers.find("Transfer-Encoding");
  if (has_body && coding != answer.headers.end()) {
    while (const auto size = client.take_through("\r\n")) {
      const std::size_t bytes = std::stoul(*size, nullptr, 16);
      const std::string chunk = client.take(bytes + 2).value_or("");
      answer.body.append(chunk, 0, bytes);
      if (bytes == 0) break;
    }
  }
  return answer;
}

/// Sends `request` on a new connection and reads the answer.
inline Answer ask(std::uint16_t port, std::string_view request) {
  Client client(port);
  client.send(request);
  return read_answer(client, request.substr(0, 5) != "HEAD ");
}

inline std::string get_request(std::string_view target, std::string_view more = "") {
  return "GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(more) +
         "\r\n";
}

inline std::string post_request(std::string_view target,
                                std::string_view body,
                                std::string_view more = "Content-Type: application/json\r\n") {
  return "POST " + std::string(target) +
         " HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         std::string(more) + "\r\n" + std::string(body);
}

/// The key and accept value of RFC 6455, section 1.3.
inline constexpr std::string_view kWsKey = "dGhlIHNhbXBsZSBub25jZQ==";
inline constexpr std::string_view kWsAccept = "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=";

inline std::string upgrade_request(std::string_view protocols = "foxglove.websocket.v1",
                                   std::string_view more = "",
                                   std::string_view path = "/ws") {
  return "GET " + std::string(path) +
         " HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " +
         std::string(kWsKey) + "\r\n" +
         (protocols.empty() ? "" : "Sec-WebSocket-Protocol: " + std::string(protocols) + "\r\n") +
         std::string(more) + "\r\n";
}

struct Frame {
  int opcode = -1;  // -1: none came
  std::string payload{};
};

/// A WebSocket client on top of Client. Sends masked frames, RFC 6455 section 5.
class WsTestClient {
 public:
  explicit WsTestClient(std::uint16_t port,
                        std::string_view protocols = "foxglove.websocket.v1",
                        int receive_buffer = 0,
                        std::string_view path = "/ws")
      : socket(port, receive_buffer) {
    socket.send(upgrade_request(protocols, "", path));
    handshake = read_answer(socket, false);
  }

  /// One frame, final and masked with 01 02 03 04.
  static std::string encode(int opcode, std::string_view payload) {
    std::string frame;
    frame.push_back(static_cast<char>(0x80 | opcode));
    append_length(frame, payload.size(), 0x80);
    frame.append("\x01\x02\x03\x04");
    for (std::size_t i = 0; i < payload.size(); ++i) {
      frame.push_back(static_cast<char>(payload[i] ^ static_cast<char>(i % 4 + 1)));
    }
    return frame;
  }
  bool send(int opcode, std::string_view payload) const {
    return socket.send(encode(opcode, payload));
  }
  bool send_text(std::string_view payload) const { return send(1, payload); }
  bool send_binary(std::string_view payload) const { return send(2, payload); }

  /// The next frame, control frames included.
  Frame read(std::chrono::milliseconds patience = kPatience) {
    const auto head = socket.take(2, patience);
    if (!head) return {};
    std::size_t length = static_cast<unsigned char>((*head)[1]) & 0x7Fu;
    const std::size_t extra = length == 126 ? 2 : length == 127 ? 8 : 0;
    if (extra > 0) {
      length = 0;
      for (const char c : socket.take(extra).value_or("")) {
        length = length << 8 | static_cast<unsigned char>(c);
      }
    }
    return {static_cast<unsigned char>((*head)[0]) & 0x0F, socket.take(length).value_or("")};
  }
  /// The close code the server sends within a few frames, 0 when it sends none.
  int close_code() {
    for (Frame frame = read(); frame.opcode >= 0; frame = read()) {
      if (frame.opcode == 8 && frame.payload.size() >= 2) {
        return static_cast<unsigned char>(frame.payload[0]) << 8 |
               static_cast<unsigned char>(frame.payload[1]);
      }
    }
    return 0;
  }

  Client socket;
  Answer handshake{};

 private:
  static void append_length(std::string& frame, std::size_t size, int mask) {
    const int bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    const std::size_t first = bytes == 0 ? size : bytes == 2 ? 126u : 127u;
    frame.push_back(static_cast<char>(mask | static_cast<int>(first)));
    for (int i = bytes - 1; i >= 0; --i) {
      frame.push_back(static_cast<char>(size >> (8 * static_cast<unsigned>(i)) & 0xFFu));
    }
  }
};

/// A server on 127.0.0.1 and a free port, running on its own thread from start() to the end.
class RunningServer {
 public:
  explicit RunningServer(ServerOptions options = {}) : server(on_any_port(std::move(options))) {}
  ~RunningServer() { stop(); }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  void start() {
    thread_ = std::thread([this] { server.run(); });
  }
  void stop() {
    if (!thread_.joinable()) return;
    server.stop();
    thread_.join();
  }
  std::uint16_t port() const { return server.port(); }
  /// Runs `fn` on the io thread and returns what it returns.
  template <typename Fn>
  auto on_io(Fn fn) {
    std::promise<decltype(fn())> promise;
    server.post([&] { promise.set_value(fn()); });
    return promise.get_future().get();
  }

  Server server;

 private:
  static ServerOptions on_any_port(ServerOptions options) {
    options.port = 0;
    return options;
  }
  std::thread thread_{};
};

/// Polls until `condition` holds. @return whether it did in time
inline bool eventually(const std::function<bool()>& condition,
                       std::chrono::milliseconds patience = kPatience) {
  const auto deadline = steady_clock::now() + patience;
  while (!condition()) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

}  // namespace server::net::test
