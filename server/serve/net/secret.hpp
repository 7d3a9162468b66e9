// server/serve/net/secret.hpp: names that nobody can guess.
#pragma once

#include <string>

namespace server::net {

/// 128 random bits in hex, from the system's own source.
std::string secret();

}  // namespace server::net
