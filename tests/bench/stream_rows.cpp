// tests/bench/stream_rows.cpp: one stream to many clients: cost, latency, and clients that do not
// read.
#include <atomic>
#include <chrono>
#include <cstring>
#include <fstream>

#include "tests/bench/bare_sockets.hpp"
#include "tests/bench/rows.hpp"
#include "tests/bench/ws_readers.hpp"
#include <fmt/core.h>
#include <sys/resource.h>

#include "server/serve/foxglove/hub.hpp"

namespace bench {
namespace {

using server::net::test::RunningServer;
using server::net::test::WsTestClient;
using namespace std::chrono_literals;

constexpr std::size_t kPayload = 1000;                 // [bytes] of a frame
constexpr std::size_t kOnTheWire = kPayload + 13 + 4;  // with Foxglove's and WebSocket's headers
constexpr double kRate = 40;                           // [Hz]

std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() / 1ns);
}

/// Our server and hub, publishing a frame of 1,000 bytes at 40 Hz while it is on. The frame's time
/// is of the steady clock; its first bytes are a counter.
class Stream {
 public:
  Stream() : running_(options()) {
    channel_ = hub_.add_channel({"/telemetry", "tautline.wire.Frame"});
    running_.server.add(hub_.endpoint("/ws"));
    running_.server.every(25ms, [this] {
      if (on_) publish();
    });
    running_.start();
  }
  std::uint16_t port() const { return running_.port(); }
  void turn(bool on) {
    running_.on_io([&] {
      on_ = on;
      return 0;
    });
  }
  /// [s] CPU time of the io thread.
  double cpu() {
    return running_.on_io([] { return thread_cpu(); });
  }
  void wait_for(std::size_t clients) {
    require(server::net::test::eventually(
                [&] { return running_.on_io([&] { return hub_.clients(); }) >= clients; }, 60s),
            "The clients did not all arrive.");
    std::this_thread::sleep_for(200ms);  // until they have subscribed
  }
  std::uint64_t published() {
    return running_.on_io([&] { return published_; });
  }
  std::uint64_t newest_stamp() {
    return running_.on_io([&] { return stamp_; });
  }

 private:
  static server::net::ServerOptions options() {
    server::net::ServerOptions options;
    options.timeouts.ws_silence = 10min;  // our readers do not answer pings
    options.limits.connections_per_address = options.limits.connections;  // all come from here
    return options;
  }
  void publish() {
    std::string frame(kPayload, 'x');
    std::memcpy(frame.data(), &++published_, sizeof published_);
    stamp_ = now_ns();
    hub_.publish(channel_, stamp_, std::make_shared<const std::string>(std::move(frame)));
  }

  server::foxglove::Hub hub_{};
  server::foxglove::ChannelId channel_ = 0;
  bool on_ = false;  // io thread only, like the two below
  std::uint64_t published_ = 0;
  std::uint64_t stamp_ = 0;
  RunningServer running_;
};

void sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Room for two sockets a client, twice.
bool allow_files(std::size_t count) {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur >= count) return true;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, count);
  return setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur >= count;
}

/// P14: ours and the reference alternate, so that the machine's noise affects both.
void fan_out(Pass& pass) {
  const auto clients = pass.count<std::size_t>(1000, 20);
  require(allow_files(4 * clients + 200), "P14 needs more open files: raise `ulimit -n`.");
  const int turns = pass.count(5, 1);
  const double seconds = pass.count(2.0, 0.3);
  Stream stream;
  WsReaders readers(stream.port(), clients, 0);
  stream.wait_for(clients);
  BareSockets bare(clients, kOnTheWire);
  std::vector<double> ratios;
  std::vector<double> ours;
  std::vector<double> theirs;
  double share = 0;
  for (int turn = 0; turn < turns; ++turn) {
    const std::uint64_t before = readers.received();
    const std::uint64_t published = stream.published();
    const double cpu = stream.cpu();
    stream.turn(true);
    sleep(seconds);
    stream.turn(false);
    sleep(0.2);
    const auto messages = static_cast<double>(readers.received() - before);
    require(messages > 0, "P14: nothing arrived");
    ours.push_back((stream.cpu() - cpu) / messages);
    share += messages / static_cast<double>((stream.published() - published) * clients) / turns;
    theirs.push_back(bare.send_for(seconds, kRate));
    ratios.push_back(ours.back() / theirs.back());
  }
  readers.stop();
  require(readers.wrong() == 0, "P14: frames arrived out of order");
  pass.add({.row = "P14",
            .name = "fan-out to 1000 over bare send()",
            .value = median(ratios),
            .unit = "x",
            .better = Better::Lower,
            .floor = 1.3,
            .stretch = 0.75,
            .noise = spread(ratios),
            .note = fmt::format("{} over {} a message, {:.1f} % of the frames delivered",
                                duration(median(ours)),
                                duration(median(theirs)),
                                100 * share)});
}

