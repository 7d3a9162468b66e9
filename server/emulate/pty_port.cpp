// server/emulate/pty_port.cpp: makes, links and polls a pseudo-terminal.
#include "server/emulate/pty_port.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <asm/termbits.h>  // termios2, whose rates are plain numbers; excludes <termios.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace server::emulate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(fmt::format("{}: {}.", what, std::system_category().message(errno)));
}

/// The initial settings of a port: no echo, no translation.
void make_raw(int fd) {
  constexpr unsigned kFirstRate = 9600;
  termios2 settings{};
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_ispeed = kFirstRate;
  settings.c_ospeed = kFirstRate;
  if (::ioctl(fd, TCSETS2, &settings) != 0) fail("The pseudo-terminal cannot be configured");
}

/// Throws std::runtime_error unless there is no `link`, or one that a killed emulator left over:
/// its terminal has gone.
void refuse_foreign(const fs::path& link) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(link, error);
  if (!fs::exists(there)) return;
  if (!fs::is_symlink(there)) {
    throw std::runtime_error(link.string() + " exists and is no link: choose another --link.");
  }
  const fs::path target = fs::read_symlink(link, error);
  if (target.parent_path() != "/dev/pts") {
    throw std::runtime_error(
        fmt::format("{} leads to {}, which is no emulator's: choose another --link.",
                    link.string(),
                    target.string()));
  }
  if (fs::exists(target, error)) {
    throw std::runtime_error(
        fmt::format("{} leads to {}, which another program has: end that emulator, or remove the "
                    "link if there is none.",
                    link.string(),
                    target.string()));
  }
}

}  // namespace

PtyPort::PtyPort(fs::path link) : link_(std::move(link)) {
  plug();
}

PtyPort::~PtyPort() {
  unplug();
}

void PtyPort::plug() {
  if (fd_ >= 0) return;
  refuse_foreign(link_);
  fd_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) fail("No pseudo-terminal is available");
  std::array<char, 128> name{};
  if (::grantpt(fd_) != 0 || ::unlockpt(fd_) != 0 ||
      ::ptsname_r(fd_, name.data(), name.size()) != 0) {
    fail("The pseudo-terminal has no other end");
  }
  slave_ = name.data();
  // Opened and closed once: from then on poll() reports that no program has it open.
  const int host = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (host < 0) fail(slave_.string() + " cannot be opened");
  make_raw(host);
  ::close(host);
  std::error_code error;
  fs::remove(link_, error);  // a dead one
  fs::create_symlink(slave_, link_, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("The link {} cannot be made: {}.", link_.string(), error.message()));
  }
}

void PtyPort::unplug() {
  if (fd_ < 0) return;
  remove_link();
  ::close(fd_);
  fd_ = -1;
}

/// Removes the link only if it is still ours.
void PtyPort::remove_link() const {
  std::error_code error;
  if (fs::read_symlink(link_, error) == slave_ && !error) fs::remove(link_, error);
}

bool PtyPort::listened_to() const {
  if (fd_ < 0) return false;
  pollfd state{.fd = fd_, .events = POLLIN, .revents = 0};
  return ::poll(&state, 1, 0) >= 0 && (state.revents & POLLHUP) == 0;
}

unsigned PtyPort::host_baud() const {
  termios2 settings{};
  if (fd_ < 0 || ::ioctl(fd_, TCGETS2, &settings) != 0) return 0;
  return settings.c_ospeed;
}

std::size_t PtyPort::read(std::span<std::uint8_t> into) const {
  if (fd_ < 0) return 0;
  const ssize_t got = ::read(fd_, into.data(), into.size());
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

std::size_t PtyPort::write(drivers::ByteView bytes) const {
  if (fd_ < 0) return 0;
  const ssize_t sent = ::write(fd_, bytes.data(), bytes.size());
  return sent > 0 ? static_cast<std::size_t>(sent) : 0;
}

}  // namespace server::emulate
