// server/external/message_socket.cpp: poll, send and receive.
#include "server/external/message_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/external/messages.hpp"

namespace server::external {

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this == &other) return *this;
  close();
  number_ = other.release();
  return *this;
}

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

int Descriptor::release() {
  return std::exchange(number_, -1);
}

/// Until the socket is ready.
MessageSocket::Result MessageSocket::wait(short events, const Patience& patience) const {
  using std::chrono::milliseconds;
  constexpr milliseconds kLook{100};  // between looks at `stop`
  int other = patience.aside.number;
  while (true) {
    if (patience.stop.stop_requested()) return Result::Stopped;
    milliseconds left = kLook;
    if (patience.deadline) {
      left = std::min(left, std::chrono::ceil<milliseconds>(*patience.deadline - Clock::now()));
    }
    const bool late = left <= milliseconds(0);
    std::array<pollfd, 2> watched{{{socket_.number(), events, 0}, {other, POLLIN, 0}}};
    const int ready =
        ::poll(watched.data(), watched.size(), late ? 0 : static_cast<int>(left.count()));
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) return Result::Closed;
    if (ready == 0 && late) return Result::Late;
    if ((watched[1].revents & POLLIN) != 0) {
      patience.aside.read();
    } else if (watched[1].revents != 0) {
      other = -1;  // closed: poll() would return at once for ever
    }
    if (watched[0].revents != 0) return Result::Done;
  }
}

MessageSocket::Result MessageSocket::send(std::span<const std::byte> message,
                                          const Patience& patience) {
  while (!message.empty()) {
    const ssize_t sent = ::send(socket_.number(), message.data(), message.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      message = message.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      const Result result = wait(POLLOUT, patience);
      if (result != Result::Done) return result;
    } else if (errno != EINTR) {
      return Result::Closed;
    }
  }
  return Result::Done;
}

MessageSocket::Result MessageSocket::read_until(std::size_t size, const Patience& patience) {
  while (size_ < size) {
    const ssize_t got = ::recv(socket_.number(), buffer_.data() + size_, size - size_, 0);
    if (got > 0) {
      size_ += static_cast<std::size_t>(got);
    } else if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      const Result result = wait(POLLIN, patience);
      if (result != Result::Done) return result;
    } else if (got == 0 || errno != EINTR) {
      return Result::Closed;
    }
  }
  return Result::Done;
}

MessageSocket::Result MessageSocket::receive(std::size_t most, const Patience& patience) {
  size_ = 0;
  buffer_.resize(std::max(buffer_.size(), kPrefix));
  // The answer is still to be made: the first read would only say so.
  Result result = wait(POLLIN, patience);
  if (result == Result::Done) result = read_until(kPrefix, patience);
  if (result != Result::Done) return result;
  std::uint32_t body = 0;
  std::memcpy(&body, buffer_.data(), sizeof body);
  if (body > most - kPrefix) return Result::TooLarge;
  buffer_.resize(std::max(buffer_.size(), kPrefix + body));
  return read_until(kPrefix + body, patience);
}

bool MessageSocket::disturbed() const {
  pollfd watched{socket_.number(), POLLIN, 0};
  return ::poll(&watched, 1, 0) != 0;
}

}  // namespace server::external
