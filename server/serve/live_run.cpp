// server/serve/live_run.cpp: the control thread of a session's run.
#include "server/serve/live_run.hpp"

#include <chrono>
#include <utility>

#include "drivers/serial_robot.hpp"
#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"

namespace server {
namespace {

// What simulated time waits for a store that is slow.
constexpr std::chrono::milliseconds kRecordPatience{200};
// [s] run clock: the record of a run in which nothing happens pauses after so long.
constexpr double kRecordPause = 5;

/// A log is played to its end, its standstills included.
RunPolicy live_policy(const RunSpec& spec, bool require_record) {
  return {.record_patience = kRecordPatience,
          .pause_record_after = spec.scenario.log.empty() ? kRecordPause : 0,
          .require_record = require_record};
}

}  // namespace

LiveRun::LiveRun(RunSpec spec,
                 std::unique_ptr<algo::Robot> robot,
                 std::shared_ptr<RunChannel> channel,
                 OperatorWatch& watch,
                 bool require_record)
    : spec_(std::move(spec)),
      robot_(std::move(robot)),
      pipeline_(pipeline_config(spec_), robot_->spec()),
      channel_(std::move(channel)),
      watch_(watch),
      pool_(FramePool::make<EncodedFrame>(kPoolFrames)),
      policy_(live_policy(spec_, require_record)) {}

void LiveRun::start(std::vector<algo::Request> first) {
  first_ = std::move(first);
  thread_ = std::jthread([this](const std::stop_token& stop) { control(stop); });
}

void LiveRun::ask_to_end() {
  thread_.request_stop();
  robot_->set_pace({.paused = false, .speed = 0});  // wakes a robot that waits for its time
}

LiveRun::~LiveRun() {
  ask_to_end();
  if (thread_.joinable()) thread_.join();
  rings.stream.consume_all([](const FrameRef&) {});
}

void LiveRun::control(const std::stop_token& stop) {
  std::unique_ptr<RecordSink> sink;
  if (channel_) sink = std::make_unique<RecordSink>(channel_);
  RunLinks links;
  links.pool = pool_.get();
  links.rings = &rings;
  links.record = sink.get();
  if (spec_.hardware) {
    links.arming = [this] { return spec_.hardware->arming(); };
    links.observer = [this](const Frame& frame) { look_for_operator(frame.telemetry); };
  }
  links.on_outcome = [this](algo::Outcome outcome, const algo::Metrics& metrics) {
    {
      const std::lock_guard lock(mutex_);
      metrics_ = metrics;
    }
    outcome_.store(outcome, std::memory_order_relaxed);
  };
  result_ = run(*robot_, pipeline_, first_, policy_, links, stop);
  if (result_.outcome == algo::Outcome::Running) result_.outcome = algo::Outcome::Stopped;
  // Nobody looks after it any more; the base's own thread brakes it and cuts its motors off.
  if (spec_.hardware && spec_.hardware->arming() != 0) {
    const std::string why = result_.reason.empty() ? "" : ": " + result_.reason;
    spec_.hardware->disarm("The motors are off, as the run ended" + (why.empty() ? "." : why));
  }
  outcome_.store(result_.outcome, std::memory_order_relaxed);
  if (channel_) {
    channel_->close(run_end(result_, cut_.load(std::memory_order_relaxed)), result_.metrics.ticks);
  }
  finished_.store(true, std::memory_order_release);
}

void LiveRun::look_for_operator(const algo::Telemetry& t) {
  drivers::SerialRobot& robot = *spec_.hardware;
  const char* why = watch_.why_disarm(robot.arming(), on_its_way(t), OperatorWatch::Clock::now());
  if (why != nullptr) robot.disarm(why);
}

algo::Metrics LiveRun::metrics() const {
  const std::lock_guard lock(mutex_);
  return metrics_;
}

}  // namespace server
