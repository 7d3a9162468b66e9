// server/external/listening_source.cpp: binds, accepts, and refuses the second.
#include "server/external/listening_source.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace server::external {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr std::string_view kTcp = "tcp:";
constexpr double kForHello = 2;  // [s]

[[noreturn]] void fail(const std::string& address, const std::string& why) {
  throw ControllerError(fmt::format("{} cannot be listened on: {}.", address, why));
}
[[noreturn]] void fail_by_errno(const std::string& address) {
  fail(address, std::strerror(errno));
}

/// Removes the file of a socket on which nobody listens any more.
void remove_stale(const std::string& address, const std::string& path, const sockaddr_un& name) {
  struct stat there {};
  if (lstat(path.c_str(), &there) != 0) return;
  if (!S_ISSOCK(there.st_mode)) fail(address, "the file exists and is no socket");
  const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (connect(probe.number(), reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) {
    fail(address, "another program listens there");
  }
  unlink(path.c_str());
}

}  // namespace

bool is_address(std::string_view command) {
  return command.starts_with(kUnix) || command.starts_with(kTcp);
}

ListeningSource::ListeningSource(Registration registration, std::string token)
    : registration_(std::move(registration)),
      token_(std::move(token)),
      address_(registration_.command) {
  if (address_.starts_with(kUnix)) {
    listen_unix(address_.substr(kUnix.size()));
  } else {
    listen_tcp(address_.substr(kTcp.size()));
  }
  bell_ = Descriptor(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  thread_ = std::jthread([this](const std::stop_token& stop) { accept_all(stop); });
}

ListeningSource::~ListeningSource() {
  thread_.request_stop();
  const std::uint64_t one = 1;
  if (::write(bell_.number(), &one, sizeof one) < 0) return;  // the thread looks by itself, later
  thread_.join();
  if (idle_) idle_->say_end("Tautline ends.");
  if (!path_.empty()) unlink(path_.c_str());
}

void ListeningSource::listen_unix(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof name.sun_path) {
    fail(address_, fmt::format("a path has 1 to {} bytes", sizeof name.sun_path - 1));
  }
  path.copy(name.sun_path, path.size());
  remove_stale(address_, path, name);
  token_.clear();  // the file's mode does its work
  listener_ = Descriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  // Before bind(), so that there is no moment at which others may connect.
  if (fchmod(listener_.number(), S_IRUSR | S_IWUSR) != 0 ||
      bind(listener_.number(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) {
    fail_by_errno(address_);
  }
  path_ = path;
  if (chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0 || listen(listener_.number(), 4) != 0) {
    fail_by_errno(address_);
  }
}

void ListeningSource::listen_tcp(const std::string& place) {
  const std::size_t colon = place.rfind(':');
  const std::string host = place.substr(0, colon);
  std::uint16_t port = 0;
  const char* const end = place.data() + place.size();
  const char* const begin = colon == std::string::npos ? end : place.data() + colon + 1;
  const auto [last, error] = std::from_chars(begin, end, port);
  if (error != std::errc() || last != end || (host != "127.0.0.1" && host != "localhost")) {
    fail(address_, "it must be as tcp:127.0.0.1:5555, on this machine alone");
  }
  if (token_.empty()) {
    fail(address_, "TCP needs a token; set TAUTLINE_CONTROLLER_TOKEN here and for the controller");
  }
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(port);
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  listener_ = Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  socklen_t size = sizeof name;
  auto* const plain = reinterpret_cast<sockaddr*>(&name);
  if (bind(listener_.number(), plain, size) != 0 || listen(listener_.number(), 4) != 0 ||
      getsockname(listener_.number(), plain, &size) != 0) {
    fail_by_errno(address_);
  }
  address_ = fmt::format("{}127.0.0.1:{}", kTcp, ntohs(name.sin_port));
}

void ListeningSource::accept_all(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> watched{{{listener_.number(), POLLIN, 0}, {bell_.number(), POLLIN, 0}}};
    constexpr int kLook = 1000;  // [ms] if the bell could not be rung
    if (::poll(watched.data(), watched.size(), kLook) <= 0 || watched[0].revents == 0) continue;
    Descriptor socket(accept4(listener_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket) seat(std::move(socket), stop);
  }
}

void ListeningSource::seat(Descriptor socket, const std::stop_token& stop) {
  if (path_.empty()) {
    const int on = 1;
    setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  bool taken = false;
  {
    const std::lock_guard lock(mutex_);
    if (idle_ && !idle_->idle()) idle_.reset();
    taken = lent_ || idle_;
  }
  if (taken) {
    MessageWriter writer;
    MessageSocket(std::move(socket))
        .send(writer.end("Another controller is connected."),
              {.deadline = MessageSocket::Clock::now()});
    return;
  }
  try {
    auto peer = std::make_unique<SocketPeer>(
        SocketPeer::Settings{
            .name = registration_.name, .answer_limit = kForHello, .token = token_},
        std::move(socket),
        nullptr,
        texts_,
        stop);
    peer->set_answer_limit(registration_.answer_limit);
    const std::lock_guard lock(mutex_);
    idle_ = std::move(peer);
  } catch (const ControllerError&) {
    return;  // it has been told why
  }
  seated_.notify_one();
}

std::unique_ptr<Peer> ListeningSource::take(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (idle_ && !idle_->idle()) idle_.reset();
  if (lent_) {
    throw ControllerError(fmt::format(
        "The controller '{}' drives another run; it is one, at {}.", registration_.name, address_));
  }
  const auto there = [this] { return idle_ != nullptr; };
  if (registration_.answer_limit > 0) {
    seated_.wait_for(lock, stop, std::chrono::duration<double>(registration_.answer_limit), there);
  } else {
    seated_.wait(lock, stop, there);
  }
  if (!idle_) {
    throw ControllerError(fmt::format("The controller '{}' did not connect to {} within {:g} s.",
                                      registration_.name,
                                      address_,
                                      registration_.answer_limit));
  }
  lent_ = true;
  return std::move(idle_);
}

void ListeningSource::give_back(std::unique_ptr<Peer> peer, bool well) {
  const std::lock_guard lock(mutex_);
  lent_ = false;
  if (well) idle_.reset(static_cast<SocketPeer*>(peer.release()));
}

}  // namespace server::external
