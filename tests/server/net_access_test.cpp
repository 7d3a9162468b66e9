// tests/server/net_access_test.cpp: Host, Origin, token and login, on values and over sockets.
#include <string>
#include <vector>

#include "tests/server/net_client.hpp"
#include <gtest/gtest.h>

#include "server/net/access.hpp"

namespace server::net::test {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

Request request_of(const std::string& method, std::vector<Header> headers, bool loopback = true) {
  Request request;
  request.method = method;
  request.path = "/api/v1/session";
  request.headers = std::move(headers);
  request.loopback = loopback;
  return request;
}

/// Status of the refusal, 0 when it may pass.
int refused(const Access& access, const Request& request, bool upgrade = false) {
  const auto refusal = access.refuse(request, "10.1.2.3", upgrade, true);
  return refusal ? refusal->status : 0;
}

TEST(NetAccess, TakesTheNamesOfThisServerOnly) {
  const Access access({.allow_hosts = {"robot.lan", "demo.example:8443"}});
  for (const char* host : {"localhost",
                           "LocalHost:8080",
                           "127.0.0.1",
                           "127.0.0.1:8080",
                           "127.8.8.8",
                           "[::1]:8080",
                           "10.1.2.3:8080",
                           "robot.lan",
                           "ROBOT.LAN:99",
                           "demo.example:8443"}) {
    EXPECT_EQ(0, refused(access, request_of("GET", {{"Host", host}}))) << host;
  }
  for (const char* host : {"evil.example",
                           "localhost.evil.example",
                           "127.0.0.1.evil.example",
                           "10.1.2.4",
                           "demo.example",
                           "demo.example:80",
                           "xrobot.lan",
                           "[::1",
                           "127.evil.example",
                           ":8080"}) {
    EXPECT_EQ(421, refused(access, request_of("GET", {{"Host", host}}))) << host;
  }
  EXPECT_EQ(400, refused(access, request_of("GET", {})));
  EXPECT_EQ(400, refused(access, request_of("GET", {{"Host", "localhost"}, {"host", "x"}})));
}

TEST(NetAccess, OriginMustBeThisServerOrListed) {
  const Access access({.allow_origins = {"https://viewer.example"}});
  const auto status = [&](const char* origin) {
    return refused(access, request_of("POST", {{"Host", "localhost:8080"}, {"Origin", origin}}));
  };
  EXPECT_EQ(0, status("http://localhost:8080"));
  EXPECT_EQ(0, status("https://viewer.example"));
  for (const char* origin : {"null",
                             "",
                             "http://localhost",
                             "http://localhost:8081",
                             "https://localhost:8080",
                             "http://evil.example",
                             "localhost:8080",
                             "http://viewer.example",
                             "https://viewer.example:444",
                             "http://localhost:8080.evil.example",
                             "http://127.0.0.1:8080"}) {
    EXPECT_EQ(403, status(origin)) << origin;
  }
}

TEST(NetAccess, TheDefaultPortMayBeWrittenOrNot) {
  const Access access({});
  for (const auto& [host, origin] :
       std::vector<std::pair<const char*, const char*>>{{"localhost", "http://localhost"},
                                                        {"localhost:80", "http://localhost"},
                                                        {"localhost", "http://localhost:80"}}) {
    EXPECT_EQ(0, refused(access, request_of("POST", {{"Host", host}, {"Origin", origin}}))) << host;
  }
}

TEST(NetAccess, OriginIsJudgedOnUpgradesButNotOnReading) {
  const Access access({});
  const Request foreign =
      request_of("GET", {{"Host", "localhost"}, {"Origin", "http://evil.example"}});
  EXPECT_EQ(0, refused(access, foreign));
  EXPECT_EQ(403, refused(access, foreign, true));
}

TEST(NetAccess, WithoutOriginOnlyFromHereOrWithTheTokenOrInsecure) {
  const std::vector<Header> host{{"Host", "localhost"}};
  EXPECT_EQ(0, refused(Access({}), request_of("POST", host, true)));
  EXPECT_EQ(403, refused(Access({}), request_of("POST", host, false)));
  EXPECT_EQ(0, refused(Access({.insecure = true}), request_of("POST", host, false)));
  const Access guarded({.token = kToken});
  EXPECT_EQ(401, refused(guarded, request_of("POST", host, false)));
  EXPECT_EQ(
      0,
      refused(guarded,
              request_of(
                  "POST", {{"Host", "localhost"}, {"Authorization", "Bearer " + kToken}}, false)));
}

TEST(NetAccess, TheTokenIsNeededWhole) {
  const Access access({.token = kToken});
  const auto status = [&](const std::string& value) {
    return refused(access, request_of("GET", {{"Host", "localhost"}, {"Authorization", value}}));
  };
  EXPECT_EQ(0, status("Bearer " + kToken));
  EXPECT_EQ(0, status("bearer " + kToken));
  for (const std::string& value : std::vector<std::string>{"",
                                                           "Bearer",
                                                           "Bearer ",
                                                           "Basic " + kToken,
                                                           kToken,
                                                           "Bearer " + kToken.substr(1),
                                                           "Bearer " + kToken + "0",
                                                           "Bearer " + kToken + kToken,
                                                           "Bearer x" + kToken.substr(1)}) {
    EXPECT_EQ(401, status(value)) << value;
  }
}

TEST(NetAccess, AShortTokenIsRefusedAtTheStart) {
  EXPECT_THROW(Access({.token = "secret"}), std::invalid_argument);
}

TEST(NetAccess, ComparesWholeTexts) {
  EXPECT_TRUE(equal_constant_time("abc", "abc"));
  EXPECT_TRUE(equal_constant_time("", ""));
  EXPECT_FALSE(equal_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_constant_time("abc", "ab"));
  EXPECT_FALSE(equal_constant_time("ab", "abab"));
  EXPECT_FALSE(equal_constant_time("abab", "ab"));
  EXPECT_FALSE(equal_constant_time("a", ""));
  EXPECT_FALSE(equal_constant_time("", "a"));
}

class NetLogin : public testing::Test {
 protected:
  NetLogin() {
    ServerOptions options;
    options.access.token = kToken;
    running_.emplace(options);
    running_->server.router().add("GET", "/api/v1/session", SyncHandler([](const Request&) {
                                    return json_response(200, "{}");
                                  }));
    running_->server.router().add("GET", "/api/v1/healthz", SyncHandler([](const Request&) {
                                    return json_response(200, "{}");
                                  }));
    WsEndpoint endpoint;
    endpoint.path = "/ws";
    endpoint.subprotocols = {"foxglove.websocket.v1"};
    running_->server.add(endpoint);
    running_->start();
  }
  std::uint16_t port() const { return running_->port(); }
  std::optional<RunningServer> running_{};
};

TEST_F(NetLogin, TheRightTokenGivesACookieThatOpensApiAndSocket) {
  const Answer login =
      ask(port(), post_request("/api/v1/login", R"({"token":")" + kToken + R"("})"));
  EXPECT_EQ(204, login.status);
  const std::string cookie = login.headers.at("Set-Cookie");
  EXPECT_NE(std::string::npos, cookie.find("; HttpOnly"));
  EXPECT_NE(std::string::npos, cookie.find("; SameSite=Strict"));
  EXPECT_EQ(std::string::npos, cookie.find(kToken));
  const std::string header =
      "Cookie: theme=dark; " + cookie.substr(0, cookie.find(';')) + "; x=y\r\n";
  EXPECT_EQ(200, ask(port(), get_request("/api/v1/session", header)).status);
  Client socket(port());
  socket.send(upgrade_request("foxglove.websocket.v1", header));
  EXPECT_EQ(101, read_answer(socket, false).status);
}

TEST_F(NetLogin, WithoutItNothingButTheHealthCheckAnswers) {
  EXPECT_EQ(401, ask(port(), get_request("/api/v1/session")).status);
  EXPECT_EQ(401, ask(port(), upgrade_request()).status);
  EXPECT_EQ(401,
            ask(port(), get_request("/api/v1/session", "Cookie: tautline_session=\r\n")).status);
  EXPECT_EQ(
      401, ask(port(), get_request("/api/v1/session", "Cookie: tautline_session=0123\r\n")).status);
  EXPECT_EQ(200, ask(port(), get_request("/api/v1/healthz")).status);
  EXPECT_EQ("Bearer", ask(port(), get_request("/api/v1/session")).headers.at("WWW-Authenticate"));
}

TEST_F(NetLogin, WrongOrMalformedLoginsAreRefused) {
  EXPECT_EQ(401, ask(port(), post_request("/api/v1/login", R"({"token":"x"})")).status);
  EXPECT_EQ(422, ask(port(), post_request("/api/v1/login", R"({"token":1})")).status);
  EXPECT_EQ(400, ask(port(), post_request("/api/v1/login", "{")).status);
  EXPECT_EQ(403,
            ask(port(),
                post_request("/api/v1/login",
                             R"({"token":")" + kToken + R"("})",
                             "Content-Type: application/json\r\nOrigin: http://evil.example\r\n"))
                .status);
}

TEST_F(NetLogin, AForeignOriginIsRefusedEvenWithTheToken) {
  const std::string headers =
      "Authorization: Bearer " + kToken + "\r\nOrigin: http://evil.example\r\n";
  EXPECT_EQ(403, ask(port(), upgrade_request("foxglove.websocket.v1", headers)).status);
}

TEST_F(NetLogin, AForeignHostIsMisdirected) {
  EXPECT_EQ(421, ask(port(), "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n").status);
}

}  // namespace
}  // namespace server::net::test
