// server/external/message_socket.hpp: whole messages over a socket, with a deadline.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace server::external {

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  void close();
  int release();

 private:
  int number_ = -1;
};

/// Another descriptor to serve during a wait; its number is -1 where there is nothing to read.
struct Aside {
  int number = -1;
  std::function<void()> read{};  // called when there is data or the end
};

/// What a wait heeds besides its own descriptor.
struct Patience {
  std::optional<std::chrono::steady_clock::time_point> deadline{};  // none: no limit
  std::stop_token stop{};
  Aside aside{};
};

/// Belongs to one thread at a time. Its waits sleep in poll().
class MessageSocket {
 public:
  using Clock = std::chrono::steady_clock;

  enum class Result : std::uint8_t { Done, Closed, Late, Stopped, TooLarge };

  MessageSocket() = default;
  /// `socket`: connected, non-blocking.
  explicit MessageSocket(Descriptor socket) : socket_(std::move(socket)) {}

  Result send(std::span<const std::byte> message, const Patience& patience);
  /// Waits for one whole message of at most `most` bytes, with its prefix.
  Result receive(std::size_t most, const Patience& patience);
  /// The message received last; its first byte is aligned to eight.
  std::span<const std::byte> message() const { return {buffer_.data(), size_}; }
  /// True if the other side has closed, or has sent something that nobody asked for.
  bool disturbed() const;
  int number() const { return socket_.number(); }
  void close() { socket_.close(); }

 private:
  Result wait(short events, const Patience& patience) const;
  Result read_until(std::size_t size, const Patience& patience);

  Descriptor socket_{};
  std::vector<std::byte> buffer_{};  // its memory is aligned as that of operator new: to 16
  std::size_t size_ = 0;             // bytes read of the message
};

}  // namespace server::external
