// tests/server/serve/net_ws_test.cpp: WebSockets over loopback: negotiation, malformed frames, slow
// clients.
#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>

namespace server::net::test {
namespace {

/// Counts client events; echoes text other than commands. Io thread only.
struct Recorder {
  std::map<std::uint32_t, std::shared_ptr<WsClient>> clients{};
  std::vector<std::string> received{};
  int opened = 0;
  int closed = 0;

  WsEndpoint endpoint() {
    WsEndpoint e;
    e.path = "/ws";
    e.subprotocols = {"foxglove.websocket.v1", "foxglove.sdk.v1"};
    e.on_open = [this](const std::shared_ptr<WsClient>& client) {
      ++opened;
      clients[client->id()] = client;
    };
    e.on_text = [this](WsClient& client, std::string_view text) {
      received.emplace_back(text);
      if (text == "throw") throw std::runtime_error("asked for");
      if (text == "close") return client.close(1008, "asked for");
      client.send_control(FrameKind::Text, std::make_shared<const std::string>(text));
    };
    e.on_binary = [this](WsClient&, std::string_view bytes) { received.emplace_back(bytes); };
    e.on_close = [this](WsClient& client) {
      ++closed;
      clients.erase(client.id());
    };
    return e;
  }
};

class NetWs : public testing::Test {
 protected:
  void serve(ServerOptions options = {}) {
    running_.emplace(std::move(options));
    running_->server.add(recorder_.endpoint());
    running_->server.router().add("GET", "/api/v1/healthz", SyncHandler([](const Request&) {
                                    return json_response(200, "{}");
                                  }));
    running_->start();
  }
  std::uint16_t port() const { return running_->port(); }
  int opened() {
    return running_->on_io([&] { return recorder_.opened; });
  }
  int closed() {
    return running_->on_io([&] { return recorder_.closed; });
  }
  void expect_echo() const {
    WsTestClient client(port());
    client.send_text("hello");
    const Frame frame = client.read();
    EXPECT_EQ(1, frame.opcode);
    EXPECT_EQ("hello", frame.payload);
  }

