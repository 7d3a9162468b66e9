// drivers/real_time.hpp: what the system allows a control loop: its priority, its memory kept in
// place.
#pragma once

#include <string>

namespace drivers {

constexpr int kControlPriority = 40;  // SCHED_FIFO
constexpr int kReaderPriority = 45;

/// SCHED_FIFO at `priority` for the calling thread. False when the system does not permit it.
bool request_real_time(int priority);
/// Timers of the calling thread without the slack of 50 us that the kernel takes to save power;
/// with a real-time priority it has none anyway.
void ask_for_punctual_timers();
/// Keeps all memory of the program in place. False when the system does not permit it.
bool lock_memory();
/// At most 15 characters, for those who look with top or gdb.
void name_this_thread(const char* name);

/// What of the above can be had here, as sentences; one for each that cannot, with what to do.
struct RealTimeCheck {
  bool priority = false;
  bool memory = false;
  bool preemptible_kernel = false;  // PREEMPT_RT
};
RealTimeCheck check_real_time();
std::string priority_advice();
std::string memory_advice();

}  // namespace drivers
