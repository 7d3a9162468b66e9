// server/serve/run_queue.cpp: the queue that feeds the pool.
#include "server/serve/run_queue.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "server/experiment/trial.hpp"
#include "server/record/run_json.hpp"
#include "server/serve/workers.hpp"

namespace server {
namespace {

// Between two slices of a batch, the database thread takes the frames of live runs.
constexpr std::chrono::milliseconds kSliceTime{10};
constexpr std::size_t kQueueSlice = 200;  // runs
// Interval at which the queue checks if the store takes runs again.
constexpr std::chrono::milliseconds kStoreRetry{200};

}  // namespace

/// Counts the memory of a batch's world, given the size of its text. False if there is no room.
bool RunQueue::Batch::hold(std::size_t document_bytes) {
  constexpr std::size_t kFixed = 4096;
  constexpr std::size_t kTimes = 6;  // measured: size of a world in memory relative to its text
  bytes = kFixed + kTimes * document_bytes;
  return held.fetch_add(bytes) + bytes <= kMaxBytes;
}

RunQueue::RunQueue(Recorder& recorder, unsigned threads)
    : recorder_(recorder),
      threads_(threads),
      fast_(threads, [this](const auto& stop) { return take(Kind::AsFastAsItGoes, stop); }),
      paced_(std::max(threads, kPaced),
             [this](const auto& stop) { return take(Kind::Paced, stop); }) {}

RunQueue::~RunQueue() {
  stop();
  fast_.request_stop();
  paced_.request_stop();
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [run, running] : running_) running->stop.request_stop();
  }
  wake_.notify_all();
}

void RunQueue::stop() {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  wake_.wait(lock, [this] { return arriving_ == 0; });
}

void RunQueue::arrived(std::size_t runs) {
  {
    const std::lock_guard lock(mutex_);
    arriving_ -= runs;
  }
  wake_.notify_all();
}

bool RunQueue::start(RepeatedRun asked, Accepted accepted) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || queue_.size() + arriving_ + asked.repeats > kMaxWaiting) return false;
    arriving_ += asked.repeats;
  }
  const auto batch = std::make_shared<Batch>(held_);
  batch->asked = std::move(asked);
  batch->accepted = std::move(accepted);
  try {
    // Refuse a world that cannot be built now, not in the background. The row holds its robot's
    // spec.
    const RunSpec& spec = batch->asked.spec;
    batch->row = headless_run(spec, make_robot(spec)->spec(), batch->asked.pace);
    if (batch->asked.repeats > 1) batch->row.batch = db::kNewBatch;
    if (!batch->hold(batch->row.document.size())) {
      arrived(batch->asked.repeats);
      return false;
    }
    insert_slice(batch);
  } catch (...) {
    arrived(batch->asked.repeats);
    throw;
  }
  return true;
}

void RunQueue::insert_slice(const std::shared_ptr<Batch>& batch) {
  recorder_.post([this, batch](db::RunStore& store) {
    try {
      insert(store, *batch);
      if (batch->runs.size() < batch->asked.repeats) {
        insert_slice(batch);
      } else {
        queue(batch);
      }
    } catch (const std::exception& e) {
      give_up(*batch, e.what());
    }
  });
}

void RunQueue::insert(db::RunStore& store, Batch& batch) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) throw db::StoreError("The server is stopping; nothing more is queued.");
  }
  if (!recorder_.takes_more()) throw db::StoreError(recorder_.status().sentence);
  const std::size_t before = batch.runs.size();
  const std::size_t end = std::min<std::size_t>(before + kQueueSlice, batch.asked.repeats);
  const auto until = std::chrono::steady_clock::now() + kSliceTime;
  try {
    do {
      batch.row.seed = batch.asked.spec.seed + batch.runs.size();
      batch.runs.push_back(store.queue_run(batch.row));
      if (batch.row.batch == db::kNewBatch) batch.row.batch = batch.runs.front();
    } while (batch.runs.size() < end && std::chrono::steady_clock::now() < until);
    store.commit();
  } catch (...) {
    batch.runs.resize(before);  // keep the runs that are in the store
    throw;
  }
}

void RunQueue::queue(const std::shared_ptr<Batch>& batch) {
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < batch->runs.size(); ++i) {
      queue_.push_back({batch, batch->asked.spec.seed + i, batch->runs[i]});
    }
  }
  batch->row = {};  // the store has its document now
  batch->accepted(batch->runs, {});
  arrived(batch->asked.repeats);
}

/// All or none: runs already in the store are cancelled, one slice at a time as they came.
void RunQueue::give_up(const Batch& batch, const std::string& why) {
  Recorder& recorder = recorder_;
  batch.accepted({}, why);
  arrived(batch.asked.repeats);  // from here on stop() may return and this object be destroyed
  for (std::size_t begin = 0; begin < batch.runs.size(); begin += kQueueSlice) {
    const auto from = batch.runs.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto left = static_cast<std::size_t>(batch.runs.end() - from);
    const auto to = from + static_cast<std::ptrdiff_t>(std::min(kQueueSlice, left));
    // The cause of the failure may also block this write, so retry it: nothing else would.
    recorder.post_when_well([runs = std::vector<db::RunId>(from, to), why](db::RunStore& store) {
      for (const db::RunId run : runs) {
        if (store.status_of(run) != db::RunStatus::Queued) continue;
        store.end_run(run,
                      {.status = db::RunStatus::Cancelled, .outcome = "stopped", .reason = why});
      }
    });
  }
}

