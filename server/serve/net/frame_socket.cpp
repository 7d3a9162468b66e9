// server/serve/net/frame_socket.cpp: frames written straight to the kernel.
#include "server/serve/net/frame_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>

#include <sys/socket.h>
#include <sys/uio.h>

namespace server::net {
namespace {

constexpr std::size_t kKeptCapacity = 65536;  // [bytes] kept by a connection after a large rest

/// The head of an unmasked, final frame (RFC 6455, 5.2).
struct FrameHead {
  FrameHead(FrameKind kind, std::size_t length) {
    put(kind == FrameKind::Binary ? 0x82 : 0x81);
    if (length < 126) {
      put(length);
    } else if (length <= 0xFFFF) {
      put(126);
      for (const unsigned shift : {8U, 0U}) put(length >> shift);
    } else {
      put(127);
      for (unsigned shift = 64; shift > 0;) put(length >> (shift -= 8));
    }
  }
  void put(std::size_t value) { bytes[size++] = static_cast<std::uint8_t>(value & 0xFF); }

  std::array<std::uint8_t, 10> bytes{};
  std::size_t size = 0;
};

iovec piece(const void* data, std::size_t size) {
  return {const_cast<void*>(data), size};  // sendmsg() only reads
}

}  // namespace

FrameSocket::Sent FrameSocket::send(FrameKind kind,
                                    std::span<const std::byte> header,
                                    std::string_view payload,
                                    std::span<const std::byte> rider) {
  State& state = *state_;
  if (state.writers > 0 || !state.rest.empty()) return Sent::Nothing;
  const FrameHead head(kind, header.size() + payload.size());
  const FrameHead rider_head(FrameKind::Binary, rider.size());
  std::array<iovec, 5> all{piece(rider_head.bytes.data(), rider_head.size),
                           piece(rider.data(), rider.size()),
                           piece(head.bytes.data(), head.size),
                           piece(header.data(), header.size()),
                           piece(payload.data(), payload.size())};
  const auto pieces = std::span(all).subspan(rider.empty() ? 2 : 0);
  std::size_t size = 0;
  for (const iovec& part : pieces) size += part.iov_len;
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  const ssize_t sent =
      ::sendmsg(state.socket.native_handle(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent <= 0) return Sent::Nothing;
  auto skip = static_cast<std::size_t>(sent);
  if (skip == size) return Sent::Whole;
  for (const iovec& part : pieces) {
    const std::size_t gone = std::min(skip, part.iov_len);
    skip -= gone;
    const char* const bytes = static_cast<const char*>(part.iov_base);
    state.rest.insert(state.rest.end(), bytes + gone, bytes + part.iov_len);
  }
  return Sent::Partly;
}

bool FrameSocket::State::send_rest(boost::system::error_code& error) {
  if (rest.empty()) return true;
  const ssize_t sent =
      ::send(socket.native_handle(), rest.data(), rest.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0) {
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
      error.assign(errno, boost::system::system_category());
    }
    return false;
  }
  rest.erase(rest.begin(), rest.begin() + sent);
  if (rest.empty() && rest.capacity() > kKeptCapacity) rest = {};
  return rest.empty();
}

}  // namespace server::net
