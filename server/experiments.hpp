// server/experiments.hpp: headless runs in the background, one after another.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/headless.hpp"
#include "server/recorder.hpp"
#include "server/run_spec.hpp"

namespace server {

struct Experiment {
  RunSpec spec{};
  std::uint32_t repeats = 1;  // seeds spec.seed, spec.seed + 1, ...
  double pace = 0;            // times real time; 0 = as fast as it goes
};

/// Queues runs in the database and works them off on a thread of its own, so that neither the io
/// thread nor a live robot waits. Runs survive a restart only as `interrupted`.
class Experiments {
 public:
  using Accepted = std::function<void(std::vector<db::RunId> runs, std::string failure)>;

  explicit Experiments(Recorder& recorder);
  ~Experiments();  // the run at work is ended as stopped, queued ones stay behind

  /// Gives the runs their numbers and queues them; `accepted` is called on the db thread, with
  /// either the numbers or why there are none.
  void start(Experiment experiment, Accepted accepted);

  /// Ends or unqueues a run. False when it is not among the queued and running.
  bool cancel(db::RunId run);

  std::size_t waiting() const;

 private:
  struct Job {
    RunSpec spec{};
    double pace = 0;
    db::RunId run = 0;
  };

  void work(const std::stop_token& stop);
  void execute(const Job& job);

  Recorder& recorder_;
  mutable std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::deque<Job> queue_{};
  db::RunId running_ = 0;
  bool cancelled_ = false;  // the running one
  std::stop_source stop_running_{};
  std::jthread worker_;
};

}  // namespace server
