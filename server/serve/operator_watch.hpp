// server/serve/operator_watch.hpp: checks that somebody is there to stop a real robot.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "algo/telemetry.hpp"

namespace server {

/// The operators that watch the session now.
struct Watchers {
  std::size_t pages = 0;  // WebSocket clients
  bool scripts = false;   // one or more over REST
  bool operator==(const Watchers&) const = default;
};

/// A sign of life comes from the program that could press Stop, never from the browser or the
/// socket below it. A page gives one after it has drawn a frame with Stop enabled while it is
/// visible. A script gives one by a request. A moving robot is disarmed soon after the last sign, a
/// resting one much later.
///
/// Signs come from the io thread. The control thread judges them, so that a server too busy to take
/// a sign also counts as absent.
class OperatorWatch {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  static constexpr std::chrono::milliseconds kPatience{1500};  // while the robot drives
  static constexpr std::chrono::seconds kRestPatience{60};     // while it is armed and at rest
  static constexpr const char* kGone =
      "Nobody has been watching for 1.5 s, and the robot was on its way: it was stopped and its "
      "motors are off. Arm it again when you are back.";
  static constexpr const char* kLeft =
      "Nobody has been watching for a minute: the motors of the resting robot are off. Arm it "
      "again when you are back.";

  // ---- io thread
  /// A sign of life of the WebSocket client `page`.
  void page_sign(std::uint64_t page, Time now);
  /// `page` has closed. Its last sign still counts, so that a page may be reloaded.
  void page_gone(std::uint64_t page) { pages_.erase(page); }
  /// A sign of life over REST.
  void script_sign(Time now);
  Watchers watchers(Time now) const;
  /// The robot needs no operator: `serve --unattended`.
  void need_nobody() { needed_.store(false, std::memory_order_relaxed); }

  // ---- control thread
  /// Why the robot must be disarmed, as a sentence; null if it need not be. `arming`: the epoch of
  /// algo::Arming.
  const char* why_disarm(std::uint32_t arming, bool on_its_way, Time now);

 private:
  void sign(Time now);

  std::map<std::uint64_t, Time> pages_{};  // the newest sign of each page
  std::optional<Time> script_{};
  std::atomic<Clock::rep> newest_{Time::min().time_since_epoch().count()};
  std::atomic<bool> needed_{true};
  std::uint32_t arming_ = 0;  // as last seen
  Time rests_since_{};        // armed and at rest since
};

/// True for a robot that moves or will move: it has a goal or stick input, or its wheels turn.
bool on_its_way(const algo::Telemetry& t);

}  // namespace server
