// tests/bench/bare_sockets.hpp: the least cost of a stream to many clients: send() in a loop.
#pragma once

#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace bench {

/// Pairs of connected loopback TCP sockets; a thread reads and discards.
class BareSockets {
 public:
  BareSockets(std::size_t clients, std::size_t bytes);
  ~BareSockets();
  BareSockets(const BareSockets&) = delete;
  BareSockets& operator=(const BareSockets&) = delete;

  /// Sends the same bytes to all at `rate` [Hz]. @return [s] CPU time a message
  double send_for(double seconds, double rate);

 private:
  void read_all(int poll) const;

  std::string bytes_;
  std::vector<int> senders_{};
  std::vector<int> receivers_{};
  int wake_ = -1;  // closes the reader's loop
  std::thread reader_{};
};

}  // namespace bench
