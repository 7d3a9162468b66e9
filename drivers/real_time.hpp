// drivers/real_time.hpp: what the system allows a control loop: its priority, its memory kept in
// place; and how well it kept its deadlines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

/// How late the loop woke for its ticks. Written by one thread; copies are for others.
class LatenessHistogram {
 public:
  static constexpr std::array<double, 8> kLimits{
      1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 5e-2};  // [s] upper ends; one more beyond the last
  static constexpr std::size_t kBuckets = kLimits.size() + 1;

  void add(double late);  // [s]
  const std::array<std::uint64_t, kBuckets>& counts() const { return counts_; }
  double worst() const { return worst_; }  // [s]
  std::uint64_t ticks() const { return ticks_; }

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
  double worst_ = 0;
  std::uint64_t ticks_ = 0;
};

}  // namespace drivers
