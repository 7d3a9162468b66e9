// tests/bench/ws_readers.hpp: many WebSocket clients on one thread, and the age of each frame.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/serve/net_client.hpp"

namespace bench {

/// Clients subscribed to the telemetry channel. From start() to stop() a thread reads all of them
/// and records each frame's age at arrival; a frame's time is of the steady clock.
class WsReaders {
 public:
  /// `expected`: the number of ages to reserve, so that reading allocates nothing.
  WsReaders(std::uint16_t port, std::size_t clients, std::size_t expected);
  ~WsReaders() { stop(); }
  WsReaders(const WsReaders&) = delete;
  WsReaders& operator=(const WsReaders&) = delete;

  void stop();
  std::uint64_t received() const { return received_.load(); }
  /// [s] CPU time of the reading thread so far.
  double cpu() const { return cpu_.load(); }
  /// [s] ages of all frames; after stop(). Incomplete and out-of-order frames are counted.
  std::vector<double>& ages() { return ages_; }
  std::uint64_t wrong() const { return wrong_; }

 private:
  struct Reader {
    explicit Reader(std::uint16_t port) : client(port) {}
    server::net::test::WsTestClient client;
    std::string input{};
    std::uint64_t last = 0;  // [ns] stamp of the newest frame
  };
  void work();
  void read(Reader& reader);
  void take_frames(Reader& reader);

  std::vector<std::unique_ptr<Reader>> readers_{};
  std::vector<double> ages_{};
  std::size_t aged_ = 0;
  std::uint64_t wrong_ = 0;
  std::atomic<std::uint64_t> received_{0};
  std::atomic<double> cpu_{0};
  std::atomic<bool> stopping_{false};
  std::thread thread_{};
};

}  // namespace bench
