// drivers/real_time.hpp: real-time priority and locked memory for a control loop, where the system
// permits them.
#pragma once

#include <string>

namespace drivers {

constexpr int kControlPriority = 40;  // SCHED_FIFO
constexpr int kReaderPriority = 45;

/// SCHED_FIFO at `priority` for the calling thread. False when the system does not permit it.
bool request_real_time(int priority);
/// Removes the timer slack of 50 us by which the kernel saves power, for the calling thread. A
/// thread with real-time priority has none anyway.
void ask_for_punctual_timers();
/// Locks all memory of the program. False when the system does not permit it.
bool lock_memory();
/// Names the calling thread, for top and gdb. At most 15 characters.
void name_this_thread(const char* name);

/// Which of these settings the system permits.
struct RealTimeCheck {
  bool priority = false;
  bool memory = false;
  bool preemptible_kernel = false;  // PREEMPT_RT
};
RealTimeCheck check_real_time();
/// What is not permitted and the remedy, as a sentence.
std::string priority_advice();
std::string memory_advice();

}  // namespace drivers
