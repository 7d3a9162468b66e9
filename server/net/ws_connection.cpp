// server/net/ws_connection.cpp: one WebSocket peer (one of the two Beast translation units).
#include "server/net/ws_connection.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <deque>
#include <string_view>
#include <vector>

namespace server::net {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

constexpr std::size_t kMaxQueued = 1024;                   // messages that must arrive
constexpr std::size_t kMaxQueuedBytes = 4 * 1024 * 1024;
constexpr std::string_view kLegacy = "foxglove.websocket.v1";
constexpr std::string_view kCurrent = "foxglove.sdk.v1";

class WsConnection final : public WsClient, public std::enable_shared_from_this<WsConnection> {
 public:
  WsConnection(std::shared_ptr<Shared> shared, boost::asio::ip::tcp::socket socket, bool loopback)
      : shared_(std::move(shared)),
        count_(shared_),
        stream_(std::move(socket)),
        id_(shared_->next_client++),
        loopback_(loopback) {}

  void accept(UpgradeRequest request, const std::string& subprotocol);

  std::uint64_t id() const override { return id_; }
  bool loopback() const override { return loopback_; }
  void send_text(std::shared_ptr<const std::string> text) override {
    enqueue({std::move(text), false});
  }
  void send_binary(std::shared_ptr<const std::string> bytes) override {
    enqueue({std::move(bytes), true});
  }
  bool send_latest(std::uint64_t key,
                   std::span<const std::byte> header,
                   std::shared_ptr<const std::string> payload) override;
  void drop_latest(std::uint64_t key) override;
  void close(std::string_view reason) override;

 private:
  struct Message {
    std::shared_ptr<const std::string> bytes{};
    bool binary = false;
  };
  struct Slot {
    std::uint64_t key = 0;
    std::array<std::byte, 16> header{};
    std::size_t header_size = 0;
    std::shared_ptr<const std::string> payload{};  // null: nothing waiting
  };

  void enqueue(Message message);
  void read();
  void on_read(error_code error);
  void write_next();
  bool take_next();
  void end();

  std::shared_ptr<Shared> shared_;
  ConnectionCount count_;
  websocket::stream<beast::tcp_stream> stream_;
  UpgradeRequest request_{};
  std::uint64_t id_;
  bool loopback_;
  bool open_ = false;
  bool closing_ = false;
  bool writing_ = false;
  beast::flat_buffer input_{};
  std::deque<Message> queue_{};
  std::size_t queued_bytes_ = 0;
  std::vector<Slot> slots_{};
  std::size_t next_slot_ = 0;  // round robin, so that no channel starves another
  Message current_{};          // what is being written
  std::array<std::byte, 16> current_header_{};
  std::size_t current_header_size_ = 0;
};

void WsConnection::accept(UpgradeRequest request, const std::string& subprotocol) {
  request_ = std::move(request);
  beast::get_lowest_layer(stream_).expires_never();
  error_code ignored;
  beast::get_lowest_layer(stream_).socket().set_option(boost::asio::ip::tcp::no_delay(true),
                                                       ignored);
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = shared_->options.header_timeout;
  timeout.idle_timeout = shared_->options.websocket_idle;
  timeout.keep_alive_pings = true;
  stream_.set_option(timeout);
  stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& r) {
    r.set(beast::http::field::sec_websocket_protocol, subprotocol);
    r.set(beast::http::field::server, "Tautline");
  }));
  stream_.read_message_max(shared_->options.max_frame);
  stream_.auto_fragment(false);
  stream_.write_buffer_bytes(16 * 1024);
  stream_.async_accept(request_, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->open_ = true;
    if (self->shared_->handlers.on_open) self->shared_->handlers.on_open(self);
    self->read();
  });
}

void WsConnection::read() {
  stream_.async_read(input_, [self = shared_from_this()](error_code error, std::size_t) {
    self->on_read(error);
  });
}

