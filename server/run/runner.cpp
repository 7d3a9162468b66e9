// server/run/runner.cpp: the control loop.
#include "server/run/runner.hpp"

#include <array>
#include <cmath>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace server {
namespace {

using algo::Outcome;
constexpr double kRounding = 1e-9;  // [s] by which a sum of periods may be less than their product
// Speeds that encoder noise alone can cause.
constexpr double kStandingSpeed = 0.01;  // [m/s]
constexpr double kStandingTurn = 0.02;   // [rad/s]
// Delay before a full ring or an empty pool is tried again.
constexpr std::chrono::microseconds kSoon{100};
constexpr std::chrono::milliseconds kPausedWait{50};

/// The error's sentence and the last known state of the robot.
std::string account_of(const algo::RobotError& error) {
  if (error.last.empty()) return error.what();
  const algo::Moment& last = error.last.back();
  return fmt::format(
      "{} It was last heard of at {:.2f} s, at ({:.2f}, {:.2f}), driving {:.2f} m/s "
      "and told {:.2f} m/s.",
      error.what(),
      last.stamp,
      last.pose_W.x,
      last.pose_W.y,
      last.twist.v,
      last.command.base.v);
}

/// Of the part in contact.
const char* touch_sentence(const algo::Telemetry& t) {
  static constexpr std::array<const char*, algo::kBodyLinks> kSentences{
      "The hull touched an obstacle.",
      "The arm's mast touched something.",
      "The upper arm touched something.",
      "The forearm touched something.",
      "The hand touched something."};
  const auto link = t.ground_truth ? t.ground_truth->touched : std::nullopt;
  return kSentences.at(static_cast<std::size_t>(link.value_or(algo::BodyLink::Base)));
}

}  // namespace

bool Stillness::lasts(const algo::Telemetry& t, double span) {
  const double now = t.observation.stamp;
  const algo::Twist2& twist = t.observation.odometry.twist;
  const bool moves = std::abs(twist.v) > kStandingSpeed || std::abs(twist.omega) > kStandingTurn ||
                     t.command.base != algo::Twist2{} ||
                     t.command.joint_rates != algo::Command{}.joint_rates;
  const bool event = moves || !t.requests.empty() || t.mission == algo::Mission::Driving ||
                     t.mission != mission_ || t.hold != hold_;
  mission_ = t.mission;
  hold_ = t.hold;
  if (event || now < since_) since_ = now;
  return span > 0 && now - since_ > span;
}

Run::Run(algo::Robot& robot,
         algo::Pipeline& pipeline,
         const RunPolicy& policy,
         RunLinks links,
         std::stop_token stop)
    : robot_(robot),
      arming_(robot.arming()),
      editing_(robot.editing()),
      pipeline_(pipeline),
      policy_(policy),
      links_(std::move(links)),
      stop_(std::move(stop)) {}

void Run::begin(const std::vector<algo::Request>& first) {
  metrics_.reset(robot_.spec());
  orders_.follow(pipeline_.intent());
  for (const algo::Request& request : first) accept(request);
  if (links_.pacer != nullptr) links_.pacer->restart();
}

Run::Next Run::advance() {
  constexpr Next kOver{.when = Next::When::Over};
  if (phase_ == Phase::Over || stop_.stop_requested()) return kOver;
  Next next = kOver;
  try {
    next = advance_phase();
  } catch (const algo::RobotError& e) {
    robot_.stop();
    set_outcome(Outcome::Failed, account_of(e).c_str());
  } catch (const std::exception& e) {
    robot_.stop();
    // A controller gives up its wait when the run is to end.
    if (!stop_.stop_requested()) set_outcome(Outcome::Failed, e.what());
  }
  if (next.when == Next::When::Over) phase_ = Phase::Over;
  return next;
}

Run::Next Run::advance_phase() {
  const Next soon{.when = Next::When::At, .time = Clock::now() + kSoon};
  if (phase_ == Phase::Reset) {
    frame_ = links_.pool->take();
    if (!frame_) return soon;
    pipeline_.want_grids(links_.rings != nullptr || links_.record != nullptr);
    robot_.reset(frame_->telemetry.observation);
    pipeline_.reset(frame_->telemetry.observation.odometry.pose);
    tick();
  } else if (phase_ == Phase::Step) {
    if (const auto later = step()) return *later;
    tick();
  } else {
    serve_requests();  // while time waits for the record
  }
  phase_ = Phase::Keep;
  if (!keep()) return soon;
  for (const Listener& listener : links_.listeners) listener(*frame_);
  if (over()) return {.when = Next::When::Over};
  phase_ = Phase::Step;
  return next_step();
}

/// The end of the period that begins now.
Run::Next Run::next_step() {
  if (arming_ != nullptr || links_.pacer == nullptr) return {};
  const Clock::time_point now = Clock::now();
  const auto due = links_.pacer->due(robot_.next_period(), now);
  if (!due) return {.when = Next::When::Asked, .time = now + kPausedWait};
  if (*due == Clock::time_point::min()) return {};
  return {.when = Next::When::At, .time = *due};
}

