// server/serve/net/websocket.hpp: the interface to a WebSocket client.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/http.hpp"

namespace server::net {

enum class FrameKind : std::uint8_t { Text, Binary };

struct WsCounters {
  std::uint64_t sent_messages = 0;
  std::uint64_t sent_bytes = 0;        // payload and message header, without WebSocket framing
  std::uint64_t dropped_messages = 0;  // replaced by newer messages before they were sent
  std::size_t buffered_messages = 0;   // waiting here, besides the one being written
  std::size_t buffered_bytes = 0;
  std::chrono::steady_clock::time_point heard{};  // last sign of life from the other end
};

/// One connected client. Io thread only. A handle may outlive the connection; sending then does
/// nothing.
class WsClient {
 public:
  virtual ~WsClient() = default;
  /// Unique in this server, counted from 1, never reused.
  virtual std::uint32_t id() const = 0;
  /// The decoded query of the address it connected to.
  virtual const std::map<std::string, std::string>& query() const = 0;
  /// The negotiated subprotocol.
  virtual const std::string& subprotocol() const = 0;
  virtual const Visitor& who() const = 0;
  virtual bool open() const = 0;

  /// Queues a message that must arrive, in order. Disconnects a client if more of them pile up than
  /// the limits allow.
  virtual void send_control(FrameKind kind, Payload payload) = 0;

  /// Queues a binary message `header` + `payload`. Only the newest `keep` per `key` matter; a slow
  /// client misses the older ones. The payload is shared, not copied, and may be null.
  /// @param header  at most 16 bytes, copied
  /// @return false if an older unsent message of this key was dropped for it
  virtual bool send_latest(std::uint32_t key,
                           std::span<const std::byte> header,
                           const Payload& payload,
                           std::size_t keep = 1) = 0;
  /// Sends a binary message of at most 16 bytes ahead of the next message that goes straight to the
  /// kernel, in one write with it. A newer one replaces it; an empty one cancels it.
  virtual void ride(std::span<const std::byte> message) = 0;
  /// Drops the messages still queued under `key`.
  virtual void forget(std::uint32_t key) = 0;

  /// Closes after the current write, with a WebSocket close code (1000, 1008, ...).
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
  virtual WsCounters counters() const = 0;
};

/// Serves upgrades at `path`. Callbacks run on the io thread; an exception from one closes that
/// client with 1011. on_close is called exactly once for each on_open.
struct WsEndpoint {
  std::string path{};
  /// Accepted subprotocols, the preferred first; a client that offers none of them gets 400.
  /// Empty: none is negotiated.
  std::vector<std::string> subprotocols{};
  std::function<void(const std::shared_ptr<WsClient>&)> on_open{};
  std::function<void(WsClient&, std::string_view)> on_text{};
  std::function<void(WsClient&, std::string_view)> on_binary{};
  std::function<void(WsClient&)> on_close{};
};

/// The first of `accepted` that is in `offered`; empty if none.
std::string choose_subprotocol(const std::vector<std::string>& accepted,
                               const std::vector<std::string_view>& offered);

}  // namespace server::net
