// tests/drivers/emulators/talk.hpp: sends bytes to an emulated device and keeps the answers.
#pragma once

#include <algorithm>
#include <string>

#include "tests/drivers/hex.hpp"

#include "drivers/emulators/device.hpp"

namespace drivers::emulators {

/// The host of `device`, with a clock of its own that steps a millisecond at a time.
class Host {
 public:
  explicit Host(Device& device) : device_(device) { device_.advance(now_); }

  double now() const { return now_; }
  /// All bytes that arrive within `seconds`.
  Bytes listen(double seconds) {
    Bytes got;
    const double end = now_ + seconds;
    while (now_ < end) {
      now_ = std::min(end, now_ + 0.001);
      device_.advance(now_);
      for (std::size_t before = got.size() + 1; before != got.size();) {
        before = got.size();
        device_.send(now_, got);
      }
    }
    return got;
  }
  void tell(ByteView bytes) { device_.receive(bytes, now_); }
  Bytes ask(ByteView bytes, double seconds = 1.0) {
    tell(bytes);
    return listen(seconds);
  }
  Bytes ask(const std::string& text, double seconds = 1.0) {
    return ask(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), seconds);
  }

 private:
  Device& device_;
  double now_ = 100;
};

inline std::string text(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace drivers::emulators
