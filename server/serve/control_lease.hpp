// server/serve/control_lease.hpp: one driver at a time: who holds the controls of a session, who
// asks for them, and how they go from one to the next.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/visitor.hpp"

namespace server {

/// Somebody who sends requests: a WebSocket client, or a script.
struct Party {
  static constexpr std::uint64_t kNoClient = 0;
  std::uint64_t client = kNoClient;  // of a WebSocket client; of a script without a key: kNoClient
  std::string label{};               // net::Visitor::label()
  net::Role role = net::Role::Nobody;
};

/// Without a holder everybody who may drive does. While somebody holds the lease, goals, edits,
/// gains and the stick are the holder's alone; Stop is everybody's. Io thread only.
///
/// A holder has a key: who shows it is the holder, over whatever connection.
class ControlLease {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  static constexpr std::chrono::seconds kSilent{5};      // without a control: others may take over
  static constexpr std::chrono::seconds kForgotten{60};  // without a control: it ends
  /// The same of a client that only publishes a Twist.
  static constexpr std::chrono::seconds kPublisher{2};
  static constexpr std::chrono::seconds kAsks{30};  // a question is forgotten
  static constexpr std::size_t kMostAsking = 16;

  struct Seat {
    Party who{};
    std::string key{};
    Time since{};
  };
  /// A sentence that says why not; nothing when done.
  using Refusal = std::optional<std::string>;

  const std::optional<Seat>& holder() const { return holder_; }
  const std::vector<Seat>& asking() const { return asking_; }
  /// Whether others may take over.
  bool silent(Time now) const { return holder_ && now - touched_ >= kSilent; }

  /// Whether `who`, or who shows `key`, holds the lease.
  bool holds(const Party& who, std::string_view key = {}) const;
  /// Why `who` may not control the robot now.
  Refusal refusal(const Party& who, std::string_view key = {}) const;
  /// The holder has used a control.
  void touch(Time now) { touched_ = now; }

  /// Takes a free lease, or that of a silent holder. `force`: of any holder, for admins.
  Refusal take(const Party& who, bool force, Time now);
  /// The same for one who only publishes a Twist: it ends sooner.
  Refusal take_by_publishing(const Party& who, Time now);
  /// Tells the holder that `who` would like to drive.
  Refusal ask(const Party& who, Time now);
  /// The holder hands over to client `to`, which has asked.
  Refusal give(std::uint64_t to, Time now);
  void release();
  /// The link of a client is lost. True if that ended the lease or withdrew a question.
  bool lost(std::uint64_t client);
  /// Ends what has lasted too long without a sign. True if something ended.
  bool expire(Time now);

 private:
  void seat(const Party& who, Time now, std::chrono::seconds patience);

  std::optional<Seat> holder_{};
  std::vector<Seat> asking_{};
  Time touched_{};
  std::chrono::seconds patience_ = kForgotten;
};

}  // namespace server