  Recorder recorder_{};
  std::optional<RunningServer> running_{};
};

TEST_F(NetWs, AnswersTheHandshakeOfTheRfc) {
  serve();
  const WsTestClient client(port());
  EXPECT_EQ(101, client.handshake.status);
  EXPECT_EQ(kWsAccept, client.handshake.headers.at("Sec-WebSocket-Accept"));
}

TEST_F(NetWs, NegotiatesExactlyOneSubprotocol) {
  serve();
  const std::vector<std::pair<std::string, std::string>> cases{
      {"foxglove.websocket.v1", "foxglove.websocket.v1"},
      {"foxglove.sdk.v1", "foxglove.sdk.v1"},
      {"foxglove.sdk.v1, foxglove.websocket.v1", "foxglove.websocket.v1"},
      {"other,foxglove.sdk.v1", "foxglove.sdk.v1"},
      // A list may be split over header lines.
      {"foxglove.sdk.v1\r\nSec-WebSocket-Protocol: foxglove.websocket.v1",
       "foxglove.websocket.v1"}};
  for (const auto& [offer, chosen] : cases) {
    const WsTestClient client(port(), offer);
    EXPECT_EQ(101, client.handshake.status) << offer;
    EXPECT_EQ(chosen, client.handshake.headers.at("Sec-WebSocket-Protocol")) << offer;
  }
  EXPECT_EQ(400, WsTestClient(port(), "").handshake.status);
  EXPECT_EQ(400, WsTestClient(port(), "foxglove.websocket.v11").handshake.status);
}

TEST_F(NetWs, RefusesUpgradesElsewhereAndPlainRequestsHere) {
  serve();
  EXPECT_EQ(404, ask(port(), upgrade_request("foxglove.sdk.v1", "", "/other")).status);
  const Answer plain = ask(port(), get_request("/ws"));
  EXPECT_EQ(426, plain.status);
  EXPECT_EQ("websocket", plain.headers.at("Upgrade"));
}

TEST_F(NetWs, RefusesAnotherVersion) {
  serve();
  std::string request = upgrade_request();
  request.replace(request.find("Version: 13"), 11, "Version: 12");
  EXPECT_EQ(426, ask(port(), request).status);
}

TEST_F(NetWs, EchoesTextAndFragments) {
  serve();
  expect_echo();
  WsTestClient client(port());
  std::string first = WsTestClient::encode(1, "hel");
  first[0] = 1;  // not final
  std::string last = WsTestClient::encode(0, "lo");
  client.socket.send(first + WsTestClient::encode(9, "p") + last);
  // The ping between the fragments is answered first.
  EXPECT_EQ(10, client.read().opcode);
  EXPECT_EQ("hello", client.read().payload);
}

TEST_F(NetWs, SendsHeaderAndSharedPayloadAsOneMessage) {
  serve();
  WsTestClient client(port());
  ASSERT_TRUE(eventually([&] { return opened() == 1; }));
  running_->on_io([&] {
    const std::array<std::byte, 3> header{std::byte{1}, std::byte{2}, std::byte{3}};
    const auto& to = recorder_.clients.begin()->second;
    to->send_latest(7, header, std::make_shared<const std::string>(100'000, 'x'));
    to->send_latest(8, header, nullptr);
    return 0;
  });
  const Frame large = client.read();
  EXPECT_EQ(2, large.opcode);
  EXPECT_EQ("\x01\x02\x03" + std::string(100'000, 'x'), large.payload);
  EXPECT_EQ("\x01\x02\x03", client.read().payload);
}

TEST_F(NetWs, ARiderIsSentOnceBeforeTheNextMessage) {
  serve();
  WsTestClient client(port());
  ASSERT_TRUE(eventually([&] { return opened() == 1; }));
  const WsCounters counters = running_->on_io([&] {
    const auto bytes = [](std::string_view text) {
      return std::as_bytes(std::span(text.data(), text.size()));
    };
    const auto& to = recorder_.clients.begin()->second;
    to->ride(bytes("first"));
    to->ride(bytes("rider"));  // takes its place
    to->send_latest(1, bytes("ab"), std::make_shared<const std::string>("cd"));
    to->send_latest(1, bytes("ef"), nullptr);
    to->ride(bytes("first"));
    to->ride({});  // taken back
    to->send_latest(1, bytes("gh"), nullptr);
    EXPECT_THROW(to->ride(bytes("seventeen letters")), std::invalid_argument);
    return to->counters();
  });
  for (const char* expected : {"rider", "abcd", "ef", "gh"}) {
    const Frame frame = client.read();
    EXPECT_EQ(2, frame.opcode);
    EXPECT_EQ(expected, frame.payload);
  }
  EXPECT_EQ(counters.sent_messages, 4U);
}

TEST_F(NetWs, TenMalformedFramesEndTheirConnectionOnly) {
  serve();
  WsTestClient healthy(port());
  std::string unmasked = "\x81\x02hi";
  std::string reserved_bit = WsTestClient::encode(1, "x");
  reserved_bit[0] = static_cast<char>(0xC1);
  std::string long_ping = WsTestClient::encode(9, std::string(126, 'p'));
  std::string split_ping = WsTestClient::encode(9, "p");
  split_ping[0] = 0x09;
  std::string huge("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01\x02\x03\x04", 14);
  std::string over_limit("\x82\xFF\x00\x00\x00\x00\x00\x10\x00\x01\x01\x02\x03\x04", 14);
  std::string fragment = WsTestClient::encode(1, "a");
  fragment[0] = 0x01;
  const std::vector<std::pair<std::string, int>> cases{
      {unmasked, 1002},
      {reserved_bit, 1002},
      {WsTestClient::encode(3, "reserved opcode"), 1002},
      {WsTestClient::encode(11, "reserved control opcode"), 1002},
      {long_ping, 1002},
      {split_ping, 1002},
      {WsTestClient::encode(0, "continues nothing"), 1002},
      {fragment + WsTestClient::encode(1, "new message inside another"), 1002},
      {WsTestClient::encode(1, "\xc3\x28"), 1007},
      {over_limit, 1009},
      {huge, 1009},
      {WsTestClient::encode(8, "\x03"), 1002}};  // half a close code
  for (std::size_t i = 0; i < cases.size(); ++i) {
    WsTestClient client(port());
    client.socket.send(cases[i].first);
    EXPECT_EQ(cases[i].second, client.close_code()) << "case " << i;
    EXPECT_TRUE(client.socket.ends_within(3s)) << "case " << i;
  }
  healthy.send_text("still here");
  EXPECT_EQ("still here", healthy.read().payload);
  EXPECT_TRUE(eventually([&] { return closed() == static_cast<int>(cases.size()); }));
}

TEST_F(NetWs, ACutFrameOnlyClosesTheConnection) {
  serve();
  {
    const WsTestClient client(port());
    client.socket.send(WsTestClient::encode(1, "hello").substr(0, 4));
  }
  EXPECT_TRUE(eventually([&] { return closed() == 1; }));
  expect_echo();
}

TEST_F(NetWs, AnExceptionInACallbackClosesThatClient) {
  serve();
  WsTestClient client(port());
  client.send_text("throw");
  EXPECT_EQ(1011, client.close_code());
  expect_echo();
}

TEST_F(NetWs, TheServerCanClose) {
  serve();
  WsTestClient client(port());
  client.send_text("close");
  EXPECT_EQ(1008, client.close_code());
  EXPECT_TRUE(eventually([&] { return closed() == 1; }));
}

TEST_F(NetWs, AClosingClientThatNeverAnswersIsCutOff) {
  ServerOptions options;
  options.timeouts.closing = 100ms;
  serve(options);
  WsTestClient client(port());
  client.send_text("close");
  EXPECT_EQ(1008, client.close_code());
  EXPECT_TRUE(client.socket.ends_within(2s));
}

TEST_F(NetWs, PingsAQuietClientAndDropsASilentOne) {
  ServerOptions options;
  options.timeouts.ws_silence = 400ms;
  serve(options);
  WsTestClient answering(port());
  WsTestClient silent(port());
  const auto until = steady_clock::now() + 1200ms;
  int pings = 0;
  while (steady_clock::now() < until) {
    const Frame frame = answering.read(100ms);
    if (frame.opcode == 9) {
      ++pings;
      answering.send(10, frame.payload);
    }
  }
  EXPECT_GE(pings, 2);
  EXPECT_TRUE(silent.socket.ends_within(1s));
  answering.send_text("alive");
  Frame frame = answering.read();
  while (frame.opcode == 9) frame = answering.read();
  EXPECT_EQ("alive", frame.payload);
}

TEST_F(NetWs, StoppingSendsCloseAndCallsOnCloseOnce) {
  serve();
  WsTestClient first(port());
  const WsTestClient deaf(port());  // never answers the closing handshake
  ASSERT_TRUE(eventually([&] { return opened() == 2; }));
  std::vector<std::shared_ptr<WsClient>> kept;
  running_->on_io([&] {
    for (const auto& [id, client] : recorder_.clients) kept.push_back(client);
    return 0;
  });
  running_->server.stop();
  EXPECT_EQ(1001, first.close_code());
  running_->stop();
  EXPECT_EQ(2, recorder_.closed);
  running_.reset();
  // Handles that outlive the server do nothing.
  for (const auto& client : kept) {
    EXPECT_FALSE(client->open());
    client->send_control(FrameKind::Text, std::make_shared<const std::string>("late"));
    client->close(1000, "late");
  }
}

/// A frame of `size` bytes whose first eight are `number`.
Payload numbered(std::uint64_t number, std::size_t size) {
  std::string bytes(size, 'f');
  std::memcpy(bytes.data(), &number, sizeof number);
  return std::make_shared<const std::string>(std::move(bytes));
}

std::uint64_t number_of(const Frame& frame) {
  std::uint64_t number = 0;
  if (frame.payload.size() >= sizeof number) {
    std::memcpy(&number, frame.payload.data(), sizeof number);
  }
  return number;
}

TEST_F(NetWs, ASlowClientDelaysNoOtherGrowsNoMemoryAndResumesAtTheNewest) {
  serve();
  constexpr std::uint64_t kFrames = 4000;
  constexpr std::size_t kSize = 4096;
  WsTestClient slow(port(), "foxglove.websocket.v1", 4096);
  ASSERT_TRUE(eventually([&] { return opened() == 1; }));
  WsTestClient healthy(port());
  ASSERT_TRUE(eventually([&] { return opened() == 2; }));

  for (std::uint64_t n = 1; n <= kFrames; ++n) {
    running_->on_io([&] {
      const Payload frame = numbered(n, kSize);
      for (const auto& [id, client] : recorder_.clients) client->send_latest(1, {}, frame);
      return 0;
    });
    // Paced by the healthy client, which misses nothing despite the slow one.
    ASSERT_EQ(n, number_of(healthy.read()));
  }
  const WsCounters counters =
      running_->on_io([&] { return recorder_.clients.begin()->second->counters(); });
  EXPECT_EQ(1u, counters.buffered_messages);
  EXPECT_EQ(kSize, counters.buffered_bytes);
  // 16 MB were published; the kernel buffered far less.
  EXPECT_LT(counters.sent_bytes, 1'000'000u);
  EXPECT_GT(counters.dropped_messages, 3000u);

  std::uint64_t last = 0;
  std::uint64_t frames = 0;
  while (last < kFrames) {
    const Frame frame = slow.read();
    ASSERT_EQ(2, frame.opcode);
    EXPECT_LT(last, number_of(frame));
    last = number_of(frame);
    ++frames;
  }
  EXPECT_EQ(counters.sent_messages + 2, frames);  // one was being written, one was waiting
}

TEST_F(NetWs, PongsNeverSplitAPartlySentMessage) {
  serve();
  WsTestClient slow(port(), "foxglove.websocket.v1", 4096);
  ASSERT_TRUE(eventually([&] { return opened() == 1; }));
  constexpr int kRounds = 30;  // 3 MB, below the queue's limit
  int pongs = 0;
  int messages = 0;
  const auto take = [&] {
    const Frame frame = slow.read();
    if (frame.opcode == 10) {
      EXPECT_EQ("are you there", frame.payload);
      ++pongs;
    } else {
      ASSERT_EQ(1, frame.opcode);
      const char letter = static_cast<char>('a' + messages % 26);
      EXPECT_EQ(std::string(2000 + 7001 * static_cast<std::size_t>(messages), letter),
                frame.payload);
      ++messages;
    }
  };
  for (int round = 0; round < kRounds; ++round) {
    running_->on_io([&] {
      const std::size_t size = 2000 + 7001 * static_cast<std::size_t>(round);
      recorder_.clients.begin()->second->send_control(
          FrameKind::Text,
          std::make_shared<const std::string>(size, static_cast<char>('a' + round % 26)));
      return 0;
    });
    slow.send(9, "are you there");
    if (round % 4 == 3 && !HasFatalFailure())
      take();  // falls behind, so that the kernel's buffer stays full
  }
  while (messages < kRounds && !HasFatalFailure()) take();
  // Beast answers only the newest waiting ping, as RFC 6455 (5.5.3) allows.
  EXPECT_GT(pongs, 0);
}

TEST_F(NetWs, AClientThatIgnoresItsControlMessagesIsDisconnected) {
  ServerOptions options;
  options.limits.control_messages = 16;
  options.timeouts.closing = 200ms;
  serve(options);
  WsTestClient slow(port(), "foxglove.websocket.v1", 4096);
  ASSERT_TRUE(eventually([&] { return opened() == 1; }));
  running_->on_io([&] {
    const auto client = recorder_.clients.begin()->second;
    for (int i = 0; i < 200 && client->open(); ++i) {
      client->send_control(FrameKind::Text, std::make_shared<const std::string>(50'000, 'c'));
    }
    return 0;
  });
  EXPECT_TRUE(eventually([&] { return closed() == 1; }));
  expect_echo();
}

TEST_F(NetWs, LargeMessagesUpToTheLimitArrive) {
  serve();
  WsTestClient client(port());
  const std::string large((1 << 20) - 1, 'x');
  client.send_text(large);
  EXPECT_EQ(large, client.read().payload);
}

}  // namespace
}  // namespace server::net::test
