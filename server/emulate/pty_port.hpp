// server/emulate/pty_port.hpp: the device's end of a pseudo-terminal; programs open the other end
// like a serial port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "drivers/bytes.hpp"

namespace server::emulate {

/// A symbolic link leads to the host's end as long as this object exists and is plugged in. Not
/// thread-safe.
class PtyPort {
 public:
  /// Throws std::runtime_error with a sentence when no terminal is available, or `link` exists and
  /// is not the link of an emulator that was killed.
  explicit PtyPort(std::filesystem::path link);
  ~PtyPort();
  PtyPort(const PtyPort&) = delete;
  PtyPort& operator=(const PtyPort&) = delete;

  void plug();
  void unplug();
  /// -1 while unplugged.
  int descriptor() const { return fd_; }

  /// Whether a program has the host's end open. Bytes written otherwise are lost, as on a cable.
  bool listened_to() const;
  /// [bit/s] The rate that the host has set.
  unsigned host_baud() const;
  /// Reads the bytes received; returns their number, 0 without any.
  std::size_t read(std::span<std::uint8_t> into) const;
  /// Returns the number of bytes written: fewer when the host does not read.
  std::size_t write(drivers::ByteView bytes) const;

 private:
  void remove_link() const;

  std::filesystem::path link_;
  std::filesystem::path slave_{};
  int fd_ = -1;
};

}  // namespace server::emulate
