// server/serve/net/clock.hpp: the clock of timeouts, logins and limits. Code that judges by it
// takes the time as an argument.
#pragma once

#include <chrono>

namespace server::net {

using Clock = std::chrono::steady_clock;

}  // namespace server::net