/// Advances the robot, or says when to try again if its time has not come or no frame is free.
/// Simulated time waits for a frame; a real robot's pool has more frames than all rings hold.
std::optional<Run::Next> Run::step() {
  FrameRef next = links_.pool->take();
  if (!next) return Next{.when = Next::When::At, .time = Clock::now() + kSoon};
  if (arming_ == nullptr && links_.pacer != nullptr &&
      !links_.pacer->pass(robot_.next_period(), Clock::now())) {
    if (!shown_) show();
    serve_requests();
    return next_step();
  }
  const algo::Telemetry& t = frame_->telemetry;
  // A real base brakes harder than by the ramp down to the zero command that follows. One that
  // could turn over by that gets commands on the way to zero.
  if (t.hold && arming_ != nullptr && t.command == algo::Command{}) robot_.stop();
  if (!robot_.step(t.command, next->telemetry.observation)) {
    const std::string reason = fmt::format("The log ended after {} scans.", t.tick + 1);
    set_outcome(Outcome::EndOfLog, reason.c_str());
    return Next{.when = Next::When::Over};
  }
  if (stop_.stop_requested()) return Next{.when = Next::When::Over};
  frame_ = std::move(next);
  return std::nullopt;
}

/// Runs the pipeline on the newest observation and publishes the frame.
void Run::tick() {
  algo::Telemetry& t = frame_->telemetry;
  now_ = t.observation.stamp;
  serve_requests();
  if (pipeline_.plan_ready()) accept(algo::TakePlan{});
  t.requests = pending_;
  pending_.clear();
  pipeline_.tick(t);
  orders_.follow(pipeline_.intent());
  t.ground_truth = robot_.ground_truth();
  robot_.find_moved(t.moved);
  metrics_.add(t, pipeline_.parameters());
  judge(t);
  waits_since_.reset();
  if (links_.rings == nullptr) return;
  show();
}

/// Where the ring is full, viewers miss a frame, but never the newest one at rest.
void Run::show() {
  shown_ = links_.rings->stream.push(frame_);
  news();
}

void Run::news() const {
  if (links_.rings->news) links_.rings->news();
}

void Run::serve_requests() {
  if (links_.rings == nullptr) return;
  notice_arming();
  const bool stop = links_.rings->stop_now.exchange(false);
  const std::size_t served = links_.rings->requests.consume_all([&](const Submission& submission) {
    notice_arming();
    std::optional<std::string> refusal = refusal_of(submission.request);
    if (!refusal) refusal = carry_out(submission.request);
    if (!refusal) accept(submission.request);
    links_.rings->replies.push({submission.ticket, std::move(refusal)});
  });
  if (stop) accept(algo::Stop{true});  // last: it was given after any release in the full ring
  if (served > 0) news();
}

/// Called before each request: the robot may have been disarmed and armed again since the last.
void Run::notice_arming() {
  if (arming_ != nullptr && orders_.notice(arming_->epoch())) void_orders();
}

/// Voids orders by requests of its own, so that the record has them and a replay repeats them.
void Run::void_orders() {
  if (orders_.stick()) accept(algo::Joystick{});
  if (!orders_.goal()) return;
  accept(algo::ClearGoal{});
  if (links_.rings == nullptr) return;
  links_.rings->replies.push({kGoalsCleared, std::nullopt});
  news();
}

/// Checks parameters against those accepted earlier, which the pipeline may not have seen yet.
std::optional<std::string> Run::refusal_of(const algo::Request& request) {
  if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    return pipeline_.refusal(orders_.asked().parameters, *set);
  }
  auto refusal = pipeline_.refusal(request);
  if (!refusal && arming_ != nullptr) refusal = orders_.refusal(request, now_);
  return refusal;
}

/// The robot carries out edits at once.
std::optional<std::string> Run::carry_out(const algo::Request& request) {
  if (const auto* at = std::get_if<algo::SetInitialPose>(&request)) {
    if (robot_.locating() == nullptr) return "This robot knows no map: start it with --map FILE.";
    robot_.locating()->place(*at);
  }
  if (!algo::is_edit(request)) return std::nullopt;
  if (editing_ != nullptr) return editing_->edit(request);
  return arming_ != nullptr ? "This is real hardware: obstacles are put in its way by hand."
                            : "A recorded log has no obstacles to add, move or remove.";
}

void Run::accept(const algo::Request& request) {
  pending_.push_back(request);
  const bool voided = orders_.accept(request);
  if (voided && arming_ != nullptr) void_orders();
}

