// drivers/line_thread.cpp: opens the port, passes bytes to the machine, sends its orders.
#include "drivers/line_thread.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "drivers/real_time.hpp"

namespace drivers {
namespace {

constexpr double kFirstRetry = 0.5;   // [s] until the first retry of the port
constexpr double kLastRetry = 4.0;    // [s]
constexpr double kLongestWait = 0.1;  // [s] so that a stop is seen soon
// Bytes that may have waited longer are discarded: an old report would pass for a new one.
constexpr double kLongestUnread = 0.25;  // [s]
constexpr SerialPort::Milliseconds kWriteTimeout{200};
// An LMS200 needs 55 us between two bytes. At lower rates one byte already takes that long.
constexpr unsigned kNeedsGaps = 100'000;  // [bit/s] from this rate on
constexpr long kGap_ns = 60'000;

void sleep_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace

LineThread::LineThread(std::string path, Machine& machine)
    : path_(std::move(path)),
      machine_(machine),
      wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

LineThread::~LineThread() {
  thread_.request_stop();
  wake();
  thread_.join();
  ::close(wake_);
}

void LineThread::wake() const {
  const std::uint64_t one = 1;
  // It fails only when enough wake-ups are pending already.
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
}

/// Waits for bytes, an order or the timeout; true when there are bytes to read.
bool LineThread::wait(const SerialPort* port, double seconds) const {
  std::array<pollfd, 2> waiting{pollfd{.fd = wake_, .events = POLLIN, .revents = 0},
                                pollfd{.fd = -1, .events = POLLIN, .revents = 0}};
  if (port != nullptr) waiting[1].fd = port->descriptor();
  const double limited = std::clamp(seconds, 0.0, kLongestWait);
  timespec timeout{};
  timeout.tv_nsec = static_cast<long>(limited * 1e9);
  ::ppoll(waiting.data(), waiting.size(), &timeout, nullptr);
  if (waiting[0].revents != 0) {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(wake_, &count, sizeof count);
  }
  return waiting[1].revents != 0;
}

void LineThread::run(const std::stop_token& stop) {
  name_this_thread("line");
  // Above the control loop's priority: the loop decides by the data that this thread brings.
  request_real_time(kReaderPriority);
  double retry = kFirstRetry;
  while (!leaving(stop)) {
    const double began = steady_now();
    try {
      serve(stop);
    } catch (const LineError& error) {
      const std::lock_guard lock(mutex_);
      machine_.closed(steady_now(), error.what());
    }
    if (stop.stop_requested()) return;
    // A line that worked for a while is retried soon; one that never opens, less and less often.
    retry = steady_now() - began > kLastRetry ? kFirstRetry : std::min(2 * retry, kLastRetry);
    for (const double until = steady_now() + retry; steady_now() < until;) {
      if (stop.stop_requested()) return;
      wait(nullptr, until - steady_now());
    }
  }
}

/// True once nothing is left to do.
bool LineThread::leaving(const std::stop_token& stop) {
  if (!stop.stop_requested()) return false;
  const std::lock_guard lock(mutex_);
  const double now = steady_now();
  if (!left_) {
    left_ = true;
    leave_until_ = now + kLeaving;
    machine_.leave(now);
  }
  return machine_.left() || now > leave_until_;
}

void LineThread::serve(const std::stop_token& stop) {
  unsigned baud = 0;
  {
    const std::lock_guard lock(mutex_);
    baud = machine_.opening_baud();
  }
  SerialPort port(path_, baud);
  {
    const std::lock_guard lock(mutex_);
    machine_.opened(steady_now(), port.baud());
  }
  std::array<std::uint8_t, 4096> bytes{};
  double unread_since = steady_now();
  for (;;) {
    double wake = 0;
    {
      const std::lock_guard lock(mutex_);
      machine_.advance(steady_now());
      wake = machine_.wake_time();
    }
    const bool over = leaving(stop);
    unread_since += carry_out_orders(port);
    if (over) return;
    const bool waits = wait(&port, wake - steady_now());
    const double unread = steady_now() - unread_since;
    unread_since += unread;
    if (!waits) continue;
    if (unread > kLongestUnread) {
      port.discard_input();
      const std::lock_guard lock(mutex_);
      machine_.lost_bytes();
      continue;
    }
    const std::size_t got = port.read(bytes, SerialPort::Milliseconds(0));
    const std::lock_guard lock(mutex_);
    machine_.receive(steady_now(), ByteView(bytes).first(got));
  }
}

/// Returns the seconds of pause that the orders ask for.
double LineThread::carry_out_orders(SerialPort& port) {
  constexpr double kBitsOfAByte = 10;
  double asked = 0;
  for (;;) {
    std::optional<LineOrder> order;
    {
      const std::lock_guard lock(mutex_);
      order = machine_.next_order();
    }
    if (!order) return asked;
    if (steady_now() > order->expires) continue;
    const unsigned baud = port.baud();
    if (baud > 0) asked += kBitsOfAByte * static_cast<double>(order->bytes.size()) / baud;
    asked += order->pause;
    if (order->baud) {
      port.set_baud(*order->baud);
      const std::lock_guard lock(mutex_);
      machine_.rate_set(steady_now(), port.baud());
    } else {
      send(port, *order);
    }
    if (order->pause > 0) sleep_for(order->pause);
  }
}

void LineThread::send(SerialPort& port, const LineOrder& order) const {
  const ByteView bytes = order.bytes.view();
  if (port.baud() < kNeedsGaps || !order.gaps) {
    port.write(bytes, kWriteTimeout);
    return;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    port.write(bytes.subspan(i, 1), kWriteTimeout);
    const timespec gap{.tv_sec = 0, .tv_nsec = kGap_ns};
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &gap, nullptr);
  }
}

}  // namespace drivers
