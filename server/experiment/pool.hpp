// server/experiment/pool.hpp: threads that run jobs until there are none left.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace server::experiment {

/// Runs jobs and begins them in the order of the source.
class Pool {
 public:
  using Job = std::function<void()>;
  /// Returns the next job; an empty job ends the calling worker. Workers call it concurrently. It
  /// may wait, but returns soon after `stop` is requested.
  using Source = std::function<Job(const std::stop_token& stop)>;

  /// `threads`: 0 means one per core. A request of `stop` also stops the pool.
  Pool(unsigned threads, Source source, const std::stop_token& stop = {});
  ~Pool() { request_stop(); }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Begins no further jobs.
  void request_stop() { stop_.request_stop(); }
  /// Waits for all workers to end. Throws the exception of the first job that failed; no job is
  /// begun after that failure.
  void join();

 private:
  void work();

  Source source_;
  std::stop_source stop_{};
  std::stop_callback<std::function<void()>> cut_;  // before the workers, which may request a stop
  std::mutex mutex_{};
  std::exception_ptr problem_{};
  std::vector<std::jthread> workers_{};
};

/// Every `count`th job of a list, from number `index` on. The results of all shards, interleaved,
/// are those of the whole list.
struct Shard {
  std::size_t index = 0;  // below count
  std::size_t count = 1;
  /// Number of this shard's jobs among `all` jobs.
  std::size_t share(std::size_t all) const { return (all + count - 1 - index) / count; }
  /// Number in the whole list of the shard's `k`th job.
  std::size_t job(std::size_t k) const { return index + k * count; }
};
/// Parses "0/3". Throws std::invalid_argument with a sentence.
Shard shard_from_text(std::string_view text);

/// `done` of `all` jobs have ended. Called from the workers, one at a time.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// Progress of several parts; `part` names the current one.
using NamedProgress =
    std::function<void(const std::string& part, std::size_t done, std::size_t all)>;

struct PoolOptions {
  unsigned threads = 0;  // 0: one per core
  Shard shard{};
  Progress progress{};
  std::stop_token stop{};  // begins no job after it, and asks running jobs to end
};

/// Options for the part of that name; `progress` may be empty.
PoolOptions part_of(std::string name, unsigned threads, const NamedProgress& progress);

/// Calls `job(i, stop)` once for every i below `count` in the shard. When a job throws, `stop` asks
/// the others to end, and for_each() throws the same exception.
void for_each(std::size_t count,
              const PoolOptions& options,
              const std::function<void(std::size_t i, const std::stop_token& stop)>& job);

}  // namespace server::experiment
