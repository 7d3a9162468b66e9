// drivers/serial_port.hpp: a device's byte stream, on a serial port or behind a network box.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/bytes.hpp"

namespace drivers {

/// The line cannot be opened or is lost; what() is a sentence with advice where possible.
struct LineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Why `path` could not be opened, from errno.
std::string open_error_text(const std::string& path, int error);

/// An open line: 8 data bits, no parity, 1 stop bit, no translation. One thread at a time. No other
/// program can open the port through this class meanwhile.
class SerialPort {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// Opens `path`, a device at any rate [bit/s], or "tcp:HOST:PORT", a network box that sets the
  /// rate itself. Throws LineError.
  SerialPort(const std::string& path, unsigned baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// [bit/s] The port's actual rate, which may differ from the rate set; 0 for TCP.
  unsigned baud() const { return baud_; }
  /// Sets the rate once all bytes are sent. Does nothing for TCP.
  void set_baud(unsigned baud);

  /// Waits for bytes and returns the number read, 0 after `timeout`. Throws LineError when the
  /// device has gone.
  std::size_t read(std::span<std::uint8_t> into, Milliseconds timeout);
  /// Writes all bytes. Throws LineError when the device has gone or accepts none for `timeout`.
  void write(ByteView bytes, Milliseconds timeout);
  /// For poll(): readable when there are bytes or the device has gone.
  int descriptor() const { return fd_; }
  /// Discards the bytes not yet read.
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
