// server/serve/net/send_queue.cpp: bounded control queue and latest-wins slots of one client.
#include "server/serve/net/send_queue.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace server::net {

bool SendQueue::push_control(Outgoing message) {
  const std::size_t size = message.size();
  if (control_.size() >= limits_.control_messages ||
      control_bytes_ + size > limits_.control_bytes) {
    return false;
  }
  control_bytes_ += size;
  control_.push_back(std::move(message));
  return true;
}

SendQueue::Slot& SendQueue::slot(std::uint32_t key) {
  const auto found =
      std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.key == key; });
  if (found != slots_.end()) return *found;
  slots_.emplace_back();
  slots_.back().key = key;
  return slots_.back();
}

void SendQueue::pop(Slot& from, Outgoing& out) {
  Outgoing& message = from.ring[from.first];
  slot_bytes_ -= message.size();
  --slot_messages_;
  std::swap(out, message);
  message.payload = nullptr;  // the old content of `out`
  from.first = (from.first + 1) % from.ring.size();
  --from.count;
}

bool SendQueue::push_latest(std::uint32_t key,
                            std::span<const std::byte> header,
                            const Payload& payload,
                            std::size_t keep) {
  Slot& to = slot(key);
  if (header.size() > Outgoing{}.header.size()) {
    throw std::invalid_argument("a message header has at most 16 bytes");
  }
  if (to.ring.size() < std::max<std::size_t>(1, keep)) {
    // Grows once per slot: put the oldest message first, then append room behind.
    std::rotate(
        to.ring.begin(), to.ring.begin() + static_cast<std::ptrdiff_t>(to.first), to.ring.end());
    to.first = 0;
    to.ring.resize(std::max<std::size_t>(1, keep));
  }
  const bool full = to.count == to.ring.size();
  if (full) {
    pop(to, discarded_);
    discarded_.payload = nullptr;
    ++dropped_;
  }
  Outgoing& message = to.ring[(to.first + to.count) % to.ring.size()];
  message.kind = FrameKind::Binary;
  std::copy(header.begin(), header.end(), message.header.begin());
  message.header_size = header.size();
  message.payload = payload;
  ++to.count;
  ++slot_messages_;
  slot_bytes_ += message.size();
  if (!to.waiting) {
    to.waiting = true;
    turn_.push_back(static_cast<std::size_t>(&to - slots_.data()));
  }
  return !full;
}

void SendQueue::forget(std::uint32_t key) {
  Slot& from = slot(key);
  while (from.count > 0) pop(from, discarded_);
  discarded_.payload = nullptr;
}

void SendQueue::clear() {
  control_.clear();
  control_bytes_ = 0;
  slots_.clear();
  turn_.clear();
  slot_messages_ = 0;
  slot_bytes_ = 0;
}

bool SendQueue::next(Outgoing& out) {
  if (!control_.empty()) {
    control_bytes_ -= control_.front().size();
    out = std::move(control_.front());
    control_.pop_front();
    return true;
  }
  while (!turn_.empty()) {
    const std::size_t index = turn_.front();
    turn_.erase(turn_.begin());
    Slot& from = slots_[index];
    from.waiting = false;
    if (from.count == 0) continue;  // forget() emptied it meanwhile
    pop(from, out);
    if (from.count > 0) {
      from.waiting = true;
      turn_.push_back(index);
    }
    return true;
  }
  return false;
}

std::string choose_subprotocol(const std::vector<std::string>& accepted,
                               const std::vector<std::string_view>& offered) {
  const auto chosen = std::ranges::find_first_of(accepted, offered);
  return chosen == accepted.end() ? std::string() : *chosen;
}

}  // namespace server::net
