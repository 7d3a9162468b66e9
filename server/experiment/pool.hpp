// server/experiment/pool.hpp: threads that take the next job until there is none.
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

/// Works off jobs, each begun in the order in which the source gives them.
class Pool {
 public:
  using Job = std::function<void()>;
  /// The next job; an empty one ends the worker that asked. Called by all workers at once; may
  /// wait, but returns soon after `stop` is requested.
  using Source = std::function<Job(const std::stop_token& stop)>;

  /// `threads`: 0 is one a core. A request of `stop` is one of the pool's own.
  Pool(unsigned threads, Source source, const std::stop_token& stop = {});
  ~Pool() { request_stop(); }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// No job is begun from now on.
  void request_stop() { stop_.request_stop(); }
  /// Waits for the end of all workers. Throws what the first job that failed threw; no job is begun
  /// after that.
  void join();

 private:
  void work();

  Source source_;
  std::stop_source stop_{};
  std::stop_callback<std::function<void()>> cut_;  // before the workers, who may request it
  std::mutex mutex_{};
  std::exception_ptr problem_{};
  std::vector<std::jthread> workers_{};
};

/// Every `count`th of many jobs, from number `index` on: the shards of one list give, interleaved,
/// what the whole list gives.
struct Shard {
  std::size_t index = 0;  // below count
  std::size_t count = 1;
  /// How many of `all` jobs are this shard's.
  std::size_t share(std::size_t all) const { return (all + count - 1 - index) / count; }
  /// The number in the whole list of the shard's own `k`th.
  std::size_t job(std::size_t k) const { return index + k * count; }
};
/// From "0/3". Throws std::invalid_argument with a sentence.
Shard shard_from_text(std::string_view text);

/// `done` of `all` jobs are over. Called from the workers, one at a time.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// The same of several parts, with what is being run.
using NamedProgress =
    std::function<void(const std::string& part, std::size_t done, std::size_t all)>;

struct PoolOptions {
  unsigned threads = 0;  // 0: one a core
  Shard shard{};
  Progress progress{};
  std::stop_token stop{};  // no job is begun after it, and those under way are asked to end
};

/// For the part of that name; `progress` may be empty.
PoolOptions part_of(std::string name, unsigned threads, const NamedProgress& progress);

/// Calls `job(i, stop)` once for every i below `count` that is the shard's. When one throws, the
/// others are asked to end by `stop`, and for_each() throws the same.
void for_each(std::size_t count,
              const PoolOptions& options,
              const std::function<void(std::size_t i, const std::stop_token& stop)>& job);

}  // namespace server::experiment