bool RunQueue::cancel(db::RunId run) {
  const std::lock_guard lock(mutex_);
  if (const auto at_work = running_.find(run); at_work != running_.end()) {
    at_work->second->cancelled = true;
    at_work->second->stop.request_stop();
    return true;
  }
  const auto it =
      std::find_if(queue_.begin(), queue_.end(), [run](const Job& job) { return job.run == run; });
  if (it == queue_.end()) return false;
  queue_.erase(it);
  end_later(run, {.status = db::RunStatus::Cancelled, .outcome = "stopped"});
  return true;
}

bool RunQueue::resume(db::RunId run,
                      RunSpec spec,
                      double pace,
                      std::size_t document_bytes,
                      std::function<void(const std::string&)> resumed) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || queue_.size() + arriving_ >= kMaxWaiting) return false;
    ++arriving_;
  }
  const auto batch = std::make_shared<Batch>(held_);
  batch->asked = {.spec = std::move(spec), .pace = pace};
  if (!batch->hold(document_bytes)) {
    arrived(1);
    return false;
  }
  try {
    recorder_.post([this, run, batch, resumed = std::move(resumed)](db::RunStore& store) {
      const std::string refusal = requeue(store, run);
      if (refusal.empty()) {
        const std::lock_guard lock(mutex_);
        queue_.push_back({batch, batch->asked.spec.seed, run, true});
      }
      resumed(refusal);
      arrived(1);
    });
  } catch (...) {
    arrived(1);
    throw;
  }
  return true;
}

/// Queues the run again in the store; returns the reason if it cannot, else "".
std::string RunQueue::requeue(db::RunStore& store, db::RunId run) {
  try {
    if (!store.requeue_run(run)) return "The run is neither interrupted nor cancelled nor failed.";
    store.commit();
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

/// The first whose turn it is: the others of its batch must leave threads to those of other
/// batches. Holds mutex_.
std::deque<RunQueue::Job>::iterator RunQueue::first_of(Kind kind) {
  return std::ranges::find_if(queue_, [&](const Job& job) {
    return (job.batch->asked.pace > 0) == (kind == Kind::Paced) && job.batch->at_work < threads_;
  });
}

/// The next run of that kind as a job. Waits for a run, and for a store that takes it.
experiment::Pool::Job RunQueue::take(Kind kind, const std::stop_token& stop) {
  give_way();
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, stop, [&] { return first_of(kind) != queue_.end(); });
    // If the store does not take it, a run would end and nobody could see its result.
    while (!stop.stop_requested() && !recorder_.takes_more()) {
      wake_.wait_for(lock, stop, kStoreRetry, [] { return false; });
    }
    if (stop.stop_requested()) return {};
    const auto next = first_of(kind);
    if (next == queue_.end()) continue;  // its run was cancelled meanwhile
    Job job = std::move(*next);
    queue_.erase(next);
    ++job.batch->at_work;
    auto running = std::make_shared<Running>();
    running_[job.run] = running;
    return [this, job = std::move(job), running = std::move(running), stop] {
      work_off(job, *running, stop);
    };
  }
}

void RunQueue::work_off(const Job& job, Running& running, const std::stop_token& stop) {
  const bool begun = execute(job, running);
  std::unique_lock lock(mutex_);
  running_.erase(job.run);
  --job.batch->at_work;
  if (job.batch->asked.pace > 0) wake_.notify_all();  // another of its batch has its turn
  if (begun || stop.stop_requested()) return;
  if (running.cancelled) {
    end_later(job.run, {.status = db::RunStatus::Cancelled, .outcome = "stopped"});
    return;
  }
  queue_.push_front(job);
  wake_.wait_for(lock, stop, kStoreRetry, [] { return false; });
}

/// Ends a queued run as soon as the store takes it, unless it was lost with a damaged store.
void RunQueue::end_later(db::RunId run, db::RunEnd end) {
  recorder_.post_when_well([run, end = std::move(end)](db::RunStore& store) {
    if (store.status_of(run) == db::RunStatus::Queued) store.end_run(run, end);
  });
}

RunSpec RunQueue::spec_of(const Job& job) {
  RunSpec spec = job.batch->asked.spec;
  spec.seed = job.seed;
  return spec;
}

/// False if the store does not take the run now.
bool RunQueue::execute(const Job& job, Running& running) {
  const auto failed = [](const std::exception& e) -> db::RunEnd {
    return {.status = db::RunStatus::Failed, .outcome = "failed", .reason = e.what()};
  };
  try {
    while (job.again &&
           recorder_.ask([&](db::RunStore& store) { return store.clear_run(job.run); })) {
    }
  } catch (const db::DatabaseError& e) {
    // The damage concerns this run only; the next ones must not wait for it.
    if (e.trouble() != db::Trouble::Damaged) return false;
    end_later(job.run, failed(e));
    return true;
  }
  const double pace = job.batch->asked.pace;
  const experiment::Trial trial{.spec = spec_of(job)};
  std::shared_ptr<RunChannel> record;
  experiment::TrialOptions options{.stop = running.stop.get_token(), .pace = pace};
  options.record = [&](const algo::RobotSpec& robot) {
    record = recorder_.open(job.run, headless_run(trial.spec, robot, pace));
    return record;
  };
  options.cancelled = [&] {
    const std::lock_guard lock(mutex_);
    return running.cancelled;
  };
  try {
    run_trial(trial, options);
  } catch (const db::DatabaseError& e) {
    if (!record) return false;
    record->close(failed(e));
  } catch (const std::exception& e) {
    if (record) {
      record->close(failed(e));
    } else {
      end_later(job.run, failed(e));
    }
  }
  return true;
}

}  // namespace server
