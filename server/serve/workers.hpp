// server/serve/workers.hpp: threads for slow work: whole runs, files, worlds.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "db/run_reader.hpp"

namespace server {

/// The worker thread as seen by a job.
class Worker {
 public:
  explicit Worker(std::string database, std::stop_token stop = {})
      : database_(std::move(database)), stop_(std::move(stop)) {}

  /// Asks a long job to end, because the server does.
  const std::stop_token& stop() const { return stop_; }

  /// This thread's own reader of the run store. Opens it at first use, and again when another file
  /// has replaced the store. Throws db::StoreError.
  db::RunReader& runs();

 private:
  std::string database_;
  std::stop_token stop_;
  std::unique_ptr<db::RunReader> reader_{};
  std::uint64_t device_ = 0;  // of the open file
  std::uint64_t inode_ = 0;
};

/// Everything that reads a whole run, waits for a disk or builds a world runs here. The io thread,
/// which carries Stop, then only does work of microseconds. Jobs begin in the order posted. A long
/// answer is made by many short jobs, one per slice, so that other answers need not wait for all of
/// it. The threads have a lower priority than all that drive a robot.
class Workers {
 public:
  using Job = std::function<void(Worker&)>;

  static constexpr std::size_t kThreads = 3;

  explicit Workers(const std::string& database, std::size_t threads = kThreads);
  ~Workers() { stop(); }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// From any thread. A job must not throw.
  void post(Job job);
  /// Lets running jobs end, drops the others and accepts no more.
  void stop();

 private:
  void work(const std::stop_token& stop, const std::string& database);

  std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::deque<Job> jobs_{};
  bool stopped_ = false;
  std::vector<std::jthread> threads_{};
};

/// Lowers the priority of the calling thread below the threads that drive robots. `nice`: higher
/// means lower priority.
void give_way(int nice = 10);

}  // namespace server
