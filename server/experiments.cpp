// server/experiments.cpp: the background worker.
#include "server/experiments.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/record_sink.hpp"
#include "server/run_json.hpp"

namespace server {

Experiments::Experiments(Recorder& recorder)
    : recorder_(recorder), worker_([this](const std::stop_token& stop) { work(stop); }) {}

Experiments::~Experiments() {
  worker_.request_stop();
  {
    const std::lock_guard lock(mutex_);
    stop_running_.request_stop();
  }
  wake_.notify_all();
}

void Experiments::start(Experiment experiment, Accepted accepted) {
  // A world that cannot be built is refused now, not in the background; its spec goes in the row.
  const algo::RobotSpec robot = make_robot(experiment.spec)->spec();
  recorder_.post([this, experiment = std::move(experiment), robot, accepted = std::move(accepted)](
                     db::RunStore& store) {
    std::vector<db::RunId> runs;
    std::deque<Job> jobs;
    try {
      for (std::uint32_t i = 0; i < experiment.repeats; ++i) {
        Job job{.spec = experiment.spec, .pace = experiment.pace};
        job.spec.seed = experiment.spec.seed + i;
        job.run = store.queue_run(new_run(job.spec, robot));
        runs.push_back(job.run);
        jobs.push_back(std::move(job));
      }
      store.commit();
    } catch (const std::exception& e) {
      accepted({}, e.what());
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      std::move(jobs.begin(), jobs.end(), std::back_inserter(queue_));
    }
    wake_.notify_all();
    accepted(std::move(runs), {});
  });
}

bool Experiments::cancel(db::RunId run) {
  const std::lock_guard lock(mutex_);
  if (running_ == run) {
    cancelled_ = true;
    stop_running_.request_stop();
    return true;
  }
  const auto it =
      std::find_if(queue_.begin(), queue_.end(), [run](const Job& job) { return job.run == run; });
  if (it == queue_.end()) return false;
  queue_.erase(it);
  recorder_.post([run](db::RunStore& store) {
    store.end_run(run, {.status = db::RunStatus::Cancelled, .outcome = "stopped"});
    store.commit();
  });
  return true;
}

std::size_t Experiments::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

void Experiments::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [this] { return !queue_.empty(); });
      if (stop.stop_requested()) return;
      job = std::move(queue_.front());
      queue_.pop_front();
      running_ = job.run;
      cancelled_ = false;
      stop_running_ = {};
    }
    execute(job);
    const std::lock_guard lock(mutex_);
    running_ = 0;
  }
}

void Experiments::execute(const Job& job) {
  HeadlessOptions options;
  options.pace = job.pace;
  try {
    options.record = recorder_.open(job.run, wall_time());
  } catch (const std::exception& e) {
    recorder_.post([run = job.run, why = std::string(e.what())](db::RunStore& store) {
      store.end_run(run, {.status = db::RunStatus::Failed, .outcome = "failed", .reason = why});
    });
    return;
  }
  std::stop_token stop;
  {
    const std::lock_guard lock(mutex_);
    stop = stop_running_.get_token();
  }
  options.cancelled = [this] {
    const std::lock_guard lock(mutex_);
    return cancelled_;
  };
  try {
    const auto robot = make_robot(job.spec);
    run_headless(job.spec, *robot, options, stop);
  } catch (const std::exception& e) {
    options.record->close(
        {.status = db::RunStatus::Failed, .outcome = "failed", .reason = e.what()});
  }
}

}  // namespace server
