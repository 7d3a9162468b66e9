// server/serve/run_queue.hpp: runs headless runs in the background, one after another.
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

struct RepeatedRun {
  RunSpec spec{};
  std::uint32_t repeats = 1;  // seeds spec.seed, spec.seed + 1, ...
  double pace = 0;            // times real time; 0 = as fast as possible
};

/// Queues runs in the database and runs them on its own pools, as trials without judges, so that
/// neither the io thread nor a live robot waits. Paced runs mostly sleep, some of them for hours:
/// they have threads of their own, of which the runs of one start() take a part. The queue waits
/// while the store accepts no runs; its runs can still be cancelled. A restart leaves them
/// `interrupted`; resume() queues them again.
class RunQueue {
 public:
  using Accepted =
      std::function<void(const std::vector<db::RunId>& runs, const std::string& failure)>;

  static constexpr std::size_t kMaxWaiting = 20'000;  // queued runs of all batches
  /// [bytes] of all queued worlds; repeats share one world.
  static constexpr std::size_t kMaxBytes = std::size_t{192} << 20;

  static constexpr unsigned kPaced = 8;  // threads for paced runs, which mostly sleep

  /// `threads`: for runs without a pace, and for the paced runs of one start(). One by default,
  /// which leaves a core to the io thread, which carries Stop, and to live robots.
  explicit RunQueue(Recorder& recorder, unsigned threads = 1);
  ~RunQueue();  // interrupts current runs; queued runs stay in the database

  /// Accepts no more runs. Returns when the database thread does no more work for it: half-queued
  /// batches are given up.
  void stop();

  /// Numbers and queues the runs in slices, between the frames of live runs. Calls `accepted` on
  /// the database thread, with all numbers or the reason for a refusal. False if too many runs or
  /// too large worlds wait already. Throws if the world is invalid.
  bool start(RepeatedRun asked, Accepted accepted);

  /// Ends or unqueues a run. False if it is neither queued nor running.
  bool cancel(db::RunId run);

  /// Queues an interrupted run again, from its start and under its own number. Calls `resumed` on
  /// the database thread with the reason for a refusal, or "". `spec`, `pace`: as at its first
  /// start; `document_bytes`: the size of its world as text. False if too much waits already.
  bool resume(db::RunId run,
              RunSpec spec,
              double pace,
              std::size_t document_bytes,
              std::function<void(const std::string& refusal)> resumed);

 private:
  /// The data that all repeats share. It counts in `held` during its lifetime.
  struct Batch {
    explicit Batch(std::atomic<std::size_t>& all_bytes) : held(all_bytes) {}
    ~Batch() { held -= bytes; }
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;

    bool hold(std::size_t document_bytes);

    std::atomic<std::size_t>& held;
    std::size_t bytes = 0;
    RepeatedRun asked{};
    db::NewRun row{};
    Accepted accepted{};
    std::vector<db::RunId> runs{};  // used by the database thread until queued
    unsigned at_work = 0;           // runs; RunQueue::mutex_
  };
  struct Job {
    std::shared_ptr<Batch> batch{};
    std::uint64_t seed = 0;
    db::RunId run = 0;
    bool again = false;  // ticks of an earlier start must be deleted
  };

  /// A run in progress.
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
  enum class Kind : bool { AsFastAsItGoes, Paced };
  std::deque<Job>::iterator first_of(Kind kind);
  experiment::Pool::Job take(Kind kind, const std::stop_token& stop);
  void work_off(const Job& job, Running& running, const std::stop_token& stop);
  bool execute(const Job& job, Running& running);
  void end_later(db::RunId run, db::RunEnd end);

  Recorder& recorder_;
  const unsigned threads_;
  std::atomic<std::size_t> held_{0};  // [bytes] of all batches; first, as batches refer to it
  std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::deque<Job> queue_{};
  std::size_t arriving_ = 0;  // accepted runs not yet in the queue
  bool stopping_ = false;
  std::map<db::RunId, std::shared_ptr<Running>> running_{};
  experiment::Pool fast_;  // last, both: they use all of the above
  experiment::Pool paced_;
};

}  // namespace server