/// Ages [s] of frames read by `clients` for `seconds`.
std::vector<double> ages(Stream& stream, std::size_t clients, double seconds) {
  WsReaders readers(
      stream.port(),
      clients,
      static_cast<std::size_t>(static_cast<double>(clients) * 1.2 * kRate * seconds) + 100);
  stream.wait_for(clients);
  stream.turn(true);
  sleep(seconds);
  stream.turn(false);
  sleep(0.2);
  readers.stop();
  require(readers.wrong() == 0 && !readers.ages().empty(),
          "Frames arrived out of order, or none did.");
  return std::move(readers.ages());
}

/// P17
void latency(Pass& pass) {
  struct Case {
    std::size_t clients = 0;
    double floor = 0;
    double stretch = 0;
  };
  for (const Case& about : {Case{1, 1, 0.3}, Case{100, 10, 2}}) {
    Stream stream;
    std::vector<double> seen = ages(stream, about.clients, pass.count(20.0, 0.3));
    const double middle = median(seen);
    pass.add({.row = "P17",
              .name = fmt::format("publish to read, {} client(s), p99", about.clients),
              .value = 1e3 * quantile(seen, 0.99),
              .unit = "ms",
              .better = Better::Lower,
              .floor = about.floor,
              .stretch = about.stretch,
              .note = fmt::format("p50 {:.3f} ms; one thread reads all clients", 1e3 * middle)});
  }
}

/// [MB] of memory the program has in use.
double resident() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages >> pages;
  return static_cast<double>(pages) * 4096e-6;
}

/// Reads the frames that wait for a client that slept. @return [ns] time of the last frame
std::uint64_t last_stamp(WsTestClient& client) {
  std::uint64_t stamp = 0;
  for (;;) {
    const server::net::test::Frame frame = client.read(500ms);
    if (frame.opcode < 0) return stamp;
    if (frame.opcode == 2 && frame.payload.size() > 13 && frame.payload[0] == 1) {
      std::memcpy(&stamp, frame.payload.data() + 5, sizeof stamp);
    }
  }
}

/// P16: 100 clients, `slow` of which subscribe and then never read.
void slow_clients(Pass& pass, std::size_t slow, double seconds, double healthy_p99, Figure figure) {
  Stream stream;
  std::vector<std::unique_ptr<WsTestClient>> sleepers;
  for (std::size_t i = 0; i < slow; ++i) {
    sleepers.push_back(std::make_unique<WsTestClient>(stream.port()));
    sleepers.back()->send_text(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]})");
  }
  stream.wait_for(slow);
  const std::size_t healthy = 100 - slow;
  WsReaders readers(
      stream.port(),
      healthy,
      static_cast<std::size_t>(static_cast<double>(healthy) * 1.2 * kRate * seconds) + 100);
  stream.wait_for(100);
  stream.turn(true);
  sleep(seconds / 20);  // buffers have grown
  const double before = resident();
  sleep(seconds * 19 / 20);
  const double growth = resident() - before;
  stream.turn(false);
  sleep(0.1);
  readers.stop();
  require(readers.wrong() == 0, "P16: frames arrived out of order");
  for (const auto& sleeper : sleepers) {
    require(last_stamp(*sleeper) == stream.newest_stamp(),
            "P16: a slow client missed the newest frame");
  }
  const double p99 = quantile(readers.ages(), 0.99);
  figure.row = "P16";
  figure.value = p99 / healthy_p99;
  figure.unit = "x";
  figure.better = Better::Lower;
  figure.note = fmt::format("p99 {} over {}; a slow one gets the newest frame when it resumes",
                            duration(p99),
                            duration(healthy_p99));
  const std::string name = figure.name;
  pass.add(std::move(figure));
  pass.add({.row = "P16",
            .name = name + ", memory growth",
            .value = growth,
            .unit = "MB",
            .better = Better::Lower,
            .floor = 1});
}

}  // namespace

void streaming(Pass& pass) {
  fan_out(pass);
  latency(pass);
  const double seconds = pass.count(60.0, 0.5);
  double healthy_p99 = 0;
  {
    Stream stream;
    std::vector<double> seen = ages(stream, 100, seconds);
    healthy_p99 = quantile(seen, 0.99);
  }
  slow_clients(
      pass, 1, seconds, healthy_p99, {.name = "healthy p99 beside 1 slow of 100", .floor = 1.5});
  slow_clients(pass,
               pass.count<std::size_t>(20, 3),
               seconds,
               healthy_p99,
               {.name = "healthy p99 beside 20 slow of 100", .stretch = 1.5});
}

}  // namespace bench
