// server/serve/net/address.hpp: IP addresses as values: parses them and groups them by visitor.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace server::net {

/// An IPv4 or IPv6 address. IPv4 is kept in its IPv6-mapped form, so that a v4 client of a v6
/// socket equals itself on a v4 socket.
class Address {
 public:
  /// All zero: no client has this address.
  Address() = default;

  /// Reads "10.1.2.3", "10.1.2.3:80", "::1", "[::1]", "[::1]:80", "::ffff:10.1.2.3" and
  /// "fe80::1%eth0" (the zone is left out), in double quotes or not. Refuses names.
  static std::optional<Address> parse(std::string_view text);

  bool is_v4() const;
  bool is_loopback() const;
  /// "10.1.2.3" or "2001:db8::1".
  std::string text() const;
  /// The address with all but its first `bits` set to zero; an IPv4 address has 32 bits.
  Address prefix(int bits) const;
  /// The visitor of the address: the IPv4 address itself, or the IPv6 /64 that one customer gets.
  Address visitor() const { return is_v4() ? *this : prefix(64); }

  auto operator<=>(const Address&) const = default;

 private:
  std::array<std::uint8_t, 16> bytes_{};
};

/// "10.0.0.0/8" or a single address.
struct Network {
  Address first{};
  int bits = 0;  // of 32 for IPv4, of 128 for IPv6

  /// Throws std::invalid_argument with a sentence.
  static Network parse(std::string_view text);
  bool contains(const Address& address) const {
    return address.is_v4() == first.is_v4() && address.prefix(bits) == first;
  }
};

}  // namespace server::net
