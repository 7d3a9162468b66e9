// drivers/serial_port.cpp: Linux serial ports at any rate, or TCP in their place.
#include "drivers/serial_port.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include <asm/termbits.h>  // termios2, for rates termios has no constant for; excludes <termios.h>
#include <fcntl.h>
#include <grp.h>
#include <linux/serial.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace drivers {
namespace {

using Milliseconds = SerialPort::Milliseconds;

constexpr std::string_view kTcp = "tcp:";
constexpr Milliseconds kConnectTimeout{3000};

std::string system_text(int error) {
  return std::system_category().message(error);
}

/// The group of `path`; empty when it cannot be found out.
std::string group_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return "";
  std::array<char, 1024> buffer{};
  group entry{};
  group* found = nullptr;
  ::getgrgid_r(status.st_gid, &entry, buffer.data(), buffer.size(), &found);
  return found ? found->gr_name : "";
}

/// True when `events` came before `timeout`; a signal counts as a timeout.
bool wait_for(int fd, short events, Milliseconds timeout) {
  pollfd waiting{.fd = fd, .events = events, .revents = 0};
  return ::poll(&waiting, 1, static_cast<int>(timeout.count())) > 0;
}

/// By default some USB chips deliver bytes only every 16 ms. A failure is ignored: pseudo-terminals
/// and other chips refuse the request, and nothing depends on it.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (::ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  constexpr int kLowLatency = 1 << 13;  // ASYNC_LOW_LATENCY, whose macro is unsigned
  settings.flags |= kLowLatency;
  ::ioctl(fd, TIOCSSERIAL, &settings);
}

}  // namespace

std::string open_error_text(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
      return "There is no " + path + ": is the device plugged in?";
    case EACCES: {
      const std::string group = group_of(path);
      if (group.empty()) return "This user may not open " + path + ".";
      return "This user may not open " + path + ", which belongs to the group " + group +
             ": `sudo adduser $USER " + group + "`, then log in again.";
    }
    case EBUSY:
    case EWOULDBLOCK:
      return path + " is in use by another program.";
    case ENOTTY:
    case EISDIR:
      return path + " is no serial port.";
    case ENXIO:
    case ENODEV:
    case EIO:
      return "There is no device behind " + path + ".";
    default:
      return path + " cannot be opened: " + system_text(error) + ".";
  }
}

SerialPort::SerialPort(const std::string& path, unsigned baud) : path_(path) {
  try {
    if (!path.starts_with(kTcp)) {
      open_device(baud);
      return;
    }
    const std::string address = path.substr(kTcp.size());
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == address.size()) {
      fail(path + " is not of the form tcp:HOST:PORT.");
    }
    std::string host = address.substr(0, colon);
    if (host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    open_tcp(host, address.substr(colon + 1));
  } catch (...) {
    close();
    throw;
  }
}

SerialPort::~SerialPort() {
  close();
}

void SerialPort::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

void SerialPort::fail(const std::string& sentence) const {
  throw LineError(sentence);
}

void SerialPort::open_device(unsigned baud) {
  // Do not wait for a carrier signal: three-wire cables have none.
  fd_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) fail(open_error_text(path_, errno));
  if (::isatty(fd_) == 0) fail(open_error_text(path_, ENOTTY));
  // The lock keeps out programs that lock too, even root's; exclusive mode keeps out all but root.
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) fail(open_error_text(path_, errno));
  ::ioctl(fd_, TIOCEXCL);
  set_baud(baud);
  ask_for_low_latency(fd_);
  discard_input();
}

void SerialPort::open_tcp(const std::string& host, const std::string& port) {
  tcp_ = true;
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int unresolved = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &list);
  if (unresolved != 0) fail("No address for " + path_ + ": " + ::gai_strerror(unresolved) + ".");
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(list, &::freeaddrinfo);

  int error = ENOENT;
  for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
    close();
    fd_ = ::socket(entry->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd_ < 0) continue;
    error = ::connect(fd_, entry->ai_addr, entry->ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
      socklen_t size = sizeof(error);
      error = ETIMEDOUT;
      if (wait_for(fd_, POLLOUT, kConnectTimeout)) {
        ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
      }
    }
    if (error == 0) {
      // Requests and wheel commands are short and must not wait to be merged.
      constexpr int kOn = 1;
      ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
      return;
    }
  }
  fail("Nothing answers at " + path_ + ": " + system_text(error) + ".");
}

void SerialPort::set_baud(unsigned baud) {
  if (tcp_) return;
  termios2 settings{};
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  if (::ioctl(fd_, TCSETSW2, &settings) != 0 || ::ioctl(fd_, TCGETS2, &settings) != 0) {
    fail(path_ + " cannot be set to " + std::to_string(baud) + " bit/s: " + system_text(errno) +
         ".");
  }
  baud_ = settings.c_ospeed;
}

std::size_t SerialPort::read(std::span<std::uint8_t> into, Milliseconds timeout) {
  if (into.empty() || !wait_for(fd_, POLLIN, timeout)) return 0;
  const ssize_t got = ::read(fd_, into.data(), into.size());
  if (got > 0) return static_cast<std::size_t>(got);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  fail("The device at " + path_ + " has gone.");
}

void SerialPort::write(ByteView bytes, Milliseconds timeout) {
  while (!bytes.empty()) {
    if (!wait_for(fd_, POLLOUT, timeout)) fail(path_ + " takes no more bytes.");
    const ssize_t sent = tcp_ ? ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                              : ::write(fd_, bytes.data(), bytes.size());
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (errno != EAGAIN && errno != EINTR) {
      fail("The device at " + path_ + " has gone.");
    }
  }
}

void SerialPort::discard_input() {
  if (!tcp_) {
    ::ioctl(fd_, TCFLSH, TCIFLUSH);
    return;
  }
  // A bound above any box's buffer: a device that never stops sending must not block this loop.
  std::array<std::uint8_t, 4096> dropped{};
  for (int i = 0; i < 16 && wait_for(fd_, POLLIN, Milliseconds(0)); ++i) {
    if (::recv(fd_, dropped.data(), dropped.size(), MSG_DONTWAIT) <= 0) return;
  }
}

}  // namespace drivers
