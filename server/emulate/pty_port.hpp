// server/emulate/pty_port.hpp: the device's end of a pseudo-terminal, which a program opens like a
// serial port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "drivers/bytes.hpp"

namespace server::emulate {

/// A symbolic link leads to the host's end as long as this lives and is plugged in. Not for two
/// threads at once.
class PtyPort {
 public:
  /// Throws std::runtime_error with a sentence when there is no terminal or something other than a
  /// link is at `link`.
  explicit PtyPort(std::filesystem::path link);
  ~PtyPort();
  PtyPort(const PtyPort&) = delete;
  PtyPort& operator=(const PtyPort&) = delete;

  void plug();
  void unplug();
  /// -1 while unplugged.
  int descriptor() const { return fd_; }

  /// Somebody has the host's end open. What is written while nobody has is lost, as on a cable.
  bool listened_to() const;
  /// [bit/s] the host's end is set to.
  unsigned host_baud() const;
  /// What has come; 0 when nothing has.
  std::size_t read(std::span<std::uint8_t> into) const;
  /// The bytes taken: fewer when the host does not read.
  std::size_t write(drivers::ByteView bytes) const;

 private:
  void remove_link() const;

  std::filesystem::path link_;
  std::filesystem::path slave_{};
  int fd_ = -1;
};

}  // namespace server::emulate
