// server/run/runner.cpp: sense, decide, act, publish, once per period of the robot.
#include "server/run/runner.hpp"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <variant>

#include "server/run/fresh_orders.hpp"

namespace server {
namespace {

using algo::Outcome;
constexpr double kRounding = 1e-9;  // [s] a sum of periods may fall short of their product

/// How long nothing has happened: nobody asked for anything, and the robot neither drives nor
/// moves nor is held for another reason than before.
class Stillness {
 public:
  /// True when that has lasted longer than `span` [s] at `t`; never when `span` is 0.
  bool lasts(const algo::Telemetry& t, double span) {
    const double now = t.observation.stamp;
    const algo::Twist2& twist = t.observation.odometry.twist;
    const bool moves = std::abs(twist.v) > kStandingSpeed ||
                       std::abs(twist.omega) > kStandingTurn || t.command.base != algo::Twist2{};
    const bool event = moves || !t.requests.empty() || t.mission == algo::Mission::Driving ||
                       t.mission != mission_ || t.hold != hold_;
    mission_ = t.mission;
    hold_ = t.hold;
    if (event || now < since_) since_ = now;
    return span > 0 && now - since_ > span;
  }

 private:
  // What the noise of an encoder amounts to.
  static constexpr double kStandingSpeed = 0.01;  // [m/s]
  static constexpr double kStandingTurn = 0.02;   // [rad/s]
  double since_ = 0;                              // [s] of the last event
  algo::Mission mission_ = algo::Mission::Idle;
  algo::Hold hold_ = algo::Hold::None;
};

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
  void notice_arming();
  void void_orders();
  std::optional<std::string> refusal_of(const algo::Request& request);
  void accept(const algo::Request& request);
  void publish(const FrameRef& frame);
  bool record(const FrameRef& frame);
  bool push(const FrameRef& frame);
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
  FreshOrders orders_{};  // of a real robot
  double now_ = 0;        // [s] run clock, of the newest observation
  algo::MetricsRecorder metrics_{};
  RunResult result_{};
  Stillness stillness_{};
  bool impatient_ = false;  // the record kept a tick waiting too long and has taken none since
  bool broken_ = false;
};

bool is_real_time(const algo::RobotSpec& spec) {
  return !spec.paceable;
}

void Run::serve_requests() {
  if (links_.rings == nullptr) return;
  notice_arming();
  const bool stop = links_.rings->stop_now.exchange(false);
  links_.rings->requests.consume_all([&](const Submission& submission) {
    notice_arming();
    std::optional<std::string> refusal = refusal_of(submission.request);
    if (!refusal) refusal = robot_.edit(submission.request);
    if (!refusal) accept(submission.request);
    links_.rings->replies.push({submission.ticket, std::move(refusal)});
  });
  if (stop) accept(algo::Stop{true});  // last: a release in the full ring was given before it
}

/// Asked before each request: it may have been disarmed and armed again since the last.
void Run::notice_arming() {
  if (links_.arming && orders_.notice(links_.arming())) void_orders();
}

/// As requests of its own, so that the record has them and a replay does the same.
void Run::void_orders() {
  if (orders_.stick()) accept(algo::Joystick{});
  if (!orders_.goal()) return;
  accept(algo::ClearGoal{});
  if (links_.rings != nullptr) links_.rings->replies.push({kGoalsCleared, std::nullopt});
}

/// Parameters are checked against those accepted before, which the pipeline may not have seen yet.
std::optional<std::string> Run::refusal_of(const algo::Request& request) {
  if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    return pipeline_.refusal(accepted_, *set);
  }
  auto refusal = pipeline_.refusal(request);
  if (!refusal && links_.arming) refusal = orders_.refusal(request, now_);
  return refusal;
}

void Run::accept(const algo::Request& request) {
  pending_.push_back(request);
  if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    accepted_.set(*set->parameter, set->value);
  }
  if (links_.arming && orders_.accept(request)) void_orders();
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

/// True unless the tick was lost.
bool Run::record(const FrameRef& frame) {
  const algo::Telemetry& t = frame->telemetry;
  if (stillness_.lasts(t, policy_.pause_record_after)) {
    links_.record->pause();
    return true;
  }
  const bool taken = push(frame);
  if (!policy_.require_record) return taken;
  std::optional<std::string> failure = links_.record->failure();
  if (!taken && !failure) failure = "The record cannot keep up.";
  if (failure && !broken_) {
    robot_.stop();
    set_outcome(Outcome::Failed, failure->c_str());
    broken_ = true;
  }
  return taken;
}

bool Run::push(const FrameRef& frame) {
  using Clock = std::chrono::steady_clock;
  if (links_.record->push(frame)) {
    impatient_ = false;
    return true;
  }
  if (is_real_time(robot_.spec()) || impatient_) return false;
  const auto begun = Clock::now();
  do {
    impatient_ = policy_.record_patience && Clock::now() - begun >= *policy_.record_patience;
    if (impatient_ || stop_.stop_requested()) return false;
    if (policy_.require_record && links_.record->failure()) return false;
    serve_requests();
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  } while (!links_.record->push(frame));
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
    pipeline_.want_grids(links_.rings != nullptr || links_.record != nullptr);
    robot_.reset(frame->telemetry.observation);
    pipeline_.reset(frame->telemetry.observation.odometry.pose);
    while (true) {
      algo::Telemetry& t = frame->telemetry;
      now_ = t.observation.stamp;
      serve_requests();
      t.requests = pending_;
      pending_.clear();
      pipeline_.tick(t);
      t.ground_truth = robot_.ground_truth();
      robot_.find_moved(t.moved);
      metrics_.add(t, pipeline_.parameters());
      judge(t);
      publish(frame);
      if (over()) break;

      FrameRef next = next_frame();
      if (!next) break;
      // A real base brakes harder than along the driving ramp to the zero that follows.
      if (t.hold != algo::Hold::None && is_real_time(robot_.spec())) robot_.stop();
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
