// server/serve/experiments.hpp: headless runs in the background, one after another.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/record/recorder.hpp"
#include "server/run/run_spec.hpp"

namespace server {

struct Experiment {
  RunSpec spec{};
  std::uint32_t repeats = 1;  // seeds spec.seed, spec.seed + 1, ...
  double pace = 0;            // times real time; 0 = as fast as it goes
};

/// Queues runs in the database and works them off on a pool of its own, as trials without judges,
/// so that neither the io thread nor a live robot waits. While the store takes no more runs the
/// queue waits; runs of it can be cancelled all the same. A restart leaves them `interrupted`, to
/// be taken up again by resume().
class Experiments {
 public:
  using Accepted =
      std::function<void(const std::vector<db::RunId>& runs, const std::string& failure)>;

  static constexpr std::size_t kMaxWaiting = 20'000;  // runs of all experiments together
  /// [bytes] of the worlds that wait to be run, which repeats share.
  static constexpr std::size_t kMaxBytes = std::size_t{192} << 20;

  /// One thread as a rule: a core is then left to the io thread, which carries Stop, and to live
  /// robots.
  explicit Experiments(Recorder& recorder, unsigned threads = 1);
  ~Experiments();  // the runs at work are interrupted, queued ones stay behind

  /// Takes no more, and returns when nothing of it is under way on the db thread: batches that are
  /// half queued are given up.
  void stop();

  /// Gives the runs their numbers and queues them, a slice at a time between the frames of live
  /// runs; `accepted` is called on the db thread, with either all numbers or why there are none.
  /// False when too many runs or too large worlds wait already. Throws what is wrong with the
  /// world.
  bool start(Experiment experiment, Accepted accepted);

  /// Ends or unqueues a run. False when it is not among the queued and running.
  bool cancel(db::RunId run);

  /// Queues a run that was cut, to be run again from its start under its own number. `resumed` is
  /// called on the db thread with why not, or "". `spec`, `pace`: as it was begun;
  /// `document_bytes`: the size of its world as text. False when too much waits already.
  bool resume(db::RunId run,
              RunSpec spec,
              double pace,
              std::size_t document_bytes,
              std::function<void(const std::string& refusal)> resumed);

 private:
  /// What all repeats have in common, kept once. It counts in `held` as long as it lives.
  struct Batch {
    explicit Batch(std::atomic<std::size_t>& all_bytes) : held(all_bytes) {}
    ~Batch() { held -= bytes; }
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;

    bool hold(std::size_t document_bytes);

    std::atomic<std::size_t>& held;
    std::size_t bytes = 0;
    Experiment experiment{};
    db::NewRun row{};
    Accepted accepted{};
    std::vector<db::RunId> runs{};  // the db thread's until they are queued
  };
  struct Job {
    std::shared_ptr<const Batch> batch{};
    std::uint64_t seed = 0;
    db::RunId run = 0;
    bool again = false;  // ticks of an earlier time are to be cleared away
  };

  /// A run at work.
  struct Running {
    bool cancelled = false;
    std::stop_source stop{};
  };

  void insert_slice(const std::shared_ptr<Batch>& batch);
  void insert(db::RunStore& store, Batch& batch);
  void queue(const std::shared_ptr<Batch>& batch);
  void give_up(const Batch& batch, const std::string& why);
  void arrived(std::size_t runs);
  static std::string requeue(db::RunStore& store, db::RunId run);
  static RunSpec spec_of(const Job& job);
  experiment::Pool::Job take(const std::stop_token& stop);
  void work_off(const Job& job, Running& running, const std::stop_token& stop);
  bool execute(const Job& job, Running& running);
  void end_later(db::RunId run, db::RunEnd end);

  Recorder& recorder_;
  std::atomic<std::size_t> held_{0};  // [bytes] of all batches; declared first, as they count in it
  std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::deque<Job> queue_{};
  std::size_t arriving_ = 0;  // accepted, but not yet in the queue
  bool stopping_ = false;
  std::map<db::RunId, std::shared_ptr<Running>> running_{};
  experiment::Pool pool_;  // last: it works with all the others
};

}  // namespace server
