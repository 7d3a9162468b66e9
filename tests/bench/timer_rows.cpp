// tests/bench/timer_rows.cpp: how late the pacer wakes its thread, against a bare timer loop.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "tests/bench/rows.hpp"
#include "tests/bench/ws_readers.hpp"
#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>

#include "drivers/real_time.hpp"
#include "server/run/pacer.hpp"
#include "server/serve/foxglove/hub.hpp"

namespace bench {
namespace {

struct Lateness {
  std::vector<double> seconds{};
  std::size_t missed = 0;  // deadlines more than a period late
  double p99() { return quantile(seconds, 0.99); }
  std::string words() {
    return fmt::format("p50 {}, p99.9 {}, longest {}, {} of {} missed",
                       duration(median(seconds)),
                       duration(quantile(seconds, 0.999)),
                       duration(quantile(seconds, 1)),
                       missed,
                       seconds.size());
  }
  void add(double late, double period) {
    seconds.push_back(std::max(0.0, late));
    if (late > period) ++missed;
  }
};

/// SCHED_FIFO for the calling thread. @return false when the system does not allow it
bool become_fifo() {
  sched_param parameter{};
  parameter.sched_priority = 20;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0;
}

/// Only sleeps to absolute deadlines.
Lateness bare_timer(double period, double seconds) {
  Lateness late;
  const double start = wall();
  const auto count = static_cast<std::size_t>(seconds / period);
  for (std::size_t i = 1; i <= count; ++i) {
    const double deadline = start + static_cast<double>(i) * period;
    timespec until{};
    until.tv_sec = static_cast<time_t>(deadline);
    until.tv_nsec = static_cast<long>(1e9 * (deadline - std::floor(deadline)));
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
    }
    late.add(wall() - deadline, period);
  }
  return late;
}

/// The same by the pacer of the robot's period. A skipped deadline counts with its lateness when
/// skipped, so that skipping does not improve the quantiles.
Lateness paced(double period, double seconds) {
  Lateness late;
  drivers::ask_for_punctual_timers();  // as the control thread of a real robot does
  server::Pacer pacer;
  pacer.restart();
  const double start = wall();
  const auto count = static_cast<std::size_t>(seconds / period);
  double deadline = start;
  std::uint64_t missed = 0;
  while (late.seconds.size() < count) {
    const double asked = wall();
    pacer.wait(period);
    const double woken = wall();
    for (deadline += period; missed < pacer.missed(); deadline += period, ++missed) {
      late.add(asked - deadline, period);
    }
    late.add(woken - deadline, period);
  }
  late.missed = missed;
  return late;
}

/// Runs both loops at once, each on a thread of its own.
struct Both {
  Lateness fast{};  // 1 kHz
  Lateness slow{};  // 38.46 Hz
};
Both run_both(Lateness (*loop)(double, double), double seconds, bool fifo) {
  Both both;
  const auto on_thread = [&](Lateness& out, double period) {
    return std::thread([&out, loop, period, seconds, fifo] {
      if (fifo) become_fifo();
      out = loop(period, seconds);
    });
  };
  std::thread fast = on_thread(both.fast, 1e-3);
  std::thread slow = on_thread(both.slow, 0.026);
  fast.join();
  slow.join();
  return both;
}

/// Ten clients that get a frame of 1,000 bytes at 40 Hz.
class Streaming {
 public:
  Streaming() {
    channel_ = hub_.add_channel({"/telemetry", "tautline.wire.Frame"});
    running_.server.add(hub_.endpoint("/ws"));
    running_.server.every(std::chrono::milliseconds(25), [this] {
      const auto now = std::chrono::steady_clock::now().time_since_epoch();
      hub_.publish(channel_,
                   static_cast<std::uint64_t>(now.count()),
                   std::make_shared<const std::string>(1000, 'x'));
    });
    running_.start();
    readers_ = std::make_unique<WsReaders>(running_.port(), 10, 0);
  }

 private:
  server::foxglove::Hub hub_{};
  server::foxglove::ChannelId channel_ = 0;
  server::net::test::RunningServer running_{};
  std::unique_ptr<WsReaders> readers_{};
};

void add(Pass& pass,
         const std::string& name,
         Lateness& ours,
         Lateness& reference,
         const std::string& more) {
  // p99 as a share of its limit, 1.5 x ref + 20 us.
  const double limit = 1.5 * reference.p99() + 20e-6;
  pass.add({.row = "P22",
            .name = name + ", p99 over 1.5 ref + 20 us",
            .value = ours.p99() / limit,
            .unit = "x",
            .better = Better::Lower,
            .floor = 1,
            .note = fmt::format("p99 {}; {}{}", duration(ours.p99()), ours.words(), more)});
  pass.add({.row = "P22",
            .name = name + ", p99 over ref",
            .value = ours.p99() / reference.p99(),
            .unit = "x",
            .better = Better::Lower,
            .stretch = 1.1,
            .note = fmt::format("ref p99 {}; {}", duration(reference.p99()), reference.words())});
}

}  // namespace

void timers(Pass& pass) {
  const double seconds = pass.count(60.0, 0.2);
  bool allowed = false;
  std::thread([&] { allowed = become_fifo(); }).join();
  for (const bool fifo : {false, true}) {
    if (fifo && !allowed) {
      fmt::print(stderr, "  P22 with SCHED_FIFO is left out: this system does not allow it.\n");
      return;
    }
    Both reference = run_both(bare_timer, seconds, fifo);
    const Streaming streaming;
    Both ours = run_both(paced, seconds, fifo);
    const std::string how = fifo ? " FIFO" : " plain";
    add(pass, "1 kHz" + how, ours.fast, reference.fast, "");
    add(pass, "38.46 Hz" + how, ours.slow, reference.slow, "");
  }
}

}  // namespace bench
