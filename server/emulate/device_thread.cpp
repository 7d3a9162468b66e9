// server/emulate/device_thread.cpp: the loop between a device and its port.
#include "server/emulate/device_thread.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "server/emulate/clock.hpp"

namespace server::emulate {

DeviceThread::DeviceThread(std::string name,
                           drivers::emulators::Device& device,
                           std::filesystem::path link)
    : Connection(std::move(name)),
      device_(device),
      port_(std::move(link)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

DeviceThread::~DeviceThread() {
  thread_ = {};
  ::close(wake_);
}

void DeviceThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void DeviceThread::wake() {
  ::eventfd_write(wake_, 1);
}

void DeviceThread::unplug(double seconds) {
  const auto held = lock();
  port_.unplug();
  plug_at_ = machine_time() + seconds;
}

void DeviceThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const double now = machine_time();
    double next = 0;
    {
      const auto held = lock();
      next = exchange(now);
    }
    rest(next - now);
  }
}

void DeviceThread::plug(double now) {
  try {
    port_.plug();
  } catch (const std::runtime_error& e) {
    spdlog::error("{}: {} Trying again.", name(), e.what());
    plug_at_ = now + 1;
  }
}

/// Does the work due at `now`; returns the time of the next work.
double DeviceThread::exchange(double now) {
  if (port_.descriptor() < 0 && now >= plug_at_) plug(now);
  listened_to_ = port_.listened_to();
  polled_ = listened_to_ ? port_.descriptor() : -1;  // an unopened port would wake without end
  std::array<std::uint8_t, 4096> heard{};
  const std::size_t size = port_.read(heard);
  const drivers::ByteView came(heard.data(), size);
  const unsigned host = port_.host_baud();
  if (size == 0) {
    device_.advance(now);
  } else if (host == device_.baud()) {
    device_.receive(came, now);
  } else {
    device_.receive(drivers::emulators::misread(came, host, device_.baud()), now);
  }
  for (;;) {
    bytes_.clear();
    const unsigned rate = device_.send(now, bytes_);
    if (bytes_.empty()) break;
    carry_out(rate, bytes_);
  }
  return device_.next();
}

void DeviceThread::carry_out(unsigned rate, const std::vector<std::uint8_t>& bytes) {
  if (!listened_to_) return;
  const unsigned host = port_.host_baud();
  if (host == rate) {
    overrun_ += bytes.size() - port_.write(bytes);
  } else if (host > 0) {
    port_.write(drivers::emulators::misread(bytes, rate, host));
  }
}

/// Waits for bytes or work. Not for each single byte: a port delivers bytes in portions.
void DeviceThread::rest(double seconds) {
  constexpr double kShortest = 0.002;
  constexpr double kLongest = 0.005;
  const auto milliseconds = static_cast<int>(1000 * std::clamp(seconds, kShortest, kLongest));
  std::array<pollfd, 2> sources{{{.fd = wake_, .events = POLLIN, .revents = 0},
                                 {.fd = polled_, .events = POLLIN, .revents = 0}}};
  ::poll(sources.data(), sources.size(), milliseconds);
  eventfd_t woken = 0;
  ::eventfd_read(wake_, &woken);
}

}  // namespace server::emulate
