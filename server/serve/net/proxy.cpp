// server/serve/net/proxy.cpp: the forwarding headers, read from the right.
#include "server/serve/net/proxy.hpp"

#include <algorithm>
#include <string_view>

namespace server::net {

TrustedProxies::TrustedProxies(const std::vector<std::string>& addresses) {
  for (const std::string& address : addresses) networks_.push_back(Network::parse(address));
}

bool TrustedProxies::contains(const Address& address) const {
  return std::any_of(networks_.begin(), networks_.end(), [&](const Network& network) {
    return network.contains(address);
  });
}

Sender TrustedProxies::sender(const Address& peer, const Request& request) const {
  const std::vector<std::string_view> chain = request.elements("X-Forwarded-For");
  if (!contains(peer)) {
    const bool forwarded = !chain.empty() || !request.header("Forwarded").empty();
    return {peer, peer.is_loopback() && !forwarded, false};
  }
  Sender out{peer, peer.is_loopback(), false};
  for (auto element = chain.rbegin(); element != chain.rend(); ++element) {
    const std::optional<Address> address = Address::parse(*element);
    out.loopback = address && address->is_loopback();
    if (!address) break;  // "unknown": only the proxy that says so is known
    out.address = *address;
    if (!contains(*address)) break;
  }
  const std::vector<std::string_view> schemes = request.elements("X-Forwarded-Proto");
  out.https = !schemes.empty() && equal_no_case(schemes.back(), "https");
  return out;
}

}  // namespace server::net
