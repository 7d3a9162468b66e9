// drivers/serial_port.hpp: the bytes of a device, on a serial port or behind a network box.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/bytes.hpp"

namespace drivers {

/// The line cannot be opened or is lost; what() is a sentence to act on.
struct LineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Why `path` could not be opened, from the errno of the attempt.
std::string open_error_text(const std::string& path, int error);

/// An open line: 8 data bits, no parity, 1 stop bit, nothing translated. One thread at a time; no
/// other program can open the port through this class meanwhile.
class SerialPort {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// Opens `path`, a device at any rate [bit/s], or "tcp:HOST:PORT", whose box knows its own rate.
  /// Throws LineError.
  SerialPort(const std::string& path, unsigned baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// [bit/s] What the port says it does, which may differ from what it was told; 0 for TCP.
  unsigned baud() const { return baud_; }
  /// Once all has been sent. Does nothing for TCP.
  void set_baud(unsigned baud);

  /// Waits until there is something to read; the bytes read, 0 after `timeout`. Throws LineError
  /// when the device has gone.
  std::size_t read(std::span<std::uint8_t> into, Milliseconds timeout);
  /// Writes all. Throws LineError when the device has gone or takes nothing for `timeout`.
  void write(ByteView bytes, Milliseconds timeout);
  /// For poll(): there is something to read, or the device has gone.
  int descriptor() const { return fd_; }
  /// Forgets what has come and was not read.
  void discard_input();

 private:
  void open_device(unsigned baud);
  void open_tcp(const std::string& host, const std::string& port);
  void close();
  [[noreturn]] void fail(const std::string& sentence) const;

  std::string path_;
  int fd_ = -1;
  bool tcp_ = false;
  unsigned baud_ = 0;
};

}  // namespace drivers
