// drivers/real_time.cpp: requests real-time settings from the system; a refusal is no error.
#include "drivers/real_time.hpp"

#include <algorithm>
#include <fstream>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace drivers {

bool request_real_time(int priority) {
  sched_param wanted{};
  wanted.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &wanted) == 0;
}

void ask_for_punctual_timers() {
  constexpr unsigned long kLeastSlack = 1;  // [ns]; 0 would restore the default
  ::prctl(PR_SET_TIMERSLACK, kLeastSlack, 0, 0, 0);
}

bool lock_memory() {
  // Lock pages on first use: otherwise each thread's unused stack would take memory too.
  return ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

void name_this_thread(const char* name) {
  ::pthread_setname_np(::pthread_self(), name);
}

RealTimeCheck check_real_time() {
  RealTimeCheck check;
  // Tried on this thread and then undone: the limits alone do not tell what capabilities allow.
  int policy = 0;
  sched_param before{};
  ::pthread_getschedparam(::pthread_self(), &policy, &before);
  check.priority = request_real_time(kControlPriority);
  ::pthread_setschedparam(::pthread_self(), policy, &before);

  rlimit memory{};
  ::getrlimit(RLIMIT_MEMLOCK, &memory);
  constexpr rlim_t kEnough = 512UL * 1024 * 1024;
  check.memory = memory.rlim_cur >= kEnough || ::geteuid() == 0;

  std::ifstream flag("/sys/kernel/realtime");
  int value = 0;
  check.preemptible_kernel = (flag >> value) && value == 1;
  return check;
}

std::string priority_advice() {
  return "No real-time priority is permitted: add \"@dialout - rtprio 50\" to "
         "/etc/security/limits.d/tautline.conf and log in again.";
}

std::string memory_advice() {
  return "Memory cannot be kept in place: add \"@dialout - memlock unlimited\" to "
         "/etc/security/limits.d/tautline.conf and log in again.";
}

}  // namespace drivers
