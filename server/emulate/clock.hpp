// server/emulate/clock.hpp: the clock of emulated devices: the machine's, the same in all programs.
#pragma once

#include <chrono>

namespace server::emulate {

/// [s]
inline double machine_time() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace server::emulate
