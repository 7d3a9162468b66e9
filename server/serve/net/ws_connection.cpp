// server/serve/net/ws_connection.cpp: one WebSocket client. Second of the two files that know
// Beast.
#include <array>
#include <exception>
#include <optional>
#include <utility>  // before Asio: Boost 1.74 needs it in C++20 mode

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "server/serve/net/core.hpp"
#include "server/serve/net/frame_socket.hpp"
#include "server/serve/net/send_queue.hpp"
#include "server/serve/net/upgrade.hpp"

namespace server::net {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Stream = websocket::stream<FrameSocket, false>;  // false: no permessage-deflate, it costs and
                                                       // saves nothing

/// A message goes straight to the kernel if no write is in flight. Otherwise there is one write in
/// flight, never more, and further messages wait in the bounded queue. Beast's own timers are off,
/// because they would take a slow reader for dead; check() does their work.
class WsConnection final : public Connection,
                           public WsClient,
                           public std::enable_shared_from_this<WsConnection> {
 public:
  WsConnection(Core& core, Socket socket, const WsEndpoint& endpoint, WsVisitor visitor);
  void start(const UpgradeRequest& request);

  // Connection
  void check(Clock::time_point now) override;
  void go_away() override { close(websocket::close_code::going_away, "the server stops"); }
  void abort() noexcept override;
  std::optional<Clock::time_point> idle_since(Clock::time_point /*now*/) const override {
    return std::nullopt;
  }
  std::string_view login() const override { return visitor_.login; }
  void logged_out() override { close(websocket::close_code::policy_error, "logged out"); }

  // WsClient
  std::uint32_t id() const override { return id_; }
  const std::map<std::string, std::string>& query() const override { return visitor_.query; }
  const std::string& subprotocol() const override { return visitor_.subprotocol; }
  const Visitor& who() const override { return visitor_.who; }
  bool open() const override { return state_ == State::Open; }
  void send_control(FrameKind kind, Payload payload) override;
  bool send_latest(std::uint32_t key,
                   std::span<const std::byte> header,
                   const Payload& payload,
                   std::size_t keep) override;
  void ride(std::span<const std::byte> message) override;
  void forget(std::uint32_t key) override { queue_.forget(key); }
  void close(std::uint16_t code, std::string_view reason) override;
  WsCounters counters() const override;

 private:
  enum class State { Handshake, Open, Closing, Ended };

  void on_accepted(const error_code& error);
  void read();
  void on_read(const error_code& error);
  void deliver();
  bool send_now(FrameKind kind, std::span<const std::byte> header, const Payload& payload);
  void pump();
  void write();
  void on_written(const error_code& error, std::size_t bytes);
  void count(std::size_t bytes);
  void ping();
  void finish();
  void limit_kernel_queue();
  template <typename Call>
  void guarded(const Call& call);

  Core& core_;
  const WsEndpoint& endpoint_;
  std::optional<Stream> stream_;  // empty once ended
  const WsVisitor visitor_;
  std::uint32_t id_;
  Connections::Number number_ = 0;
  State state_ = State::Handshake;
  bool announced_ = false;  // on_open was called, on_close must follow
  beast::flat_buffer input_{};
  SendQueue queue_;
  Outgoing current_{};
  std::array<std::byte, 16> rider_{};
  std::size_t rider_size_ = 0;
  bool writing_ = false;
  bool pinging_ = false;
  Clock::time_point deadline_{};  // for the handshake or the closing
  Clock::time_point heard_{};     // last sign of life, with some grace
  Clock::time_point write_started_{};
  WsCounters counters_{};
};

WsConnection::WsConnection(Core& core, Socket socket, const WsEndpoint& endpoint, WsVisitor visitor)
    : core_(core),
      endpoint_(endpoint),
      stream_(std::in_place, FrameSocket(std::move(socket))),
      visitor_(std::move(visitor)),
      id_(core.next_client++),
      queue_({core.options.limits.control_messages, core.options.limits.control_bytes}) {}

/// The kernel buffers megabytes for a client that does not read; such frames are old when they
/// arrive. With this option it buffers only so many unsent bytes, and the newest frame waits here.
void WsConnection::limit_kernel_queue() {
  const int bytes = static_cast<int>(core_.options.limits.unsent_kernel_bytes);
  if (::setsockopt(stream_->next_layer().socket().native_handle(),
                   IPPROTO_TCP,
                   TCP_NOTSENT_LOWAT,
                   &bytes,
                   sizeof bytes) != 0) {
    core_.log("cannot limit the kernel's send queue of " + visitor_.who.address);
  }
}

void WsConnection::start(const UpgradeRequest& request) {
  const Address client = Address::parse(visitor_.who.address).value_or(Address());
  number_ = core_.connections.add(shared_from_this(), client, Connections::Kind::WebSocket, false);
  heard_ = counters_.heard = Clock::now();
  deadline_ = heard_ + core_.options.timeouts.header;
  limit_kernel_queue();
  websocket::stream_base::timeout timeouts{};
  timeouts.handshake_timeout = websocket::stream_base::none();
  timeouts.idle_timeout = websocket::stream_base::none();
  timeouts.keep_alive_pings = false;
  stream_->set_option(timeouts);
  stream_->set_option(websocket::stream_base::decorator(
      [name = visitor_.subprotocol](websocket::response_type& response) {
        response.set(beast::http::field::server, "Tautline");
        if (!name.empty()) response.set(beast::http::field::sec_websocket_protocol, name);
      }));
  stream_->read_message_max(core_.options.limits.frame_bytes);
  stream_->auto_fragment(false);  // one message, one frame, one write
  stream_->control_callback([this](websocket::frame_type, beast::string_view) {
    heard_ = counters_.heard = Clock::now();
  });
  stream_->async_accept(
      request, [self = shared_from_this()](const error_code& error) { self->on_accepted(error); });
}

void WsConnection::on_accepted(const error_code& error) {
  if (state_ != State::Handshake) return;
  if (error) {
    finish();
    return;
  }
  state_ = State::Open;
  announced_ = true;
  guarded([&] {
    if (endpoint_.on_open) endpoint_.on_open(shared_from_this());
  });
  if (state_ == State::Ended) return;
  read();
  pump();
}

void WsConnection::read() {
  stream_->async_read(input_, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->on_read(error);
  });
}

