// tests/server/serve/net_address_test.cpp: addresses in every form, and the clients of a proxy.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "server/serve/net/proxy.hpp"

namespace server::net {
namespace {

std::string read(const char* text) {
  const auto address = Address::parse(text);
  return address ? address->text() : "none";
}

TEST(NetAddress, IsReadInEveryFormAProxyWritesIt) {
  for (const auto& [text, expected] :
       std::vector<std::pair<const char*, const char*>>{{"10.1.2.3", "10.1.2.3"},
                                                        {"10.1.2.3:49152", "10.1.2.3"},
                                                        {"::ffff:10.1.2.3", "10.1.2.3"},
                                                        {"[::ffff:10.1.2.3]:80", "10.1.2.3"},
                                                        {"2001:db8::1", "2001:db8::1"},
                                                        {"2001:0DB8:0:0::1", "2001:db8::1"},
                                                        {"[2001:db8::1]", "2001:db8::1"},
                                                        {"[2001:db8::1]:443", "2001:db8::1"},
                                                        {"\"[2001:db8::1]:443\"", "2001:db8::1"},
                                                        {"fe80::1%eth0", "fe80::1"},
                                                        {"::1", "::1"}}) {
    EXPECT_EQ(expected, read(text)) << text;
  }
  for (const char* text : {"",
                           "unknown",
                           "_hidden",
                           "localhost",
                           "10.1.2",
                           "10.1.2.3.4",
                           "10.1.2.256",
                           "0x7f.1",
                           "[::1",
                           "1:2",
                           ":",
                           "::1::",
                           "10.1.2.3 "}) {
    EXPECT_EQ("none", read(text)) << text;
  }
}

TEST(NetAddress, OneVisitorIsAnIpv4AddressOrAnIpv6Slash64) {
  const auto visitor = [](const char* text) { return Address::parse(text)->visitor(); };
  EXPECT_NE(visitor("10.1.2.3"), visitor("10.1.2.4"));
  EXPECT_EQ(visitor("10.1.2.3"), visitor("::ffff:10.1.2.3"));
  EXPECT_EQ(visitor("2001:db8:1:2:3:4:5:6"), visitor("2001:db8:1:2::1"));
  EXPECT_NE(visitor("2001:db8:1:2::1"), visitor("2001:db8:1:3::1"));
}

TEST(NetAddress, KnowsThisMachine) {
  for (const char* text : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(Address::parse(text)->is_loopback()) << text;
  }
  for (const char* text : {"128.0.0.1", "::2", "10.0.0.127", "::ffff:10.0.0.1"}) {
    EXPECT_FALSE(Address::parse(text)->is_loopback()) << text;
  }
}

TEST(NetAddress, ANetworkHasItsAddressesOnly) {
  const Network docker = Network::parse("172.17.5.1/16");
  EXPECT_TRUE(docker.contains(*Address::parse("172.17.0.1")));
  EXPECT_FALSE(docker.contains(*Address::parse("172.18.0.1")));
  EXPECT_FALSE(docker.contains(*Address::parse("::1")));
  EXPECT_TRUE(Network::parse("::1").contains(*Address::parse("::1")));
  EXPECT_FALSE(Network::parse("::/0").contains(*Address::parse("10.0.0.1")));
  EXPECT_TRUE(Network::parse("0.0.0.0/0").contains(*Address::parse("10.0.0.1")));
  for (const char* text :
       {"", "proxy.lan", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/x", "::/129", "10.0.0.0/-1"}) {
    EXPECT_THROW(Network::parse(text), std::invalid_argument) << text;
  }
}

Sender sender(const char* peer, std::vector<Header> headers) {
  static const TrustedProxies proxies({"127.0.0.1", "10.0.0.0/8"});
  Request request;
  request.headers = std::move(headers);
  return proxies.sender(*Address::parse(peer), request);
}

TEST(NetProxy, TheRightmostNonProxyAddressIsTheClient) {
  const auto client = [](const char* chain) {
    return sender("127.0.0.1", {{"X-Forwarded-For", chain}}).address.text();
  };
  EXPECT_EQ("203.0.113.7", client("203.0.113.7"));
  EXPECT_EQ("203.0.113.7", client("127.0.0.1, 203.0.113.7"))
      << "the left part is the client's word";
  EXPECT_EQ("203.0.113.7", client("8.8.8.8,203.0.113.7 ,10.1.1.1"));
  EXPECT_EQ("2001:db8::1", client("[2001:db8::1]:5000, 10.1.1.1"));
  EXPECT_EQ("10.1.1.1", client("unknown, 10.1.1.1"));
  EXPECT_EQ("127.0.0.1", client("203.0.113.7, unknown"));
  EXPECT_EQ("10.2.2.2", client("10.2.2.2, 10.1.1.1"));
  EXPECT_EQ("127.0.0.1", client(""));
  const Sender split =
      sender("127.0.0.1", {{"X-Forwarded-For", "8.8.8.8"}, {"x-forwarded-for", "203.0.113.7"}});
  EXPECT_EQ("203.0.113.7", split.address.text());
}

TEST(NetProxy, UntrustedForwardedHeadersAreIgnored) {
  const std::vector<Header> headers{{"X-Forwarded-For", "203.0.113.7"},
                                    {"X-Forwarded-Proto", "https"}};
  const Sender stranger = sender("198.51.100.1", headers);
  EXPECT_EQ("198.51.100.1", stranger.address.text());
  EXPECT_FALSE(stranger.https);
  // An untrusted proxy on this machine: its clients do not count as local.
  EXPECT_FALSE(sender("127.0.0.2", headers).loopback);
  EXPECT_FALSE(sender("127.0.0.2", {{"Forwarded", "for=203.0.113.7"}}).loopback);
  EXPECT_TRUE(sender("127.0.0.2", {}).loopback);
}

TEST(NetProxy, ProxyClientsAreRemoteAndMayBeEncrypted) {
  EXPECT_FALSE(sender("127.0.0.1", {{"X-Forwarded-For", "203.0.113.7"}}).loopback);
  EXPECT_TRUE(sender("127.0.0.1", {{"X-Forwarded-For", "127.0.0.1"}}).loopback);
  EXPECT_TRUE(sender("127.0.0.1", {}).loopback) << "its own health check";
  EXPECT_FALSE(sender("127.0.0.1", {{"X-Forwarded-For", "unknown"}}).loopback);
  EXPECT_TRUE(sender("10.0.0.1", {{"X-Forwarded-Proto", "HTTPS"}}).https);
  EXPECT_TRUE(sender("10.0.0.1", {{"X-Forwarded-Proto", "http, https"}}).https);
  EXPECT_FALSE(sender("10.0.0.1", {{"X-Forwarded-Proto", "https, http"}}).https);
  EXPECT_FALSE(sender("10.0.0.1", {}).https);
}

}  // namespace
}  // namespace server::net
