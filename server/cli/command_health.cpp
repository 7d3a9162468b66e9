// server/cli/command_health.cpp: `tautline health`: checks whether a server answers, for images
// that have no HTTP client.
#include <array>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/cli/cli.hpp"

namespace server {
namespace {

constexpr int kSeconds = 3;  // [s] per wait

struct Addresses {
  explicit Addresses(const std::string& host, const std::string& port) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(host.c_str(), port.c_str(), &hints, &list) != 0) list = nullptr;
  }
  ~Addresses() {
    if (list != nullptr) freeaddrinfo(list);
  }
  Addresses(const Addresses&) = delete;
  Addresses& operator=(const Addresses&) = delete;
  addrinfo* list = nullptr;
};

struct Socket {
  explicit Socket(int opened) : fd(opened) {
    const timeval patience{.tv_sec = kSeconds, .tv_usec = 0};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  }
  ~Socket() {
    if (fd >= 0) close(fd);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd;
};

/// The first line of the answer to GET /api/v1/healthz; empty without an answer.
std::string status_line(const std::string& host, const std::string& port) {
  const Addresses addresses(host, port);
  const std::string request = fmt::format(
      "GET /api/v1/healthz HTTP/1.1\r\nHost: {}:{}\r\nConnection: close\r\n\r\n", host, port);
  for (const addrinfo* a = addresses.list; a != nullptr; a = a->ai_next) {
    const Socket socket(::socket(a->ai_family, a->ai_socktype, a->ai_protocol));
    if (socket.fd < 0 || connect(socket.fd, a->ai_addr, a->ai_addrlen) != 0) continue;
    if (send(socket.fd, request.data(), request.size(), MSG_NOSIGNAL) < 0) continue;
    std::string answer;
    std::array<char, 512> bytes{};
    while (answer.find("\r\n") == std::string::npos) {
      const ssize_t got = recv(socket.fd, bytes.data(), bytes.size(), 0);
      if (got <= 0) return {};
      answer.append(bytes.data(), static_cast<std::size_t>(got));
    }
    return answer.substr(0, answer.find("\r\n"));
  }
  return {};
}

int health(const std::string& host, const std::string& port) {
  const std::string line = status_line(host, port);
  if (line.substr(0, 12) == "HTTP/1.1 200") {
    fmt::print("Tautline at {}:{} is well.\n", host, port);
    return 0;
  }
  fmt::print(stderr,
             "tautline: the server at {}:{} {}\n",
             host,
             port,
             line.empty() ? "does not answer" : fmt::format("answers '{}'", line));
  return kBadInput;
}

}  // namespace

void add_health_command(Command app, int& status) {
  struct Options {
    std::string host = "127.0.0.1";
    std::string port = "8080";
  };
  auto options = std::make_shared<Options>();
  const Command command = app.add_subcommand("health", "Ask a running server whether it is well");
  command.add_option("--host", options->host, "Host of the server").show_default();
  command.add_option("--port", options->port, "Port of the server").show_default();
  command.callback([options, &status] { status = health(options->host, options->port); });
}

}  // namespace server
