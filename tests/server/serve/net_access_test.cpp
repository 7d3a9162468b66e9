// tests/server/serve/net_access_test.cpp: Host, Origin, token and login, on values and over
// sockets.
#include <string>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>

#include "server/serve/net/access.hpp"

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

/// Status of the refusal, 0 for an accepted request.
int refused(Access& access, Request request, bool upgrade = false) {
  const auto refusal = access.refuse(request, "10.1.2.3", upgrade, true, Clock::now());
  return refusal ? refusal->status : 0;
}

TEST(NetAccess, AcceptsOnlyTheNamesOfThisServer) {
  Access access({.allow_hosts = {"robot.lan", "demo.example:8443"}});
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
  Access access({.allow_origins = {"https://viewer.example"}});
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
  Access access({});
  for (const auto& [host, origin] :
       std::vector<std::pair<const char*, const char*>>{{"localhost", "http://localhost"},
                                                        {"localhost:80", "http://localhost"},
                                                        {"localhost", "http://localhost:80"}}) {
    EXPECT_EQ(0, refused(access, request_of("POST", {{"Host", host}, {"Origin", origin}}))) << host;
  }
}

TEST(NetAccess, ReadingLoginAndHealthRequestsAreNotDriving) {
  const Access access({.token = kToken});
  for (const auto& [method, path, drives] : {std::tuple{"PUT", "/api/v1/session/goal", true},
                                             {"POST", "/api/v1/session/control", true},
                                             {"GET", "/api/v1/session", false},
                                             {"HEAD", "/api/v1/session", false},
                                             {"OPTIONS", "/api/v1/session/goal", false},
                                             {"POST", "/api/v1/login", false},
                                             {"POST", "/api/v1/healthz", false}}) {
    Request request = request_of(method, {});
    request.path = path;
    EXPECT_EQ(access.may_drive(request, false, true), drives) << method << path;
  }
  EXPECT_TRUE(access.may_drive(request_of("GET", {}), true, false));  // an upgrade
}

TEST(NetAccess, OriginIsCheckedOnUpgradesButNotOnReading) {
  Access access({});
  const Request foreign =
      request_of("GET", {{"Host", "localhost"}, {"Origin", "http://evil.example"}});
  EXPECT_EQ(0, refused(access, foreign));
  EXPECT_EQ(403, refused(access, foreign, true));
}

TEST(NetAccess, WithoutOriginOnlyLocallyOrWithTokenOrInsecure) {
  const std::vector<Header> host{{"Host", "localhost"}};
  Access plain({});
  Access insecure({.insecure = true});
  EXPECT_EQ(0, refused(plain, request_of("POST", host, true)));
  EXPECT_EQ(403, refused(plain, request_of("POST", host, false)));
  EXPECT_EQ(0, refused(insecure, request_of("POST", host, false)));
  Access guarded({.token = kToken});
  EXPECT_EQ(401, refused(guarded, request_of("POST", host, false)));
  EXPECT_EQ(
      0,
      refused(guarded,
              request_of(
                  "POST", {{"Host", "localhost"}, {"Authorization", "Bearer " + kToken}}, false)));
}

TEST(NetAccess, BehindATrustedProxyThatEncryptsTheOriginIsHttps) {
  Access access({.allow_hosts = {"robot.lan"}, .trusted_proxies = {"127.0.0.1"}});
  const auto status = [&](const char* peer, const char* host, const char* origin) {
    Request request = request_of("POST",
                                 {{"Host", host},
                                  {"Origin", origin},
                                  {"X-Forwarded-For", "203.0.113.7"},
                                  {"X-Forwarded-Proto", "https"}});
    access.identify(request, *Address::parse(peer));
    return refused(access, request);
  };
  EXPECT_EQ(0, status("127.0.0.1", "robot.lan", "https://robot.lan"));
  EXPECT_EQ(0, status("127.0.0.1", "robot.lan:443", "https://robot.lan"));
  EXPECT_EQ(0, status("127.0.0.1", "robot.lan:8443", "https://robot.lan:8443"));
  EXPECT_EQ(403, status("127.0.0.1", "robot.lan", "http://robot.lan"));
  EXPECT_EQ(403, status("127.0.0.1", "robot.lan", "https://evil.example"));
  // The header counts only from a trusted proxy.
  EXPECT_EQ(403, status("127.0.0.2", "robot.lan", "https://robot.lan"));
  Request untrusted = request_of("POST", {{"Host", "robot.lan"}, {"Origin", "https://robot.lan"}});
  const auto refusal = access.refuse(untrusted, "10.1.2.3", false, true, Clock::now());
  ASSERT_TRUE(refusal);
  EXPECT_NE(std::string::npos, refusal->body->find("--trusted-proxy"));
}

TEST(NetAccess, WrongTokensMustWaitAndTheRightOneStillPasses) {
  std::vector<std::string> lines;
  Access access({.token = kToken}, [&](std::string_view line) { lines.emplace_back(line); });
  const Clock::time_point now = Clock::now();
  const auto ask_from = [&](const char* peer, const std::string& token) {
    Request request =
        request_of("GET", {{"Host", "localhost"}, {"Authorization", "Bearer " + token}});
    access.identify(request, *Address::parse(peer));
    return access.refuse(request, "10.1.2.3", false, true, now);
  };
  std::size_t guesses = 0;
  std::optional<Response> refusal = ask_from("203.0.113.7", "wrong-wrong-wrong-0");
  for (; refusal && refusal->status == 401 && guesses < 100; ++guesses) {
    refusal = ask_from("203.0.113.7", "wrong-wrong-wrong-" + std::to_string(guesses));
  }
  EXPECT_EQ(std::size_t(GuessThrottle::kGuesses), guesses);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(429, refusal->status);
  ASSERT_EQ("Retry-After", refusal->headers.at(0).name);
  EXPECT_EQ("5", refusal->headers.at(0).value);
  EXPECT_FALSE(ask_from("203.0.113.7", kToken)) << "a neighbour behind the same router";
  EXPECT_FALSE(ask_from("203.0.113.8", kToken));
  EXPECT_EQ(401, ask_from("203.0.113.8", "wrong-wrong-wrong")->status);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ("A wrong token came from 203.0.113.7.", lines[0]);
  for (const std::string& line : lines) EXPECT_EQ(std::string::npos, line.find("wrong-wrong"));
}