void WsConnection::on_read(const error_code& error) {
  if (state_ == State::Ended) return;
  if (error) {
    finish();
    return;
  }
  heard_ = counters_.heard = Clock::now();
  if (state_ == State::Open) deliver();
  if (state_ == State::Ended) return;
  input_.clear();
  // The memory of one large message must not be kept for the life of the connection.
  if (input_.capacity() > 65536) input_.shrink_to_fit();
  read();
}

void WsConnection::deliver() {
  const auto data = input_.cdata();
  const std::string_view message(static_cast<const char*>(data.data()), data.size());
  const auto& callback = stream_->got_text() ? endpoint_.on_text : endpoint_.on_binary;
  guarded([&] {
    if (callback) callback(*this, message);
  });
}

template <typename Call>
void WsConnection::guarded(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    core_.log("a WebSocket callback failed: " + std::string(error.what()));
    close(websocket::close_code::internal_error, "the server failed on this message");
  } catch (...) {
    core_.log("a WebSocket callback failed");
    close(websocket::close_code::internal_error, "the server failed on this message");
  }
}

void WsConnection::send_control(FrameKind kind, Payload payload) {
  if (state_ != State::Open) return;
  Outgoing message;
  message.kind = kind;
  message.payload = std::move(payload);
  if (!queue_.push_control(std::move(message))) {
    core_.log("disconnecting " + visitor_.who.address + ": it does not read its control messages");
    // A closing frame would queue behind unread messages. check() ends the connection, not this
    // call: the caller may be iterating over the clients.
    state_ = State::Closing;
    deadline_ = Clock::now();
    queue_.clear();
    return;
  }
  pump();
}

bool WsConnection::send_latest(std::uint32_t key,
                               std::span<const std::byte> header,
                               const Payload& payload,
                               std::size_t keep) {
  if (state_ != State::Open) return true;
  if (!writing_ && queue_.messages() == 0 && send_now(FrameKind::Binary, header, payload)) {
    return true;
  }
  const bool kept = queue_.push_latest(key, header, payload, keep);
  pump();
  return kept;
}

void WsConnection::ride(std::span<const std::byte> message) {
  if (message.size() > rider_.size()) throw std::invalid_argument("a rider has at most 16 bytes");
  std::ranges::copy(message, rider_.begin());
  rider_size_ = message.size();
}

/// @return true if the message was taken; its rest, if any, is then being sent
bool WsConnection::send_now(FrameKind kind,
                            std::span<const std::byte> header,
                            const Payload& payload) {
  const std::string_view body = payload ? std::string_view(*payload) : std::string_view();
  const auto rider = std::span(rider_).first(rider_size_);
  const FrameSocket::Sent sent = stream_->next_layer().send(kind, header, body, rider);
  if (sent == FrameSocket::Sent::Nothing) return false;
  if (!rider.empty()) count(rider.size());
  rider_size_ = 0;
  const std::size_t bytes = header.size() + body.size();
  if (sent == FrameSocket::Sent::Whole) {
    count(bytes);
    return true;
  }
  writing_ = true;
  write_started_ = Clock::now();
  stream_->next_layer().flush([self = shared_from_this(), bytes](const error_code& error) {
    self->on_written(error, bytes);
  });
  return true;
}

