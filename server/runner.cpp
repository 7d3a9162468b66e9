// server/runner.cpp: sense, decide, act, publish, once per period of the robot.
#include "server/runner.hpp"

#include <chrono>
#include <thread>
#include <utility>
#include <variant>

namespace server {
namespace {

using algo::Outcome;
constexpr double kRounding = 1e-9;  // [s] a sum of periods may fall short of their product

/// One run in progress. Lives on the control thread.
class Run {
 public:
  Run(algo::Robot& robot,
      algo::Pipeline& pipeline,
      const RunPolicy& policy,
      const RunLinks& links,
      const std::stop_token& stop)
      : robot_(robot), pipeline_(pipeline), policy_(policy), links_(links), stop_(stop) {}

  RunResult execute(const std::vector<algo::Request>& first);

 private:
  void serve_requests();
  std::optional<std::string> refusal_of(const algo::Request& request) const;
  void accept(const algo::Request& request);
  void publish(const FrameRef& frame);
  bool record(const FrameRef& frame);
  void judge(const algo::Telemetry& t);
  void set_outcome(Outcome outcome, const char* reason = "");
  FrameRef next_frame();
  void step_into(const algo::Command& command, FrameRef& next);
  bool over() const;

  algo::Robot& robot_;
  algo::Pipeline& pipeline_;
  const RunPolicy& policy_;
  const RunLinks& links_;
  const std::stop_token& stop_;
  algo::Recycled<algo::Request> pending_{};  // accepted, for the next tick's record
  algo::Parameters accepted_{};
  algo::MetricsRecorder metrics_{};
  RunResult result_{};
  bool broken_ = false;
};

bool is_real_time(const algo::RobotSpec& spec) {
  return !spec.paceable;
}

void Run::serve_requests() {
  if (links_.rings == nullptr) return;
  if (links_.rings->stop_now.exchange(false)) accept(algo::Stop{true});
  links_.rings->requests.consume_all([&](const Submission& submission) {
    std::optional<std::string> refusal = refusal_of(submission.request);
    if (!refusal) refusal = robot_.edit(submission.request);
    if (!refusal) accept(submission.request);
    links_.rings->replies.push({submission.ticket, std::move(refusal)});
  });
}

/// Parameters are checked against those accepted before, which the pipeline may not have seen yet.
std::optional<std::string> Run::refusal_of(const algo::Request& request) const {
  if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    return algo::refusal(accepted_, set->parameter, set->value);
  }
  return pipeline_.refusal(request);
}

void Run::accept(const algo::Request& request) {
  pending_.push_back(request);
  if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    accepted_.set(set->parameter, set->value);
  }
}

/// A simulated robot's time waits for a free frame; a real one's cannot, so that tick gets none.
FrameRef Run::next_frame() {
  FrameRef frame = links_.pool->take();
  while (!frame && !stop_.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    frame = links_.pool->take();
  }
  return frame;
}

void Run::publish(const FrameRef& frame) {
  if (links_.rings != nullptr) links_.rings->stream.push(frame);  // full: one frame is not shown
  if (links_.record != nullptr && !record(frame)) ++result_.lost_ticks;
  if (links_.observer) links_.observer(*frame);
}

bool Run::record(const FrameRef& frame) {
  while (!links_.record->push(frame)) {
    if (is_real_time(robot_.spec()) || stop_.stop_requested()) return false;
    if (auto failure = links_.record->failure()) {
      robot_.stop();
      set_outcome(Outcome::Failed, failure->c_str());
      broken_ = true;
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  if (auto failure = links_.record->failure()) {
    robot_.stop();
    set_outcome(Outcome::Failed, failure->c_str());
    broken_ = true;
  }
  return true;
}

/// Called every tick with the same words: a C string, so that nothing is allocated meanwhile.
void Run::set_outcome(Outcome outcome, const char* reason) {
  if (result_.outcome == outcome) return;
  result_.outcome = outcome;
  result_.reason = reason;
  if (links_.on_outcome) links_.on_outcome(outcome, metrics_.metrics());
}

void Run::judge(const algo::Telemetry& t) {
  for (const algo::Request& request : t.requests) {
    const bool new_goal = std::holds_alternative<algo::SetGoal>(request);
    if (new_goal && !metrics_.metrics().collided) set_outcome(Outcome::Running);
  }
  if (metrics_.metrics().collided) {
    set_outcome(Outcome::Collided, "The hull touched an obstacle.");
  } else if (t.mission == algo::Mission::Arrived) {
    set_outcome(Outcome::Reached);
  } else if (t.mission == algo::Mission::Stuck) {
    set_outcome(Outcome::Stuck, "The robot made no way towards its goal.");
  } else if (policy_.time_limit > 0 && t.observation.stamp >= policy_.time_limit - kRounding) {
    set_outcome(Outcome::OutOfTime, "The time limit was over before the goal was reached.");
  } else if (t.mission == algo::Mission::Driving) {
    set_outcome(Outcome::Running);
  }
}

bool Run::over() const {
  return broken_ || stop_.stop_requested() ||
         (policy_.until_outcome && result_.outcome != Outcome::Running);
}

void Run::step_into(const algo::Command& command, FrameRef& next) {
  while (!robot_.step(command, next->telemetry.observation)) {  // paused
    serve_requests();
    if (stop_.stop_requested()) return;
  }
}

RunResult Run::execute(const std::vector<algo::Request>& first) {
  metrics_.reset(robot_.spec());
  accepted_ = pipeline_.parameters();
  for (const algo::Request& request : first) accept(request);
  try {
    FrameRef frame = next_frame();
    if (!frame) return result_;
    robot_.reset(frame->telemetry.observation);
    pipeline_.reset(frame->telemetry.observation.odometry.pose);
    while (true) {
      algo::Telemetry& t = frame->telemetry;
      serve_requests();
      t.requests = pending_;
      pending_.clear();
      pipeline_.tick(t);
      t.ground_truth = robot_.ground_truth();
      metrics_.add(t, pipeline_.parameters());
      judge(t);
      publish(frame);
      if (over()) break;

      FrameRef next = next_frame();
      if (!next) break;
      step_into(t.command, next);  // returns at the robot's next deadline with the newest data
      if (stop_.stop_requested()) break;
      frame = std::move(next);
    }
  } catch (const algo::EndOfLog& e) {
    set_outcome(Outcome::EndOfLog, e.what());
  } catch (const std::exception& e) {
    robot_.stop();
    set_outcome(Outcome::Failed, e.what());
  }
  robot_.stop();
  result_.metrics = metrics_.metrics();
  result_.missed_periods = robot_.missed_periods();
  return result_;
}

}  // namespace

RunResult run(algo::Robot& robot,
              algo::Pipeline& pipeline,
              const std::vector<algo::Request>& first,
              const RunPolicy& policy,
              const RunLinks& links,
              const std::stop_token& stop) {
  return Run(robot, pipeline, policy, links, stop).execute(first);
}

}  // namespace server
