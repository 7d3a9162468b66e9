// tests/server/serve/net_server_test.cpp: HTTP over loopback sockets: limits, timeouts, malformed
// input.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace server::net::test {
namespace {

/// Echo, a handler that throws and one that answers later.
void add_routes(Router& router, std::vector<Responder>* waiting = nullptr) {
  router.add("GET", "/api/v1/healthz", SyncHandler([](const Request&) {
               return json_response(200, R"({"ok":true})");
             }));
  router.add("POST", "/api/v1/echo", SyncHandler([](const Request& r) {
               return json_response(200, r.body);
             }));
  router.add("GET", "/api/v1/runs/{id}", SyncHandler([](const Request& r) {
               return text_response(200, "text/plain", r.params.at("id"));
             }));
  router.add("GET", "/api/v1/throws", SyncHandler([](const Request&) -> Response {
               throw std::runtime_error("the disk is on fire");
             }));
  if (waiting != nullptr) {
    router.add("GET", "/api/v1/later", Handler([waiting](const Request&, const Responder& r) {
                 waiting->push_back(r);
               }));
  }
}

class NetServer : public testing::Test {
 protected:
  void serve(ServerOptions options = {}) {
    running_.emplace(std::move(options));
    add_routes(running_->server.router(), &waiting_);
    running_->start();
  }
  std::uint16_t port() const { return running_->port(); }
  Answer ask(std::string_view request) const { return test::ask(port(), request); }
  void expect_alive() const { EXPECT_EQ(200, ask(get_request("/api/v1/healthz")).status); }

  std::vector<Responder> waiting_{};  // io thread only
  std::optional<RunningServer> running_{};
};

TEST_F(NetServer, AnswersARoute) {
  serve();
  const Answer answer = ask(get_request("/api/v1/runs/12"));
  EXPECT_EQ(200, answer.status);
  EXPECT_EQ("12", answer.body);
  EXPECT_EQ("nosniff", answer.headers.at("X-Content-Type-Options"));
  EXPECT_NE(std::string::npos,
            answer.headers.at("Content-Security-Policy").find("default-src 'none'"));
}

TEST_F(NetServer, EchoesABody) {
  serve();
  EXPECT_EQ(R"({"a":1})", ask(post_request("/api/v1/echo", R"({"a":1})")).body);
}

TEST_F(NetServer, ReadsAChunkedBody) {
  serve();
  const Answer answer =
      ask("POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
          "Transfer-Encoding: chunked\r\n\r\n3\r\n[1,\r\n2\r\n2]\r\n0\r\n\r\n");
  EXPECT_EQ(200, answer.status);
  EXPECT_EQ("[1,2]", answer.body);
}

TEST_F(NetServer, SaysGoOnToAClientThatAsksFirst) {
  serve();
  Client client(port());
  client.send(
      "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ("HTTP/1.1 100 Continue\r\n\r\n", client.take_through("\r\n\r\n"));
  client.send("{}");
  EXPECT_EQ("{}", read_answer(client).body);
}

TEST_F(NetServer, AnswersPipelinedRequestsInOrder) {
  serve();
  Client client(port());
  std::string requests;
  for (int i = 0; i < 20; ++i) requests += get_request("/api/v1/runs/" + std::to_string(i));
  client.send(requests);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(std::to_string(i), read_answer(client).body);
}

TEST_F(NetServer, ReadsARequestSentByteByByte) {
  serve();
  Client client(port());
  for (const char c : post_request("/api/v1/echo", R"({"a":1})")) {
    client.send({&c, 1});
  }
  EXPECT_EQ(R"({"a":1})", read_answer(client).body);
}

TEST_F(NetServer, HeadHasTheLengthButNoBody) {
  serve();
  Client client(port());
  client.send("HEAD /api/v1/runs/123 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const Answer head = read_answer(client, false);
  EXPECT_EQ(200, head.status);
  EXPECT_EQ("3", head.headers.at("Content-Length"));
  // The next answer on the same connection starts right behind the header.
  client.send(get_request("/api/v1/runs/4"));
  EXPECT_EQ("4", read_answer(client).body);
}

TEST_F(NetServer, AnExceptionInAHandlerIsA500WithItsSentence) {
  serve();
  const Answer answer = ask(get_request("/api/v1/throws"));
  EXPECT_EQ(500, answer.status);
  EXPECT_EQ("application/problem+json", answer.headers.at("Content-Type"));
  EXPECT_NE(std::string::npos, answer.body.find("the disk is on fire"));
  expect_alive();
}

TEST_F(NetServer, AnswersLaterAndOnlyOnce) {
  serve();
  Client client(port());
  client.send(get_request("/api/v1/later"));
  ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 1; }));
  running_->on_io([&] {
    waiting_[0](text_response(200, "text/plain", "first"));
    waiting_[0](text_response(200, "text/plain", "second"));
    return 0;
  });
  EXPECT_EQ("first", read_answer(client).body);
  client.send(get_request("/api/v1/runs/7"));
  EXPECT_EQ("7", read_answer(client).body);
}

