// server/serve/live_run.cpp: advances a run and concludes it.
#include "server/serve/live_run.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "server/run/planning_thread.hpp"

namespace server {
namespace {

// Longest wait of simulated time for a slow store.
constexpr std::chrono::milliseconds kRecordPatience{200};
// [s] run clock without an event, after which a run's record pauses.
constexpr double kRecordPause = 5;
// Enough for a run at a few times real time; faster runs share the server's frames.
constexpr std::size_t kOwnFrames = 16;

/// A log is recorded to its end, even while it stands still.
RunPolicy live_policy(const RunSpec& spec, bool require_record) {
  return {.record_patience = kRecordPatience,
          .pause_record_after = spec.scenario.log.empty() ? kRecordPause : 0,
          .require_record = require_record};
}

algo::PipelineConfig live_config(const RunSpec& spec, const std::stop_source& stop) {
  algo::PipelineConfig config = pipeline_config(spec);
  config.run.stop = stop.get_token();
  config.thinker = [] { return std::make_unique<PlanningThread>(); };
  return config;
}

/// A real robot's loop allocates nothing and never waits for a frame.
std::shared_ptr<FramePool> frames_for(bool real, const RunHouse& house) {
  return real ? FramePool::make<EncodedFrame>(kPoolFrames)
              : FramePool::growing<EncodedFrame>(kOwnFrames, kPoolFrames, house.frames);
}

}  // namespace

LiveRun::LiveRun(RunSpec spec,
                 std::unique_ptr<algo::Robot> robot,
                 std::shared_ptr<RunChannel> channel,
                 const RunHouse& house,
                 OperatorWatch& watch,
                 std::function<void()> news)
    : spec_(std::move(spec)),
      robot_(std::move(robot)),
      arming_(robot_->arming()),
      own_thread_(arming_ != nullptr || drives_from_outside(spec_)),
      pipeline_(live_config(spec_, stop_), robot_->spec(), controllers_of(spec_)),
      channel_(std::move(channel)),
      sink_(channel_ ? std::make_unique<RecordSink>(channel_) : nullptr),
      scheduler_(house.scheduler),
      watch_(watch),
      pool_(frames_for(arming_ != nullptr, house)),
      run_(*robot_,
           pipeline_,
           live_policy(spec_, house.require_record),
           links(),
           stop_.get_token()) {
  rings.news = std::move(news);
}

RunLinks LiveRun::links() {
  RunLinks out{.pool = pool_.get(), .rings = &rings, .record = sink_.get(), .pacer = &pacer_};
  if (arming_ != nullptr) {
    out.listeners.emplace_back([this](const Frame& frame) { look_for_operator(frame.telemetry); });
  }
  out.on_outcome = [this](algo::Outcome outcome, const char* reason, const algo::Metrics& metrics) {
    {
      const std::lock_guard lock(mutex_);
      if (!verdict_ && outcome != algo::Outcome::Running) verdict_ = {outcome, reason, metrics};
    }
    outcome_.store(outcome, std::memory_order_relaxed);
  };
  return out;
}

void LiveRun::start(const std::vector<algo::Request>& first) {
  started_ = true;
  run_.begin(first);
  if (!own_thread_) {
    scheduler_.add(*this);
    return;
  }
  thread_ = std::jthread([this] {
    Run::Next next = LiveRun::advance();
    while (next.when != Run::Next::When::Over) {
      if (next.when != Run::Next::When::AtOnce) pacer_.sleep_until(next.time, stop_.get_token());
      next = LiveRun::advance();
    }
  });
}

Run::Next LiveRun::advance() {
  const Run::Next next = run_.advance();
  if (next.when == Run::Next::When::Over) conclude();
  return next;
}

void LiveRun::ask_to_end() {
  stop_.request_stop();
  wake();
}

void LiveRun::wake() {
  if (!own_thread_) scheduler_.wake(*this);
}

void LiveRun::set_pace(const Pace& pace) {
  pacer_.set(pace);
  wake();
}

LiveRun::~LiveRun() {
  ask_to_end();
  if (!own_thread_) scheduler_.remove(*this);
  if (thread_.joinable()) thread_.join();
  if (started_ && !finished()) conclude();
  rings.stream.consume_all([](const FrameRef&) {});
}

/// Called on the thread that advanced the run last.
void LiveRun::conclude() {
  result_ = run_.finish();
  if (result_.outcome == algo::Outcome::Running) result_.outcome = algo::Outcome::Stopped;
  // The run has ended. The base's own thread brakes the wheels and switches the motors off.
  if (arming_ != nullptr && arming_->epoch() != 0) {
    const std::string why = result_.reason.empty() ? "" : ": " + result_.reason;
    arming_->disarm("The motors are off, as the run ended" + (why.empty() ? "." : why));
  }
  outcome_.store(result_.outcome, std::memory_order_relaxed);
  if (channel_) {
    channel_->close(run_end(result_, cut_.load(std::memory_order_relaxed), verdict()),
                    result_.metrics.ticks);
  }
  finished_.store(true, std::memory_order_release);
  if (rings.news) rings.news();
}

void LiveRun::look_for_operator(const algo::Telemetry& t) {
  const char* why = watch_.why_disarm(arming_->epoch(), on_its_way(t), OperatorWatch::Clock::now());
  if (why != nullptr) arming_->disarm(why);
}

std::optional<FirstOutcome> LiveRun::verdict() const {
  const std::lock_guard lock(mutex_);
  return verdict_;
}

}  // namespace server
