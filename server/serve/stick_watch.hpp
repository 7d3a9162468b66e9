// server/serve/stick_watch.hpp: judges the sticks that come over a link. A stick that is late, out
// of order, or held since before the link worked does not reach the robot.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "algo/request.hpp"

namespace server {

/// What a client says of a stick besides the stick. A client that says nothing is judged by
/// arrival.
struct StickStamp {
  std::optional<std::uint64_t> sequence{};  // counts up with each stick of the client
  std::optional<double> sent{};             // [s] on the server's clock, as the client measured it
};

/// Of the sticks that came, those that were not obeyed.
struct DroppedSticks {
  std::uint64_t late = 0;          // older than kOldest when they came
  std::uint64_t out_of_order = 0;  // a newer one had come
  std::uint64_t barred = 0;        // before the stick was in the middle
  std::uint64_t unreadable = 0;    // no number, or out of range
  bool operator==(const DroppedSticks&) const = default;
};

/// Nothing resumes by itself: after a client has connected, and after a stick of it came late, its
/// stick counts only when it has been in the middle, or when none has come for kSilence. Io thread
/// only.
class StickWatch {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  static constexpr double kOldest = 0.5;      // [s]
  static constexpr double kClockError = 0.1;  // [s] a stick may come from the future
  static constexpr std::chrono::milliseconds kSilence{1000};

  void connected(std::uint64_t client, Time now) { links_[client] = {.heard = now}; }
  void gone(std::uint64_t client) { links_.erase(client); }

  /// Why `stick` is not obeyed, as a sentence. Scripts have no link: of them, only the age counts.
  std::optional<std::string> refusal(std::uint64_t client,
                                     const algo::Joystick& stick,
                                     const StickStamp& stamp,
                                     Time now);
  /// A stick that could not be read has come.
  void count_unreadable() { ++dropped_.unreadable; }
  const DroppedSticks& dropped() const { return dropped_; }

 private:
  struct Link {
    Time heard{};  // a stick that was not in the middle, or the connection
    bool barred = true;
    std::optional<std::uint64_t> newest{};  // sequence number
  };
  std::optional<std::string> late(const StickStamp& stamp, Time now);

  std::map<std::uint64_t, Link> links_{};
  DroppedSticks dropped_{};
};

/// [s] The server's clock, by which clients stamp sticks.
double clock_seconds(StickWatch::Time now);

}  // namespace server