TEST_F(NetServer, AnAnswerToAClientThatHasGoneDoesNothing) {
  serve();
  {
    Client client(port());
    client.send(get_request("/api/v1/later"));
    ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 1; }));
  }
  running_->on_io([&] {
    waiting_[0](text_response(200, "text/plain", std::string(100'000, 'x')));
    return 0;
  });
  expect_alive();
}

TEST_F(NetServer, AForgottenResponderIsA500) {
  serve();
  Client client(port());
  client.send(get_request("/api/v1/later"));
  ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 1; }));
  running_->on_io([&] {
    waiting_.clear();
    return 0;
  });
  EXPECT_EQ(500, read_answer(client).status);
}

TEST_F(NetServer, AResponderThatOutlivesTheServerIsHarmless) {
  serve();
  Client client(port());
  client.send(get_request("/api/v1/later"));
  ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 1; }));
  running_->stop();
  running_.reset();
  waiting_[0](text_response(200, "text/plain", "too late"));
  EXPECT_TRUE(client.ends_within(1s));
}

TEST_F(NetServer, RefusesALongHeader) {
  serve();
  const Answer answer = ask(get_request("/", "X-Long: " + std::string(9000, 'a') + "\r\n"));
  EXPECT_EQ(431, answer.status);
  expect_alive();
}

TEST_F(NetServer, RefusesALongTarget) {
  serve();
  EXPECT_EQ(431, ask(get_request("/" + std::string(9000, 'a'))).status);
}

TEST_F(NetServer, RefusesALongBodyByItsAnnouncedLength) {
  serve();
  const Answer answer = ask(post_request("/api/v1/echo", std::string((1 << 20) + 1, ' ')));
  EXPECT_EQ(413, answer.status);
  EXPECT_NE(std::string::npos, answer.body.find("1048576"));
  expect_alive();
}

TEST_F(NetServer, RefusesALongChunkedBody) {
  ServerOptions options;
  options.limits.body_bytes = 1000;
  serve(options);
  std::string request =
      "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Transfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 20; ++i) request += "64\r\n" + std::string(100, ' ') + "\r\n";
  EXPECT_EQ(413, ask(request + "0\r\n\r\n").status);
}

TEST_F(NetServer, RefusesLengthTogetherWithChunks) {
  serve();
  for (const char* both : {"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n",
                           "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"}) {
    const Answer answer =
        ask("POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" +
            std::string(both) + "\r\n0\r\n\r\n");
    EXPECT_EQ(400, answer.status) << both;
  }
}

TEST_F(NetServer, RefusesABodyThatIsNotJson) {
  serve();
  EXPECT_EQ(415, ask(post_request("/api/v1/echo", "a=1", "")).status);
  EXPECT_EQ(415,
            ask(post_request(
                    "/api/v1/echo", "a=1", "Content-Type: application/x-www-form-urlencoded\r\n"))
                .status);
  EXPECT_EQ(
      200,
      ask(post_request("/api/v1/echo", "{}", "Content-Type: application/json; charset=utf-8\r\n"))
          .status);
}

TEST_F(NetServer, UnknownPathsAndMethodsGetSpecificAnswers) {
  serve();
  EXPECT_EQ(404, ask(get_request("/api/v1/nothing")).status);
  const Answer answer = ask(get_request("/api/v1/echo"));
  EXPECT_EQ(405, answer.status);
  EXPECT_EQ("POST", answer.headers.at("Allow"));
  EXPECT_EQ(405, nlohmann::json::parse(answer.body).at("status"));
}