void WsConnection::pump() {
  while (state_ == State::Open && !writing_ && queue_.next(current_)) {
    const auto header = std::span(current_.header).first(current_.header_size);
    if (!send_now(current_.kind, header, current_.payload)) write();
  }
  if (!writing_) current_.payload = nullptr;
}

/// Writes through Beast, which waits for its own frames to end and for room in the kernel.
void WsConnection::write() {
  writing_ = true;
  write_started_ = Clock::now();
  stream_->binary(current_.kind == FrameKind::Binary);
  const std::array<asio::const_buffer, 2> buffers{
      asio::buffer(current_.header.data(), current_.header_size),
      current_.payload ? asio::buffer(*current_.payload) : asio::const_buffer()};
  stream_->async_write(buffers,
                       [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                         self->on_written(error, bytes);
                       });
}

void WsConnection::on_written(const error_code& error, std::size_t bytes) {
  writing_ = false;
  current_.payload = nullptr;
  if (state_ == State::Ended) return;
  if (error) {
    if (state_ == State::Open) finish();
    return;
  }
  count(bytes);
  // A client that was stuck gets the full silence limit again, to answer the ping that it could not
  // see.
  heard_ = std::max(heard_, Clock::now() - core_.options.timeouts.ws_silence / 2);
  pump();
}

void WsConnection::count(std::size_t bytes) {
  ++counters_.sent_messages;
  counters_.sent_bytes += bytes;
}

void WsConnection::ping() {
  pinging_ = true;
  stream_->async_ping({}, [self = shared_from_this()](const error_code&) {
    self->pinging_ = false;  // a broken socket shows in the pending read
  });
}

void WsConnection::check(Clock::time_point now) {
  const Timeouts& timeouts = core_.options.timeouts;
  if (state_ == State::Ended) return;
  if (state_ != State::Open) {
    if (now >= deadline_) finish();
    return;
  }
  // Ping even while frames go out: the kernel accepts them long after the network is gone.
  const auto due = std::min(timeouts.ws_ping, timeouts.ws_silence / 2);
  if (now - counters_.heard > due && !pinging_) ping();
  if (writing_) {
    if (now - write_started_ > timeouts.ws_stalled) finish();
    return;
  }
  if (now - heard_ > timeouts.ws_silence) finish();
}

void WsConnection::close(std::uint16_t code, std::string_view reason) {
  if (state_ != State::Open) return;
  state_ = State::Closing;
  deadline_ = Clock::now() + core_.options.timeouts.closing;
  queue_.clear();
  // A close reason has at most 123 bytes.
  const websocket::close_reason why(
      static_cast<websocket::close_code>(code),
      beast::string_view(reason.data(), std::min<std::size_t>(reason.size(), 123)));
  stream_->async_close(why, [self = shared_from_this()](const error_code&) {
    if (self->state_ != State::Ended) self->finish();
  });
}

void WsConnection::finish() {
  if (state_ == State::Ended) return;
  const auto self = shared_from_this();  // remove() may drop the last reference
  abort();
  core_.remove(number_);
}

void WsConnection::abort() noexcept {
  if (state_ == State::Ended) return;
  state_ = State::Ended;
  queue_.clear();
  beast_close_socket(stream_->next_layer());
  // Destroy the stream, so that a handle may outlive the io_context; pending operations hold only
  // weak references to it.
  stream_.reset();
  if (!std::exchange(announced_, false) || !endpoint_.on_close) return;
  try {
    endpoint_.on_close(*this);
  } catch (const std::exception& error) {
    core_.log("a WebSocket close callback failed: " + std::string(error.what()));
  }
}

WsCounters WsConnection::counters() const {
  WsCounters counters = counters_;
  counters.dropped_messages = queue_.dropped();
  counters.buffered_messages = queue_.messages();
  counters.buffered_bytes = queue_.bytes();
  return counters;
}

}  // namespace

void start_websocket(Core& core,
                     Socket socket,
                     const UpgradeRequest& request,
                     const WsEndpoint& endpoint,
                     WsVisitor visitor) {
  std::make_shared<WsConnection>(core, std::move(socket), endpoint, std::move(visitor))
      ->start(request);
}

}  // namespace server::net
