// server/serve/net/connections.hpp: the open connections, and their limits per visitor.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/address.hpp"
#include "server/serve/net/clock.hpp"

namespace server::net {

/// One open connection. Connections owns it until remove(); pending operations share it.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Called about once a second: closes the connection if its time is up.
  virtual void check(Clock::time_point now) = 0;
  /// The server stops: says goodbye if the protocol can, then closes.
  virtual void go_away() = 0;
  /// Ends the connection now; runs no operation afterwards and does not touch the core again.
  virtual void abort() noexcept = 0;
  /// Time since which it has only waited for the other end. Nothing while it is in use, and so must
  /// not be closed to make room.
  virtual std::optional<Clock::time_point> idle_since(Clock::time_point now) const = 0;
  /// The login it was opened with; empty for none, and for a connection that checks the login per
  /// request.
  virtual std::string_view login() const { return {}; }
  /// Called when that login has ended.
  virtual void logged_out() {}
};

/// Io thread only. Two rules keep one visitor from displacing others. A visitor has at most
/// `per_address` connections: a further one replaces the visitor's longest idle one. When the
/// server is full, a new connection replaces the longest idle one of the visitor with the most.
/// Some room is kept for this machine (health checks) and for addresses that have driven.
class Connections {
 public:
  struct Limits {
    std::size_t total = 2048;
    std::size_t per_address = 256;
    std::size_t kept = 64;  // of the total
  };
  enum class Room { Yes, AddressFull, ServerFull };
  enum class Kind { Request, WebSocket };
  using Number = std::uint64_t;
  static constexpr std::chrono::minutes kKnownFor{10};

  explicit Connections(const Limits& limits) : limits_(limits) {}

  /// Makes room for a further connection. A trusted proxy's connection counts for no visitor until
  /// it carries a request.
  Room make_room(const Address& from, bool proxy, Clock::time_point now);
  Number add(std::shared_ptr<Connection> connection, const Address& from, Kind kind, bool proxy);
  /// From now until release(), a proxy's connection carries a request of `client`.
  Room charge(Number number, const Address& client, Clock::time_point now);
  void release(Number number);
  /// True if `from` may have another WebSocket: one in eight places is left for requests.
  bool may_open_socket(const Address& from) const;
  /// Removes a connection that has ended.
  void remove(Number number);

  /// `from` may drive, and does: reserves room for it for a while.
  void welcome(const Address& from, Clock::time_point now);

  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }
  /// Ends all connections.
  void abort_all() noexcept;
  /// All connections, oldest first. They may end during iteration over the list.
  std::vector<std::shared_ptr<Connection>> all() const;
  /// A report of connections closed or refused for lack of room, at most once a minute; else empty.
  std::string report(Clock::time_point now);

 private:
  static constexpr std::size_t kKnown = 256;  // addresses remembered
  struct Count {
    std::size_t all = 0;
    std::size_t sockets = 0;
  };
  using Counts = std::map<Address, Count>;
  struct Entry {
    std::shared_ptr<Connection> connection{};
    Counts::value_type* visitor = nullptr;  // its visitor; null: a proxy's, without a request
    Kind kind = Kind::Request;
    bool proxy = false;  // was opened by a trusted proxy
  };

  void count(Entry& entry, const Address& visitor);
  void discount(Entry& entry);
  Count of(const Address& visitor) const;
  bool close_idlest(std::size_t least, const Address* only, Clock::time_point now);
  void note_crowding(const Address& visitor);
  bool expected(const Address& from, Clock::time_point now) const;
  std::size_t places(const Address& from, Clock::time_point now) const;
  Room refused(Room why, const Address& visitor);

  Limits limits_;
  std::map<Number, Entry> entries_{};  // by number, the oldest first
  Counts counts_{};
  std::map<Address, Clock::time_point> known_{};  // addresses that have driven, and when
  Number next_ = 1;
  std::size_t crowded_out_ = 0;  // closed or refused since the last report
  Address crowder_{};            // the last such visitor
  std::optional<Clock::time_point> reported_{};
};

}  // namespace server::net
