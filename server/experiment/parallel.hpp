// server/experiment/parallel.hpp: independent jobs on all cores.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace server {

/// Calls `job(i)` for every i below `count` on `threads` threads (0: one a core), each once, in
/// rising order of their beginnings. Rethrows what the first that failed threw; the others end what
/// they are about.
inline void in_parallel(std::size_t count,
                        unsigned threads,
                        const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> broken{false};
  std::mutex mutex;
  std::exception_ptr problem;
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !broken; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!problem) problem = std::current_exception();
        broken = true;
      }
    }
  };
  {
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  if (problem) std::rethrow_exception(problem);
}

}  // namespace server
