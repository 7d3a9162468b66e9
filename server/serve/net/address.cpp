// server/serve/net/address.cpp: parses addresses with the system's own parser, which accepts no
// short forms.
#include "server/serve/net/address.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace server::net {
namespace {

constexpr std::array<std::uint8_t, 12> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

/// The address alone: without quotes, brackets, port and zone.
std::string_view bare(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  if (!text.empty() && text.front() == '[') {
    const std::size_t end = text.find(']');
    text = end == std::string_view::npos ? std::string_view() : text.substr(1, end - 1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    text = text.substr(0, text.find(':'));
  }
  return text.substr(0, text.find('%'));
}

}  // namespace

std::optional<Address> Address::parse(std::string_view text) {
  const std::string digits{bare(text)};
  Address out;
  if (::inet_pton(AF_INET6, digits.c_str(), out.bytes_.data()) == 1) return out;
  std::copy(kMapped.begin(), kMapped.end(), out.bytes_.begin());
  if (::inet_pton(AF_INET, digits.c_str(), out.bytes_.data() + kMapped.size()) == 1) return out;
  return std::nullopt;
}

bool Address::is_v4() const {
  return std::equal(kMapped.begin(), kMapped.end(), bytes_.begin());
}

bool Address::is_loopback() const {
  if (is_v4()) return bytes_[12] == 127;
  Address one;
  one.bytes_[15] = 1;
  return *this == one;
}

std::string Address::text() const {
  std::array<char, INET6_ADDRSTRLEN> out{};
  if (is_v4()) {
    ::inet_ntop(AF_INET, bytes_.data() + kMapped.size(), out.data(), out.size());
  } else {
    ::inet_ntop(AF_INET6, bytes_.data(), out.data(), out.size());
  }
  return out.data();
}

Address Address::prefix(int bits) const {
  const int kept = is_v4() ? bits + 96 : bits;
  Address out = *this;
  for (int i = 0; i < 16; ++i) {
    const int here = std::clamp(kept - 8 * i, 0, 8);
    out.bytes_[static_cast<std::size_t>(i)] &= static_cast<std::uint8_t>(0xFF00u >> here);
  }
  return out;
}

Network Network::parse(std::string_view text) {
  const std::size_t slash = text.find('/');
  const std::optional<Address> address = Address::parse(text.substr(0, slash));
  const int most = address && address->is_v4() ? 32 : 128;
  int bits = most;
  bool good = address.has_value();
  if (good && slash != std::string_view::npos) {
    const std::string_view digits = text.substr(slash + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
    good =
        error == std::errc() && end == digits.data() + digits.size() && bits >= 0 && bits <= most;
  }
  if (!good) {
    throw std::invalid_argument("'" + std::string(text) +
                                "' is not an address: give one such as 127.0.0.1, ::1 or "
                                "172.17.0.0/16");
  }
  return {address->prefix(bits), bits};
}

}  // namespace server::net
