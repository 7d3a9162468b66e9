// server/serve/net/secret.cpp: four words of the system's random numbers.
#include "server/serve/net/secret.hpp"

#include <random>

#include <fmt/format.h>

namespace server::net {

std::string secret() {
  std::random_device source;  // reads the kernel's generator on this platform
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", source(), source(), source(), source());
}

}  // namespace server::net
