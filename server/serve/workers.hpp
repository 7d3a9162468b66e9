// server/serve/workers.hpp: threads for work that may take long: whole runs, files, worlds.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "db/run_reader.hpp"

namespace server {

/// What a job finds on the thread it runs on.
class Worker {
 public:
  explicit Worker(std::string database) : database_(std::move(database)) {}

  /// A reader of the run store of this thread's own. Opened when first asked for, and again when
  /// another file has taken the store's place. Throws db::StoreError.
  db::RunReader& runs();

 private:
  std::string database_;
  std::unique_ptr<db::RunReader> reader_{};
  std::uint64_t device_ = 0;  // of the file that is open
  std::uint64_t inode_ = 0;
};

/// Everything that reads a whole run, waits for a disk or builds a world runs here, so that the io
/// thread, which carries Stop, answers only what takes microseconds. Jobs begin in the order
/// posted. A long answer is made of many short jobs, one a slice, so that nobody waits for the
/// whole of another's. The threads stand back behind everything that drives a robot.
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
  /// Ends the jobs at work, drops the others and takes no more.
  void stop();

 private:
  void work(const std::stop_token& stop, const std::string& database);

  std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::deque<Job> jobs_{};
  bool stopped_ = false;
  std::vector<std::jthread> threads_{};
};

/// Lets the calling thread run when those that drive robots leave room. `nice`: the higher the
/// farther behind.
void give_way(int nice = 10);

}  // namespace server
