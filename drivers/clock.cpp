// drivers/clock.cpp: CLOCK_MONOTONIC, which std::chrono::steady_clock is too.
#include "drivers/clock.hpp"

#include <cerrno>
#include <cmath>
#include <ctime>

namespace drivers {

double steady_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Absolute, so that what happens between asking and sleeping makes nothing late.
void SteadyClock::sleep_until(double time) {
  const double whole = std::floor(time);
  timespec until{};
  until.tv_sec = static_cast<std::time_t>(whole);
  until.tv_nsec = static_cast<long>((time - whole) * 1e9);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace drivers
