// server/serve/workers.cpp: a job queue and its threads.
#include "server/serve/workers.hpp"

#include <utility>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace server {
namespace {}  // namespace

db::RunReader& Worker::runs() {
  struct stat now {};
  const bool there = ::stat(database_.c_str(), &now) == 0;
  if (reader_ && there && now.st_dev == device_ && now.st_ino == inode_) return *reader_;
  reader_.reset();
  reader_ = std::make_unique<db::RunReader>(database_);
  device_ = now.st_dev;
  inode_ = now.st_ino;
  return *reader_;
}

Workers::Workers(const std::string& database, std::size_t threads) {
  for (std::size_t i = 0; i < threads; ++i) {
    threads_.emplace_back([this, database](const std::stop_token& stop) { work(stop, database); });
  }
}

void Workers::post(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return;
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

void Workers::stop() {
  std::deque<Job> dropped;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped.swap(jobs_);
  }
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
}

void Workers::work(const std::stop_token& stop, const std::string& database) {
  give_way();
  Worker worker(database, stop);
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return !jobs_.empty(); })) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job(worker);
  }
}

void give_way(int nice) {
  // Affects this thread only: on Linux each thread has its own nice value.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), nice);
}

}  // namespace server
