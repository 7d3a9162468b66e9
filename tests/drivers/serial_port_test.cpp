// tests/drivers/serial_port_test.cpp: a line on a pseudo-terminal and on a loopback socket.
#include "drivers/serial_port.hpp"

#include <array>
#include <cerrno>
#include <filesystem>
#include <string>

#include "tests/drivers/hex.hpp"
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pty.h>
#include <sys/socket.h>
#include <unistd.h>

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr SerialPort::Milliseconds kLong{5000};  // when bytes will come
constexpr SerialPort::Milliseconds kShort{10};   // when none will come

/// The device's end of a pseudo-terminal.
class Device {
 public:
  Device() {
    int host = -1;
    std::array<char, 128> name{};
    EXPECT_EQ(::openpty(&fd_, &host, name.data(), nullptr, nullptr), 0);
    path_ = name.data();
    ::close(host);
  }
  ~Device() { unplug(); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const std::string& path() const { return path_; }
  void unplug() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  void send(const Bytes& bytes) const {
    EXPECT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  Bytes receive(std::size_t size) const {
    Bytes bytes(size);
    std::size_t got = 0;
    while (got < size) {
      const ssize_t more = ::read(fd_, bytes.data() + got, size - got);
      if (more <= 0) break;
      got += static_cast<std::size_t>(more);
    }
    bytes.resize(got);
    return bytes;
  }

 private:
  int fd_ = -1;
  std::string path_{};
};

Bytes read_all(SerialPort& port, std::size_t size) {
  Bytes bytes(size);
  std::size_t got = 0;
  while (got < size) {
    const std::size_t more = port.read(std::span(bytes).subspan(got), kLong);
    if (more == 0) break;
    got += more;
  }
  bytes.resize(got);
  return bytes;
}

Bytes every_byte() {
  Bytes bytes(256);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

std::string error_of(const std::string& path) {
  try {
    const SerialPort port(path, 9600);
  } catch (const LineError& error) {
    return error.what();
  }
  return "";
}

TEST(SerialPort, CarriesEveryByteBothWays) {
  const Device device;
  SerialPort port(device.path(), 38400);
  device.send(every_byte());
  EXPECT_EQ(read_all(port, 256), every_byte());
  port.write(every_byte(), kLong);
  EXPECT_EQ(device.receive(256), every_byte());
}

TEST(SerialPort, SetsAnyRateAndReportsTheActualOne) {
  const Device device;
  SerialPort port(device.path(), 500000);
  EXPECT_EQ(port.baud(), 500000U);
  for (const unsigned baud : {9600U, 19200U, 38400U, 115200U, 250000U}) {
    port.set_baud(baud);
    EXPECT_EQ(port.baud(), baud);
  }
}

TEST(SerialPort, SilenceReturnsNoBytes) {
  const Device device;
  SerialPort port(device.path(), 9600);
  Bytes into(16);
  EXPECT_EQ(port.read(into, kShort), 0U);
}

TEST(SerialPort, DiscardsUnreadBytes) {
  const Device device;
  SerialPort port(device.path(), 9600);
  device.send(hex("01 02"));
  Bytes first(1);
  ASSERT_EQ(port.read(first, kLong), 1U);  // so both have arrived
  port.discard_input();
  EXPECT_EQ(port.read(first, kShort), 0U);
}

TEST(SerialPort, UnpluggedDeviceIsReported) {
  Device device;
  SerialPort port(device.path(), 9600);
  device.unplug();
  Bytes into(16);
  EXPECT_THROW(port.read(into, kLong), LineError);
  EXPECT_THROW(port.write(every_byte(), kLong), LineError);
}

TEST(SerialPort, SecondOpenerIsRefused) {
  const Device device;
  {
    const SerialPort port(device.path(), 9600);
    EXPECT_THAT(error_of(device.path()), HasSubstr("in use by another program"));
  }
  EXPECT_EQ(error_of(device.path()), "");
}

TEST(SerialPort, ReportsWhyItDoesNotOpen) {
  EXPECT_THAT(error_of("/dev/no_such_port"), HasSubstr("plugged in"));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("no serial port"));
  EXPECT_THAT(error_of("/tmp"), HasSubstr("no serial port"));
  EXPECT_THAT(error_of("tcp:localhost"), HasSubstr("tcp:HOST:PORT"));
  // Tests may run as root, which may open everything.
  EXPECT_THAT(open_error_text("/dev/null", EACCES),
              AllOf(HasSubstr("belongs to the group"), HasSubstr("adduser")));
}

TEST(SerialPort, TcpInPlaceOfAPort) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string path = "tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  EXPECT_THAT(error_of(path), HasSubstr("Nothing answers"));  // does not listen yet

  ASSERT_EQ(::listen(listener, 1), 0);
  SerialPort port(path, 9600);
  const int box = ::accept(listener, nullptr, nullptr);
  ASSERT_GE(box, 0);
  EXPECT_EQ(port.baud(), 0U);
  int at_once = 0;
  socklen_t option = sizeof(at_once);
  ASSERT_EQ(::getsockopt(port.descriptor(), IPPROTO_TCP, TCP_NODELAY, &at_once, &option), 0);
  EXPECT_NE(at_once, 0);
  ASSERT_EQ(::send(box, "\x02\x80", 2, 0), 2);
  EXPECT_EQ(read_all(port, 2), hex("02 80"));
  port.write(every_byte(), kLong);
  Bytes got(256);
  EXPECT_EQ(::recv(box, got.data(), got.size(), MSG_WAITALL), 256);
  EXPECT_EQ(got, every_byte());
  ::close(box);
  Bytes into(1);
  EXPECT_THROW(port.read(into, kLong), LineError);
  ::close(listener);
}

}  // namespace
}  // namespace drivers
