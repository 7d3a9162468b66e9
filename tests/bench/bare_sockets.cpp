// tests/bench/bare_sockets.cpp: sockets, one reader, one loop.
#include "tests/bench/bare_sockets.hpp"

#include <array>
#include <chrono>

#include "tests/bench/bench.hpp"
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace bench {

BareSockets::BareSockets(std::size_t clients, std::size_t bytes) : bytes_(bytes, 'x') {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  require(::bind(listener, generic, size) == 0 && ::listen(listener, 128) == 0 &&
              ::getsockname(listener, generic, &size) == 0,
          "No loopback socket is available.");
  const int poll = ::epoll_create1(0);
  for (std::size_t i = 0; i < clients; ++i) {
    receivers_.push_back(::socket(AF_INET, SOCK_STREAM, 0));
    require(::connect(receivers_.back(), generic, size) == 0, "A loopback socket did not connect.");
    senders_.push_back(::accept(listener, nullptr, nullptr));
    const int on = 1;
    ::setsockopt(senders_.back(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = receivers_.back();
    ::epoll_ctl(poll, EPOLL_CTL_ADD, receivers_.back(), &event);
  }
  ::close(listener);
  wake_ = ::eventfd(0, 0);
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = wake_;
  ::epoll_ctl(poll, EPOLL_CTL_ADD, wake_, &event);
  reader_ = std::thread([this, poll] { read_all(poll); });
}

BareSockets::~BareSockets() {
  ::eventfd_write(wake_, 1);
  reader_.join();
  ::close(wake_);
  for (const int fd : senders_) ::close(fd);
  for (const int fd : receivers_) ::close(fd);
}

void BareSockets::read_all(int poll) const {
  std::array<epoll_event, 256> events{};
  std::array<char, 65536> buffer{};
  for (;;) {
    const int count = ::epoll_wait(poll, events.data(), static_cast<int>(events.size()), -1);
    for (int i = 0; i < count; ++i) {
      const int fd = events[static_cast<std::size_t>(i)].data.fd;
      if (fd == wake_) {
        ::close(poll);
        return;
      }
      if (::recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT) < 0) continue;
    }
  }
}

double BareSockets::send_for(double seconds, double rate) {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate));
  const auto rounds = static_cast<std::size_t>(seconds * rate);
  std::size_t sent = 0;
  const double before = thread_cpu();
  auto deadline = Clock::now();
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const int fd : senders_) {
      const ssize_t n = ::send(fd, bytes_.data(), bytes_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      if (n == static_cast<ssize_t>(bytes_.size())) ++sent;
    }
    std::this_thread::sleep_until(deadline += period);
  }
  require(sent > 0, "P14: the bare loop sent nothing");
  return (thread_cpu() - before) / static_cast<double>(sent);
}

}  // namespace bench