TEST_F(NetServer, TwentyMalformedRequestsGet400AndTheServerLives) {
  serve();
  const std::string ok = "Host: localhost\r\n\r\n";
  for (const std::string& request : std::vector<std::string>{
           "\r\n\r\n\r\nnonsense\r\n\r\n",
           "GET\r\n\r\n",
           "GET /\r\n" + ok,
           "GET / HTTP/9.9\r\n" + ok,
           "GET / HTTP/1.1 extra\r\n" + ok,
           "G@T / HTTP/1.1\r\n" + ok,
           "GET  / HTTP/1.1\r\n" + ok,
           "GET relative HTTP/1.1\r\n" + ok,
           "GET http://localhost/ HTTP/1.1\r\n" + ok,
           "GET /%zz HTTP/1.1\r\n" + ok,
           "GET /%2 HTTP/1.1\r\n" + ok,
           "GET /%00 HTTP/1.1\r\n" + ok,
           "GET /%c0%ae HTTP/1.1\r\n" + ok,
           "GET /?a=%f5 HTTP/1.1\r\n" + ok,
           "GET / HTTP/1.1\r\n\r\n",
           "GET / HTTP/1.1\r\nHost: localhost\r\n" + ok,
           "GET / HTTP/1.1\r\nBad Header: x\r\n" + ok,
           "GET / HTTP/1.1\r\n: empty\r\n" + ok,
           "POST /api/v1/echo HTTP/1.1\r\nContent-Length: -1\r\n" + ok,
           "POST /api/v1/echo HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n" + ok,
           "POST /api/v1/echo HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n" + ok,
           std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 15)}) {
    EXPECT_EQ(400, ask(request).status) << request;
  }
  expect_alive();
}

TEST_F(NetServer, ClosesSlowHeadersAndSlowBodies) {
  ServerOptions options;
  options.timeouts.header = 200ms;
  options.timeouts.body = 200ms;
  serve(options);
  Client header(port());
  Client body(port());
  header.send("GET / HTTP/1.1\r\nHost: loc");
  body.send(
      "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 10\r\n\r\n{");
  // Slow bytes do not extend the timeout.
  const auto deadline = steady_clock::now() + 2s;
  bool header_open = true;
  while (header_open && steady_clock::now() < deadline) {
    header_open = header.send("a") && !header.ends_within(20ms);
  }
  EXPECT_FALSE(header_open);
  EXPECT_EQ(408, read_answer(body).status);
  EXPECT_TRUE(body.ends_within(1s));
}

TEST_F(NetServer, FiftyHalfOpenConnectionsDelayNoClientAndEnd) {
  ServerOptions options;
  options.timeouts.header = 600ms;
  serve(options);
  std::vector<Client> half_open;
  for (int i = 0; i < 50; ++i) {
    half_open.emplace_back(port());
    half_open.back().send("GET / HT");
  }
  const auto before = steady_clock::now();
  expect_alive();
  EXPECT_LT(steady_clock::now() - before, 500ms);
  for (Client& client : half_open) EXPECT_TRUE(client.ends_within(2s));
  EXPECT_TRUE(eventually(
      [&] { return running_->on_io([&] { return running_->server.connections(); }) == 0; }));
}

TEST_F(NetServer, ClosesIdleConnections) {
  ServerOptions options;
  options.timeouts.idle = 100ms;
  serve(options);
  Client client(port());
  client.send(get_request("/api/v1/healthz"));
  EXPECT_EQ(200, read_answer(client).status);
  EXPECT_TRUE(client.ends_within(2s));
}

TEST_F(NetServer, AtTheConnectionLimitItSays503) {
  ServerOptions options;
  options.limits.connections = 3;
  serve(options);
  std::vector<Client> open;
  for (std::size_t i = 0; i < 3; ++i) {
    open.emplace_back(port());
    open.back().send(get_request("/api/v1/later"));
    ASSERT_TRUE(
        eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == i + 1; }));
  }
  Client refused(port());
  EXPECT_EQ(503, read_answer(refused).status);
  open.clear();
  running_->on_io([&] {
    waiting_.clear();
    return 0;
  });
  EXPECT_TRUE(eventually([&] { return ask(get_request("/api/v1/healthz")).status == 200; }));
}