void WsConnection::on_read(error_code error) {
  if (error) {
    end();
    return;
  }
  const auto data = input_.data();
  const std::string_view message(static_cast<const char*>(data.data()), data.size());
  if (shared_->handlers.on_message) {
    shared_->handlers.on_message(shared_from_this(), stream_.got_binary(), message);
  }
  input_.consume(input_.size());
  read();
}

void WsConnection::end() {
  if (!open_) return;
  open_ = false;
  queue_.clear();
  slots_.clear();
  if (shared_->handlers.on_close) shared_->handlers.on_close(shared_from_this());
}

void WsConnection::enqueue(Message message) {
  if (!open_ || closing_) return;
  queued_bytes_ += message.bytes->size();
  queue_.push_back(std::move(message));
  if (queue_.size() > kMaxQueued || queued_bytes_ > kMaxQueuedBytes) {
    // It does not read: a polite goodbye would wait behind what it does not read.
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
    end();
    return;
  }
  write_next();
}

bool WsConnection::send_latest(std::uint64_t key,
                               std::span<const std::byte> header,
                               std::shared_ptr<const std::string> payload) {
  if (!open_ || closing_ || header.size() > 16) return true;
  Slot* slot = nullptr;
  for (Slot& candidate : slots_) {
    if (candidate.key == key) slot = &candidate;
  }
  if (slot == nullptr) {
    slot = &slots_.emplace_back();
    slot->key = key;
  }
  const bool replaced = slot->payload != nullptr;
  std::memcpy(slot->header.data(), header.data(), header.size());
  slot->header_size = header.size();
  slot->payload = std::move(payload);
  write_next();
  return !replaced;
}

void WsConnection::drop_latest(std::uint64_t key) {
  std::erase_if(slots_, [key](const Slot& slot) { return slot.key == key; });
}

bool WsConnection::take_next() {
  current_header_size_ = 0;
  if (!queue_.empty()) {
    current_ = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= current_.bytes->size();
    return true;
  }
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[(next_slot_ + i) % slots_.size()];
    if (!slot.payload) continue;
    next_slot_ = (next_slot_ + i + 1) % slots_.size();
    current_ = {std::move(slot.payload), true};
    slot.payload.reset();
    current_header_ = slot.header;
    current_header_size_ = slot.header_size;
    return true;
  }
  return false;
}

void WsConnection::write_next() {
  if (writing_ || !open_ || closing_ || !take_next()) return;
  writing_ = true;
  stream_.binary(current_.binary);
  const std::array<boost::asio::const_buffer, 2> buffers{
      boost::asio::buffer(current_header_.data(), current_header_size_),
      boost::asio::buffer(*current_.bytes)};
  stream_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
    self->writing_ = false;
    self->current_ = {};
    if (error) {
      self->end();
      return;
    }
    self->write_next();
  });
}

void WsConnection::close(std::string_view reason) {
  if (!open_ || closing_) return;
  closing_ = true;
  websocket::close_reason why(websocket::close_code::going_away);
  why.reason.assign(reason.data(), std::min<std::size_t>(reason.size(), 120));
  stream_.async_close(why, [self = shared_from_this()](error_code) { self->end(); });
}

}  // namespace

std::string choose_subprotocol(const UpgradeRequest& request) {
  bool legacy = false;
  bool current = false;
  const auto range = request.equal_range(beast::http::field::sec_websocket_protocol);
  for (auto it = range.first; it != range.second; ++it) {
    std::string_view rest(it->value().data(), it->value().size());
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      std::string_view name = rest.substr(0, comma);
      while (name.starts_with(' ')) name.remove_prefix(1);
      while (name.ends_with(' ')) name.remove_suffix(1);
      legacy = legacy || name == kLegacy;
      current = current || name == kCurrent;
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
  }
  if (legacy) return std::string(kLegacy);
  return current ? std::string(kCurrent) : std::string();
}

void accept_websocket(std::shared_ptr<Shared> shared,
                      boost::asio::ip::tcp::socket socket,
                      UpgradeRequest request,
                      std::string subprotocol,
                      bool loopback) {
  std::make_shared<WsConnection>(std::move(shared), std::move(socket), loopback)
      ->accept(std::move(request), subprotocol);
}

}  // namespace server::net