/// Gives the newest tick to the record; false while simulated time waits for the record to take it.
bool Run::keep() {
  if (links_.record == nullptr) return true;
  const bool waiting = waits_since_.has_value();
  if (!waiting && stillness_.lasts(frame_->telemetry, policy_.pause_record_after)) {
    links_.record->pause();
    return true;
  }
  const bool taken = try_to_keep();
  if (!taken && waits_since_) return false;
  if (!taken) ++result_.lost_ticks;
  if (!policy_.require_record) return true;
  std::optional<std::string> failure = links_.record->failure();
  if (!taken && !failure) failure = "The record cannot keep up.";
  if (failure && !broken_) {
    robot_.stop();
    set_outcome(Outcome::Failed, failure->c_str());
    broken_ = true;
  }
  return true;
}

/// False with waits_since_ set: try again. False without it: the tick is lost.
bool Run::try_to_keep() {
  if (links_.record->push(frame_)) {
    waits_since_.reset();
    impatient_ = false;
    return true;
  }
  const Clock::time_point now = Clock::now();
  if (!waits_since_ && arming_ == nullptr && !impatient_) waits_since_ = now;
  if (!waits_since_) return false;
  impatient_ = policy_.record_patience && now - *waits_since_ >= *policy_.record_patience;
  const bool gives_up = policy_.require_record && links_.record->failure();
  if (impatient_ || gives_up) waits_since_.reset();
  return false;
}

/// `reason` is a C string: this is called every tick, and must not allocate.
void Run::set_outcome(Outcome outcome, const char* reason) {
  if (result_.outcome == outcome) return;
  result_.outcome = outcome;
  result_.reason = reason;
  if (links_.on_outcome) links_.on_outcome(outcome, reason, metrics_.metrics());
}

/// `what` has happened; the robot's own words say why it came no farther.
void Run::give_up(Outcome outcome, const char* what, const algo::Telemetry& t) {
  if (result_.outcome == outcome) return;
  std::string reason = what;
  if (!reason.empty() && !t.words.why.empty()) reason += ' ';
  reason += t.words.why;
  set_outcome(outcome, reason.c_str());
}

/// A robot that lies on its side or fell off an edge needs a reset, whatever comes after.
bool Run::wrecked() const {
  return result_.outcome == Outcome::Overturned || result_.outcome == Outcome::Fallen;
}

void Run::judge(const algo::Telemetry& t) {
  if (wrecked()) return;
  for (const algo::Request& request : t.requests) {
    const bool new_goal = std::holds_alternative<algo::SetGoal>(request) ||
                          std::holds_alternative<algo::SetHandGoal>(request) ||
                          std::holds_alternative<algo::Carry>(request);
    if (new_goal && !metrics_.metrics().collided) set_outcome(Outcome::Running);
  }
  if (t.ground_truth && t.ground_truth->overturned) {
    set_outcome(Outcome::Overturned, "The robot turned over. Reset sets it on its wheels again.");
  } else if (t.ground_truth && t.ground_truth->fallen) {
    set_outcome(Outcome::Fallen, "The robot drove off an edge. Reset sets it back to its start.");
  } else if (metrics_.metrics().collided) {
    set_outcome(Outcome::Collided, touch_sentence(t));
  } else if (t.mission == algo::Mission::Arrived) {
    set_outcome(Outcome::Reached);
  } else if (t.mission == algo::Mission::Stuck) {
    const bool hand = t.arm.state == algo::ArmState::GivenUp;
    give_up(Outcome::Stuck, hand ? "" : "The robot made no way towards its goal.", t);
  } else if (policy_.time_limit > 0 && t.observation.stamp >= policy_.time_limit - kRounding) {
    give_up(Outcome::OutOfTime, "The time limit was over before the goal was reached.", t);
  } else if (t.mission == algo::Mission::Driving) {
    set_outcome(Outcome::Running);
  }
}

bool Run::over() const {
  return broken_ || stop_.stop_requested() ||
         (policy_.until_outcome && result_.outcome != Outcome::Running);
}

RunResult Run::finish() {
  phase_ = Phase::Over;
  robot_.stop();
  frame_.reset();
  if (waits_since_) ++result_.lost_ticks;
  result_.metrics = metrics_.metrics();
  if (arming_ != nullptr) {
    result_.missed_periods = arming_->health().missed_periods;
  } else if (links_.pacer != nullptr) {
    result_.missed_periods = links_.pacer->missed();
  }
  return std::move(result_);
}

RunResult run(algo::Robot& robot,
              algo::Pipeline& pipeline,
              const std::vector<algo::Request>& first,
              const RunPolicy& policy,
              const RunLinks& links,
              const std::stop_token& stop) {
  Run one(robot, pipeline, policy, links, stop);
  one.begin(first);
  Run::Next next = one.advance();
  while (next.when != Run::Next::When::Over) {
    if (next.when != Run::Next::When::AtOnce) {
      if (links.pacer != nullptr) {
        links.pacer->sleep_until(next.time, stop);
      } else {
        std::this_thread::sleep_until(next.time);
      }
    }
    next = one.advance();
  }
  return one.finish();
}

}  // namespace server
