// server/serve/net/frame_socket.hpp: the socket under Beast's WebSocket that also sends a whole
// frame past it, in one system call. Internal to server/net.
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

/// Beast reads and writes through it as through the socket itself; a server that streams to a
/// thousand clients sends its messages directly, which spares Asio's preparations for a write that
/// may have to wait. The two never cut into each other's frames: nothing is sent directly while
/// Beast is writing, and what a full kernel buffer left of a direct frame goes first. Io thread
/// only.
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

  /// One unmasked WebSocket frame of `header` + `payload`, whole or in part; never waits. Before it
  /// a binary frame of the `rider`, where that is not empty: both are one write.
  Sent send(FrameKind kind,
            std::span<const std::byte> header,
            std::string_view payload,
            std::span<const std::byte> rider = {});

  /// Completes with what has become of the rest that send() kept.
  template <typename Handler>
  void flush(Handler&& handler) {
    async_write_some(
        boost::asio::const_buffer(),
        [on_flushed = std::forward<Handler>(handler)](const boost::system::error_code& error,
                                                      std::size_t) { on_flushed(error); });
  }

  // What Beast asks of a stream.
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
  /// Shared with the writes on their way, which may end after the connection.
  struct State {
    explicit State(Socket accepted) : socket(std::move(accepted)) {}
    /// @return whether nothing is left of the last direct frame; sets `error` when none can be sent
    bool send_rest(boost::system::error_code& error);

    Socket socket;
    int writers = 0;           // writes of Beast's, or flushes, not yet ended
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
        // Kept apart, as `self` moves away with this object.
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
