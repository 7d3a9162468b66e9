// server/serve/net/frame_socket.hpp: the socket under Beast's WebSocket, which can also send a
// whole frame directly, in one system call. Internal to server/net.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "server/serve/net/core.hpp"

namespace server::net {

/// Beast reads and writes through it as through the socket itself. Messages to clients go out
/// directly, which saves Asio's setup of a write that may have to wait; this matters for a thousand
/// clients. The two never interleave their frames: nothing is sent directly while Beast is writing,
/// and the rest of a direct frame after a full kernel buffer goes first. Io thread only.
class FrameSocket {
 public:
  using executor_type = Executor;
  enum class Sent {
    Whole,
    Partly,   ///< the rest is kept: flush() before the next
    Nothing,  ///< Beast is writing, the kernel's buffer is full, or the socket is broken
  };

  explicit FrameSocket(Socket socket) : state_(std::make_shared<State>(std::move(socket))) {}

  executor_type get_executor() { return state_->socket.get_executor(); }
  Socket& socket() { return state_->socket; }

  /// Sends one unmasked WebSocket frame of `header` + `payload`, whole or in part; never waits. A
  /// non-empty `rider` goes before it as a binary frame, in the same write.
  Sent send(FrameKind kind,
            std::span<const std::byte> header,
            std::string_view payload,
            std::span<const std::byte> rider = {});

  /// Sends the rest that send() kept; completes with the result.
  template <typename Handler>
  void flush(Handler&& handler) {
    async_write_some(
        boost::asio::const_buffer(),
        [on_flushed = std::forward<Handler>(handler)](const boost::system::error_code& error,
                                                      std::size_t) { on_flushed(error); });
  }

  // Beast's requirements of a stream.
  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return state_->socket.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <typename Buffers, typename Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    ++state_->writers;
    return boost::asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        WriteOp<Buffers>{state_, buffers}, handler, state_->socket);
  }

 private:
  /// Shared with pending writes, which may end after the connection.
  struct State {
    explicit State(Socket accepted) : socket(std::move(accepted)) {}
    /// @return true if nothing is left of the last direct frame; sets `error` if it cannot be sent
    bool send_rest(boost::system::error_code& error);

    Socket socket;
    int writers = 0;           // pending writes of Beast and flushes
    std::vector<char> rest{};  // of a direct frame
  };

  template <typename Buffers>
  struct WriteOp {
    std::shared_ptr<State> state;
    Buffers buffers;
    bool writing = false;

    template <typename Self>
    void operator()(Self& self, boost::system::error_code error = {}, std::size_t bytes = 0) {
      if (!writing && !error) {
        // A copy, because moving `self` moves this object away.
        const std::shared_ptr<State> kept = state;
        writing = kept->send_rest(error);
        if (!writing && !error) {
          return kept->socket.async_wait(Socket::wait_write, std::move(self));
        }
        writing = true;
        const Buffers mine = buffers;
        return kept->socket.async_write_some(mine, std::move(self));
      }
      --state->writers;
      self.complete(error, bytes);
    }
  };

  std::shared_ptr<State> state_;
};

// Found by Beast through the type of the stream.
inline void beast_close_socket(FrameSocket& stream) {
  boost::system::error_code ignored;
  stream.socket().close(ignored);
}
inline void teardown(boost::beast::role_type role,
                     FrameSocket& stream,
                     boost::system::error_code& error) {
  boost::beast::websocket::teardown(role, stream.socket(), error);
}
template <typename Handler>
void async_teardown(boost::beast::role_type role, FrameSocket& stream, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, stream.socket(), std::forward<Handler>(handler));
}

}  // namespace server::net
