// server/serve/net/proxy.hpp: finds the sender of a request: the other end of the connection or, if
// that is a trusted proxy, the proxy's client.
#pragma once

#include <string>
#include <vector>

#include "server/serve/net/address.hpp"
#include "server/serve/net/http.hpp"

namespace server::net {

struct Sender {
  Address address{};
  bool loopback = false;  // a client on this machine, not a proxy for another client
  bool https = false;     // the client's own connection is encrypted
};

class TrustedProxies {
 public:
  /// @param addresses  "127.0.0.1", "::1", "172.17.0.0/16". Throws std::invalid_argument.
  explicit TrustedProxies(const std::vector<std::string>& addresses);

  bool contains(const Address& address) const;

  /// For a trusted proxy, X-Forwarded-For gives the client: the rightmost address that is not a
  /// trusted proxy's, because a client can forge everything to the left of it. The last
  /// X-Forwarded-Proto gives the scheme. Both are ignored from any other peer, with one exception:
  /// a program on this machine that forwards for others does not count as a client on this machine.
  Sender sender(const Address& peer, const Request& request) const;

 private:
  std::vector<Network> networks_{};
};

}  // namespace server::net
