// server/serve/net/send_queue.hpp: messages that wait to be written to one WebSocket client, and
// their order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "server/serve/net/websocket.hpp"

namespace server::net {

/// One message: a header of up to 16 bytes of its own, then a shared payload.
struct Outgoing {
  FrameKind kind = FrameKind::Binary;
  std::array<std::byte, 16> header{};
  std::size_t header_size = 0;
  Payload payload{};

  std::size_t size() const { return header_size + (payload ? payload->size() : 0); }
};

/// Sends control messages first, in order, then the slots in turn, so that a busy channel cannot
/// starve another. The control limits plus `keep` messages per slot bound the memory; the steady
/// state allocates nothing.
class SendQueue {
 public:
  struct Limits {
    std::size_t control_messages = 1024;
    std::size_t control_bytes = 4u << 20;
  };
  explicit SendQueue(const Limits& limits) : limits_(limits) {}

  /// @return false if it would exceed the limits; then nothing is queued
  bool push_control(Outgoing message);

  /// Adds to the slot `key`, dropping its oldest messages beyond `keep` (at least 1).
  /// @return false if a message was dropped
  bool push_latest(std::uint32_t key,
                   std::span<const std::byte> header,
                   const Payload& payload,
                   std::size_t keep);
  void forget(std::uint32_t key);
  void clear();

  /// Moves the next message to write into `out`. @return false if none waits
  bool next(Outgoing& out);

  std::size_t messages() const { return control_.size() + slot_messages_; }
  std::size_t bytes() const { return control_bytes_ + slot_bytes_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Slot {
    std::uint32_t key = 0;
    std::vector<Outgoing> ring{};  // `count` messages from `first` on, wrapping
    std::size_t first = 0;
    std::size_t count = 0;
    bool waiting = false;  // listed in turn_
  };
  Slot& slot(std::uint32_t key);
  void pop(Slot& slot, Outgoing& out);

  Limits limits_;
  std::deque<Outgoing> control_{};
  std::size_t control_bytes_ = 0;
  std::vector<Slot> slots_{};        // in order of first use; a client has about a dozen
  std::vector<std::size_t> turn_{};  // indices of slots with something to send, next first
  std::size_t slot_messages_ = 0;
  std::size_t slot_bytes_ = 0;
  std::uint64_t dropped_ = 0;
  Outgoing discarded_{};
};

}  // namespace server::net
