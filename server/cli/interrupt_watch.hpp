// server/cli/interrupt_watch.hpp: an end signal becomes a stop request.
#pragma once

#include <chrono>
#include <stop_token>
#include <thread>

#include "server/cli/signals.hpp"

namespace server {

/// Turns Ctrl-C and other end signals into a stop request, so that files are closed in order.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::stop_source& source)
      : thread_([&source](const std::stop_token& done) {
          while (!done.stop_requested() && !end_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
          if (end_requested()) source.request_stop();
        }) {
    heed_signals();
  }

 private:
  std::jthread thread_;
};

}  // namespace server
