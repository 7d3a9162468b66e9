// server/serve/net/secret.hpp: random names that cannot be guessed.
#pragma once

#include <string>

namespace server::net {

/// 128 random bits in hex, from the system's own source.
std::string secret();

}  // namespace server::net
