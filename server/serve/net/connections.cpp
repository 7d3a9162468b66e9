// server/serve/net/connections.cpp: counts connections by visitor and makes room among them.
#include "server/serve/net/connections.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace server::net {
namespace {

constexpr std::chrono::minutes kReportPeriod{1};

}  // namespace

void Connections::count(Entry& entry, const Address& visitor) {
  const auto of_visitor = counts_.try_emplace(visitor).first;
  ++of_visitor->second.all;
  if (entry.kind == Kind::WebSocket) ++of_visitor->second.sockets;
  entry.visitor = &*of_visitor;
}

void Connections::discount(Entry& entry) {
  auto* const of_visitor = std::exchange(entry.visitor, nullptr);
  if (of_visitor == nullptr) return;
  if (entry.kind == Kind::WebSocket) --of_visitor->second.sockets;
  if (--of_visitor->second.all == 0) counts_.erase(Address(of_visitor->first));
}

Connections::Count Connections::of(const Address& visitor) const {
  const auto found = counts_.find(visitor);
  return found == counts_.end() ? Count{} : found->second;
}

/// Closes the longest idle connection of the visitor with the most, if that has `least` or more.
/// @param only  if given, considers this visitor alone
/// @return true if a connection was closed
bool Connections::close_idlest(std::size_t least, const Address* only, Clock::time_point now) {
  auto idlest = entries_.end();
  std::pair<std::size_t, Clock::duration> most{};  // connections of its visitor, time idle
  for (auto it = entries_.begin(); it != entries_.end(); ++it) {
    const auto* const visitor = it->second.visitor;
    if (visitor == nullptr || visitor->second.all < std::max(least, most.first)) continue;
    if (only != nullptr && visitor->first != *only) continue;
    const auto since = it->second.connection->idle_since(now);
    if (!since) continue;
    const std::pair<std::size_t, Clock::duration> rank{visitor->second.all, now - *since};
    if (idlest != entries_.end() && rank <= most) continue;
    idlest = it;
    most = rank;
  }
  if (idlest == entries_.end()) return false;
  const std::shared_ptr<Connection> closing = idlest->second.connection;
  note_crowding(idlest->second.visitor->first);
  remove(idlest->first);
  closing->abort();
  return true;
}

void Connections::note_crowding(const Address& visitor) {
  ++crowded_out_;
  crowder_ = visitor;
}

/// True for this machine, and for an address that has driven lately.
bool Connections::expected(const Address& from, Clock::time_point now) const {
  const auto known = known_.find(from.visitor());
  return from.is_loopback() || (known != known_.end() && now - known->second <= kKnownFor);
}

/// Limit of all connections that applies to a further one from `from`.
std::size_t Connections::places(const Address& from, Clock::time_point now) const {
  return limits_.total - (expected(from, now) ? 0 : std::min(limits_.kept, limits_.total / 2));
}

Connections::Room Connections::refused(Room why, const Address& visitor) {
  note_crowding(visitor);
  return why;
}

Connections::Room Connections::make_room(const Address& from, bool proxy, Clock::time_point now) {
  const Address visitor = from.visitor();
  const std::size_t has = proxy ? 0 : of(visitor).all;
  if (has >= limits_.per_address && !close_idlest(0, &visitor, now)) {
    return refused(Room::AddressFull, visitor);
  }
  if (entries_.size() < (proxy ? limits_.total : places(from, now))) return Room::Yes;
  // An unknown address never displaces the only connection of a visitor.
  const std::size_t least = expected(from, now) ? 1 : std::max<std::size_t>(has + 1, 2);
  const bool made = close_idlest(least, nullptr, now) || close_idlest(0, &visitor, now);
  return made ? Room::Yes : refused(Room::ServerFull, visitor);
}

Connections::Number Connections::add(std::shared_ptr<Connection> connection,
                                     const Address& from,
                                     Kind kind,
                                     bool proxy) {
  Entry& entry = entries_[next_];
  entry.connection = std::move(connection);
  entry.kind = kind;
  entry.proxy = proxy;
  if (!proxy) count(entry, from.visitor());
  return next_++;
}

Connections::Room Connections::charge(Number number, const Address& client, Clock::time_point now) {
  const auto found = entries_.find(number);
  if (found == entries_.end()) return Room::Yes;
  const Address visitor = client.visitor();
  discount(found->second);
  if (of(visitor).all >= limits_.per_address && !close_idlest(0, &visitor, now)) {
    return refused(Room::AddressFull, visitor);
  }
  if (entries_.size() > places(client, now)) return refused(Room::ServerFull, visitor);
  count(found->second, visitor);
  return Room::Yes;
}

void Connections::release(Number number) {
  const auto found = entries_.find(number);
  if (found != entries_.end() && found->second.proxy) discount(found->second);
}

bool Connections::may_open_socket(const Address& from) const {
  return of(from.visitor()).sockets < limits_.per_address - limits_.per_address / 8;
}

void Connections::remove(Number number) {
  const auto found = entries_.find(number);
  if (found == entries_.end()) return;
  discount(found->second);
  entries_.erase(found);
}

void Connections::welcome(const Address& from, Clock::time_point now) {
  const Address visitor = from.visitor();
  if (known_.count(visitor) == 0 && known_.size() >= kKnown) {
    known_.erase(std::min_element(known_.begin(), known_.end(), [](const auto& a, const auto& b) {
      return a.second < b.second;
    }));
  }
  known_[visitor] = now;
}

std::vector<std::shared_ptr<Connection>> Connections::all() const {
  std::vector<std::shared_ptr<Connection>> out;
  out.reserve(entries_.size());
  for (const auto& [number, entry] : entries_) out.push_back(entry.connection);
  return out;
}

void Connections::abort_all() noexcept {
  while (!entries_.empty()) {
    const std::shared_ptr<Connection> connection = entries_.begin()->second.connection;
    remove(entries_.begin()->first);
    connection->abort();
  }
}

std::string Connections::report(Clock::time_point now) {
  if (crowded_out_ == 0 || (reported_ && now - *reported_ < kReportPeriod)) return {};
  reported_ = now;
  return fmt::format("{} connections were closed or refused to make room for others, lately of {}.",
                     std::exchange(crowded_out_, 0),
                     crowder_.text());
}

}  // namespace server::net