TEST_F(NetServer, IdleConnectionsOfOneAddressStarveNoOther) {
  ServerOptions options;
  options.limits.connections = 300;
  options.limits.connections_per_address = 64;
  serve(options);
  // Half a request each, as an attacker holds a connection; from several addresses.
  std::vector<Client> idle;
  for (const char* from : {"127.0.0.2",
                           "127.0.0.2",
                           "127.0.0.2",
                           "127.0.0.4",
                           "127.0.0.5",
                           "127.0.0.6",
                           "127.0.0.7",
                           "127.0.0.8"}) {
    for (int i = 0; i < 64; ++i) {
      idle.emplace_back(port(), 0, from);
      idle.back().send("GET /api/v1/runs/1 HTTP/1.1\r\nX-Slow: ");
    }
    for (const char* honest : {"127.0.0.3", "127.0.0.2", "127.0.0.1"}) {
      Client client(port(), 0, honest);
      client.send(get_request("/api/v1/healthz"));
      EXPECT_EQ(200, read_answer(client).status) << honest << " beside " << from;
    }
  }
  EXPECT_LE(running_->on_io([&] { return running_->server.connections(); }), 300u);
}

TEST_F(NetServer, AClientBehindATrustedProxyIsCountedForItself) {
  ServerOptions options;
  options.limits.connections_per_address = 8;
  options.access.trusted_proxies = {"127.0.0.1"};
  serve(options);
  const auto later = [](const std::string& client) {
    return get_request("/api/v1/later", "X-Forwarded-For: " + client + "\r\n");
  };
  std::vector<Client> open;
  for (int visitor = 0; visitor < 40; ++visitor) {  // each with one on its way
    open.emplace_back(port());
    open.back().send(later("203.0.113." + std::to_string(visitor)));
  }
  ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 40; }));
  for (int i = 0; i < 7; ++i) {  // and the last one seven more
    open.emplace_back(port());
    open.back().send(later("203.0.113.39"));
  }
  ASSERT_TRUE(eventually([&] { return running_->on_io([&] { return waiting_.size(); }) == 47; }));
  EXPECT_EQ(429, ask(later("203.0.113.39")).status);
  EXPECT_EQ(200, ask(get_request("/api/v1/healthz", "X-Forwarded-For: 203.0.113.40\r\n")).status);
  // One connection of the proxy carries requests of many clients in turn.
  Client shared(port());
  for (int visitor = 0; visitor < 20; ++visitor) {
    const std::string header = "X-Forwarded-For: 198.51.100." + std::to_string(visitor) + "\r\n";
    shared.send(get_request("/api/v1/healthz", header));
    EXPECT_EQ(200, read_answer(shared).status);
  }
  running_->on_io([&] {
    waiting_.clear();
    return 0;
  });
}

TEST_F(NetServer, TimersKeepTheirPeriodAndSurviveAnException) {
  running_.emplace();
  int calls = 0;
  running_->server.every(20ms, [&] {
    ++calls;
    throw std::runtime_error("timer");
  });
  const auto start = std::chrono::steady_clock::now();
  running_->start();
  const auto seen = [&] { return running_->on_io([&] { return calls; }); };
  EXPECT_TRUE(eventually([&] { return seen() >= 5; }, 30s));
  // A loaded machine may miss periods; missed ones are never repeated in a burst.
  const int count = seen();
  EXPECT_LE(count, (std::chrono::steady_clock::now() - start) / 20ms + 1);
}

TEST(NetServerSetup, APortInUseIsOneSentence) {
  RunningServer first;
  ServerOptions options;
  options.port = first.port();
  try {
    Server second(options);
    FAIL() << "two servers on one port";
  } catch (const ServerError& error) {
    const std::string what = error.what();
    EXPECT_NE(std::string::npos, what.find("another program uses that port"));
    EXPECT_NE(std::string::npos, what.find(std::to_string(first.port())));
  }
}

TEST(NetServerSetup, ListensBeyondLoopbackOnlyWithTokenOrInsecure) {
  ServerOptions options;
  options.address = "0.0.0.0";
  options.port = 0;
  EXPECT_THROW(Server{options}, ServerError);
  options.access.insecure = true;
  EXPECT_NO_THROW(Server{options});
  options.access.insecure = false;
  options.access.token = "0123456789abcdef0123456789abcdef";
  EXPECT_NO_THROW(Server{options});
}

TEST(NetServerSetup, RefusesAddressesItCannotUse) {
  ServerOptions options;
  options.port = 0;
  options.address = "robot.example";
  EXPECT_THROW(Server{options}, ServerError);
  options.address = "192.0.2.1";  // TEST-NET-1: nobody's
  options.access.insecure = true;
  EXPECT_THROW(Server{options}, ServerError);
}

}  // namespace
}  // namespace server::net::test