TEST(NetAccess, AGuessAtLoginAndOneAtTheApiCountAlike) {
  Access access({.token = kToken});
  const Clock::time_point now = Clock::now();
  const auto log_in = [&](const std::string& token) {
    Request request = request_of("POST", {{"Host", "localhost"}});
    request.path = Access::kLoginPath;
    request.peer = "203.0.113.7";
    request.body = R"({"token":")" + token + R"("})";
    return access.login(request, now).status;
  };
  for (int i = 0; i < int(GuessThrottle::kGuesses); ++i) EXPECT_EQ(401, log_in("x"));
  EXPECT_EQ(429, log_in("x"));
  Request request = request_of("GET", {{"Host", "localhost"}, {"Authorization", "Bearer x"}});
  request.peer = "203.0.113.7";
  EXPECT_EQ(429, refused(access, request));
  EXPECT_EQ(204, log_in(kToken));
}

TEST(NetAccess, TheCookieEndsUnusedAndWithALogout) {
  Access access({.token = kToken, .trusted_proxies = {"127.0.0.1"}});
  Clock::time_point now = Clock::now();
  const auto log_in = [&](bool https) {
    Request request = request_of("POST", {{"Host", "localhost"}});
    request.https = https;
    request.body = R"({"token":")" + kToken + R"("})";
    return access.login(request, now).headers.at(0).value;
  };
  const std::string plain = log_in(false);
  EXPECT_EQ(std::string::npos, plain.find("Secure"));
  EXPECT_NE(std::string::npos, plain.find("; Max-Age=604800"));
  EXPECT_NE(std::string::npos, log_in(true).find("; Secure"));

  Request request = request_of("GET", {{"Host", "localhost"}});
  request.headers.push_back({"Cookie", plain.substr(0, plain.find(';'))});
  const auto status = [&] {
    const auto refusal = access.refuse(request, "10.1.2.3", false, true, now);
    return refusal ? refusal->status : 0;
  };
  for (int day = 0; day < 30; ++day) {  // one in use lives on
    now += LoginSessions::kIdle;
    EXPECT_EQ(0, status());
  }
  ASSERT_TRUE(access.renewal(request, now)) << "the browser's own clock is set back as well";
  EXPECT_FALSE(access.renewal(request, now));
  now += LoginSessions::kIdle + std::chrono::seconds(1);
  EXPECT_EQ(401, status());

  const std::string second = log_in(false);
  request.headers.back().value = second.substr(0, second.find(';'));
  EXPECT_EQ(0, status());
  const Response out = access.logout(request);
  EXPECT_EQ(204, out.status);
  EXPECT_NE(std::string::npos, out.headers.at(0).value.find("tautline_session=; "));
  EXPECT_NE(std::string::npos, out.headers.at(0).value.find("Max-Age=0"));
  EXPECT_EQ(401, status());
}

TEST(NetAccess, AScriptElsewhereMayLogInWithoutAnOrigin) {
  Access access({.token = kToken});
  Request request = request_of("POST", {{"Host", "localhost"}}, false);
  request.path = Access::kLoginPath;
  EXPECT_EQ(0, refused(access, request));
}

TEST(NetAccess, TheWholeTokenIsNeeded) {
  Access access({.token = kToken});
  int guest = 0;  // each from another address, so that none must wait
  const auto status = [&](const std::string& value) {
    Request request = request_of("GET", {{"Host", "localhost"}, {"Authorization", value}});
    request.peer = "10.9.9." + std::to_string(++guest);
    return refused(access, request);
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

TEST_F(NetLogin, WithoutATokenOnlyTheHealthCheckAnswers) {
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

TEST_F(NetLogin, ALogoutEndsTheCookieAndItsSockets) {
  const auto log_in = [&] {
    const Answer login =
        ask(port(), post_request("/api/v1/login", R"({"token":")" + kToken + R"("})"));
    const std::string cookie = login.headers.at("Set-Cookie");
    return "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
  };
  const std::string mine = log_in();
  const std::string other = log_in();
  Client my_socket(port());
  my_socket.send(upgrade_request("foxglove.websocket.v1", mine));
  ASSERT_EQ(101, read_answer(my_socket, false).status);
  Client other_socket(port());
  other_socket.send(upgrade_request("foxglove.websocket.v1", other));
  ASSERT_EQ(101, read_answer(other_socket, false).status);
  const Answer out =
      ask(port(), "POST /api/v1/logout HTTP/1.1\r\nHost: localhost\r\n" + mine + "\r\n");
  EXPECT_EQ(204, out.status);
  EXPECT_NE(std::string::npos, out.headers.at("Set-Cookie").find("Max-Age=0"));
  EXPECT_EQ("\x88", my_socket.take(1)) << "a closing frame";
  EXPECT_EQ(401, ask(port(), get_request("/api/v1/session", mine)).status);
  EXPECT_EQ(200, ask(port(), get_request("/api/v1/session", other)).status);
  EXPECT_FALSE(other_socket.ends_within(50ms));
}

}  // namespace
}  // namespace server::net::test
