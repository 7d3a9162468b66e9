// server/emulate/clock.hpp: the clock of emulated devices: the computer's, the same for all
// programs.
#pragma once

#include <chrono>
#include <thread>

namespace server::emulate {

/// [s]
inline double machine_time() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Converts `time` [s] of machine_time().
inline void sleep_until(double time) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> since_epoch(time);
  std::this_thread::sleep_until(
      Clock::time_point(std::chrono::duration_cast<Clock::duration>(since_epoch)));
}

}  // namespace server::emulate
