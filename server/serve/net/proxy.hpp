// server/serve/net/proxy.hpp: who sent a request: the other end of the connection, or, when that is
// a proxy the host trusts, the client it speaks for.
#pragma once

#include <string>
#include <vector>

#include "server/serve/net/address.hpp"
#include "server/serve/net/http.hpp"

namespace server::net {

struct Sender {
  Address address{};
  bool loopback = false;  // a client on this machine, not a proxy that speaks for another
  bool https = false;     // the client's own connection is encrypted
};

class TrustedProxies {
 public:
  /// @param addresses  "127.0.0.1", "::1", "172.17.0.0/16". Throws std::invalid_argument.
  explicit TrustedProxies(const std::vector<std::string>& addresses);

  bool contains(const Address& address) const;

  /// Of a trusted proxy X-Forwarded-For gives the client: the rightmost address that is not itself
  /// a trusted proxy's, since a client may write whatever it likes to the left of that. The last
  /// X-Forwarded-Proto gives the scheme. From anybody else both are ignored, but for one thing: a
  /// program on this machine that forwards for others is not taken for somebody on this machine.
  Sender sender(const Address& peer, const Request& request) const;

 private:
  std::vector<Network> networks_{};
};

}  // namespace server::net
