// tests/server/serve/net_body_test.cpp: the length of bodies, refusals, and bodies produced while
// being sent.
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>

#include "server/serve/net/body_room.hpp"

namespace server::net::test {
namespace {

class NetBody : public testing::Test {
 protected:
  void serve() {
    running_.emplace();
    add("/api/v1/echo", Router::kAnyBody);
    running_->server.router().add("GET", "/api/v1/runs/{id}", SyncHandler([](const Request& r) {
                                    return text_response(200, "text/plain", r.params.at("id"));
                                  }));
    running_->start();
  }
  void add(const char* path, std::size_t body_bytes) {
    running_->server.router().add(
        "POST",
        path,
        SyncHandler([](const Request& r) { return json_response(200, r.body); }),
        body_bytes);
  }
  Answer ask(std::string_view request) const { return test::ask(running_->port(), request); }
  std::uint16_t port() const { return running_->port(); }

  std::optional<RunningServer> running_{};
};

/// The rest of a body read with a wrong length would run as a second request.
TEST_F(NetBody, AnUnknownTransferCodingIs501AndTheEndOfTheConnection) {
  serve();
  for (const char* coding : {"gzip",
                             "identity",
                             "gzip, chunked",
                             "chunked, gzip",
                             "xchunked",
                             "chunked;q=1",
                             "\"chunked\"",
                             ""}) {
    Client client(port());
    client.send(
        "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\n"
        "Content-Type: application/json\r\nTransfer-Encoding: " +
        std::string(coding) + "\r\n\r\n" + get_request("/api/v1/runs/77"));
    EXPECT_EQ(501, read_answer(client).status) << coding;
    EXPECT_TRUE(client.ends_within(5s)) << coding;
    EXPECT_EQ(std::string::npos, client.input().find("77")) << coding;
  }
}

TEST_F(NetBody, ABodyOfDoubtfulLengthIsRefusedAndTheEndOfTheConnection) {
  serve();
  const std::string start =
      "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  for (const std::string& lines :
       std::vector<std::string>{"Content-Length: 2\r\nContent-Length: 2\r\n",
                                "Content-Length: 2\r\nContent-Length: 40\r\n",
                                "Content-Length: 2, 2\r\n",
                                "Content-Length: +2\r\n",
                                "Content-Length: -2\r\n",
                                "Content-Length: 0x2\r\n",
                                "Content-Length: 99999999999999999999\r\n",
                                "Content-Length : 2\r\n",
                                "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
                                "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n",
                                "Transfer-Encoding : chunked\r\n",
                                "Host: localhost\r\nContent-Length: 2\r\n"}) {
    Client client(port());
    client.send(start + lines + "\r\n{}" + get_request("/api/v1/runs/77"));
    EXPECT_EQ(400, read_answer(client).status) << lines;
    EXPECT_TRUE(client.ends_within(5s)) << lines;
    EXPECT_EQ(std::string::npos, client.input().find("77")) << lines;
  }
  EXPECT_EQ(400,
            ask("POST /api/v1/echo HTTP/1.0\r\nHost: localhost\r\n"
                "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n")
                .status);
}

TEST_F(NetBody, ARouteMayTakeLessThanTheServer) {
  running_.emplace();
  add("/api/v1/small", 10);
  running_->start();
  EXPECT_EQ(200, ask(post_request("/api/v1/small", "[1,2,3,4]")).status);
  const Answer refused = ask(post_request("/api/v1/small", "[1,2,3,4,5]"));
  EXPECT_EQ(413, refused.status);
  EXPECT_NE(std::string::npos, refused.body.find("more than 10 bytes"));
  EXPECT_EQ(413,
            ask("POST /api/v1/small HTTP/1.1\r\nHost: localhost\r\n"
                "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n"
                "b\r\n[1,2,3,4,5]\r\n0\r\n\r\n")
                .status);
}

TEST_F(NetBody, LargeBodiesShareALimitAndSmallOnesPass) {
  serve();
  const std::string large =
      "POST /api/v1/echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 1048576\r\n\r\n[";
  std::vector<Client> slow;
  for (std::size_t bytes = 0; bytes < BodyRoom::kAll; bytes += std::size_t{1} << 20) {
    slow.emplace_back(port());
    slow.back().send(large);
  }
  const auto refused = [&] {
    Client one_more(port());
    one_more.send(large);
    const Answer answer = read_answer(one_more);
    return answer.status == 503 && answer.headers.count("Retry-After") == 1;
  };
  EXPECT_TRUE(eventually(refused));
  EXPECT_EQ(200, ask(post_request("/api/v1/echo", "[1]")).status);
  slow.clear();
  EXPECT_TRUE(eventually([&] {
    return ask(post_request("/api/v1/echo", "[" + std::string(100'000, ' ') + "]")).status == 200;
  }));
}

/// Sends `slices` slices of 100 kB; aborts after slice `good`.
class Counting final : public BodyStream {
 public:
  Counting(int slices, int good, std::atomic<int>& made)
      : slices_(slices), good_(good), made_(made) {}
  void next(std::function<void(Slice)> give) override {
    if (made_ == good_) return give(std::nullopt);
    if (made_ == slices_) return give("");
    ++made_;
    give(std::string(100'000, static_cast<char>('a' + made_ % 26)));
  }

 private:
  int slices_;
  int good_;
  std::atomic<int>& made_;
};

class NetStream : public testing::Test {
 protected:
  void serve(int slices, int good) {
    running_.server.router().add(
        "GET", "/stream", SyncHandler([this, slices, good](const Request&) {
          Response response;
          response.content_type = "text/plain";
          response.stream = std::make_shared<Counting>(slices, good, made_);
          return response;
        }));
    running_.start();
  }
  std::atomic<int> made_ = 0;
  RunningServer running_{};
};

TEST_F(NetStream, ArrivesInChunksAndTheConnectionGoesOn) {
  serve(3, 9);
  Client client(running_.port());
  client.send(get_request("/stream") + get_request("/nothing"));
  const Answer answer = read_answer(client, false);
  EXPECT_EQ(answer.headers.at("Transfer-Encoding"), "chunked");
  EXPECT_FALSE(answer.headers.contains("Content-Length"));
  std::size_t bytes = 0;
  for (std::string size = "x"; size != "0\r\n";) {
    size = client.take_through("\r\n").value_or("0\r\n");
    const std::size_t length = std::stoul(size, nullptr, 16);
    bytes += client.take(length + 2).value_or("").size() - 2;
  }
  EXPECT_EQ(bytes, 300'000u);
  EXPECT_EQ(read_answer(client).status, 404);
}

TEST_F(NetStream, EndsWithTheConnectionForHttp10) {
  serve(2, 9);
  Client client(running_.port());
  client.send("GET /stream HTTP/1.0\r\nHost: localhost\r\n\r\n");
  const Answer answer = read_answer(client);
  EXPECT_FALSE(answer.headers.contains("Transfer-Encoding"));
  EXPECT_EQ(answer.headers.at("Connection"), "close");
  EXPECT_TRUE(client.take(200'000));
  EXPECT_TRUE(client.ends_within(5s));
}

TEST_F(NetStream, IsProducedNoFasterThanItIsRead) {
  serve(10'000, 20'000);  // 1 GB
  Client client(running_.port(), 4096);
  client.send(get_request("/stream"));
  ASSERT_TRUE(eventually([&] { return made_ > 0; }));
  std::this_thread::sleep_for(200ms);
  const int made = made_;
  EXPECT_LT(made, 100);  // what the kernel's buffers took
  ASSERT_TRUE(client.take(static_cast<std::size_t>(made) * 100'000));
  EXPECT_TRUE(eventually([&] { return made_ > made; }));
}

TEST_F(NetStream, AbortsWhenTheRestCannotBeProduced) {
  serve(9, 2);
  Client client(running_.port());
  client.send(get_request("/stream"));
  EXPECT_EQ(read_answer(client).status, 200);
  EXPECT_TRUE(client.ends_within(5s));
  EXPECT_EQ(client.input().find("\r\n0\r\n\r\n"), std::string::npos);
}

TEST_F(NetStream, AHeadRequestProducesNoBody) {
  serve(3, 9);
  EXPECT_EQ(test::ask(running_.port(), "HEAD /stream HTTP/1.1\r\nHost: localhost\r\n\r\n").status,
            200);
  EXPECT_EQ(made_, 0);
}

}  // namespace
}  // namespace server::net::test
