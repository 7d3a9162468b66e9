// drivers/clock.cpp: CLOCK_BOOTTIME: unlike std::chrono::steady_clock it counts while the computer
// is suspended, so that scans from before the suspension are old afterwards.
#include "drivers/clock.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

namespace drivers {

double steady_now() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Sleeps until an absolute time, so that a delay before the sleep does not add up. Kernels that
/// cannot sleep by this clock repeat relative sleeps.
void SteadyClock::sleep_until(double time) {
  const double whole = std::floor(time);
  timespec until{};
  until.tv_sec = static_cast<std::time_t>(whole);
  until.tv_nsec = static_cast<long>((time - whole) * 1e9);
  int result = 0;
  do {
    result = ::clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &until, nullptr);
  } while (result == EINTR);
  if (result == 0) return;
  while (now() < time) {
    std::this_thread::sleep_for(std::chrono::duration<double>(time - now()));
  }
}

}  // namespace drivers
