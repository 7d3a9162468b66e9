// server/operator_watch.hpp: whether anybody is there who could stop a real robot.
#pragma once

#include <algorithm>
#include <chrono>

namespace server {

/// Every page has Stop, so every client counts that gives a sign of life, and so does whoever asks
/// for the session over REST. A simulated robot needs nobody.
class OperatorWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// Without a sign for so long nobody is there. Pages are pinged several times as often.
  static constexpr std::chrono::milliseconds kPatience{3000};
  static constexpr std::chrono::milliseconds kPing{1000};
  static constexpr const char* kWords =
      "Nobody has been watching for 3 s, and the robot was on its way: its motors are off. Arm it "
      "again when you are back.";

  /// A sign of life, which may be older than the newest.
  void seen(Clock::time_point when) { seen_ = std::max(seen_, when); }
  bool nobody(Clock::time_point now) const { return now - seen_ > kPatience; }

 private:
  Clock::time_point seen_{};
};

}  // namespace server
