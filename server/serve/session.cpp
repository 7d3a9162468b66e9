// server/serve/session.cpp: the io thread's side of a run.
#include "server/serve/session.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "server/record/run_json.hpp"
#include "server/run/hardware.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/request_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/goal_check.hpp"
#include "sim/fleet.hpp"

namespace server {
namespace {

constexpr std::size_t kMaxPending = 900;  // fewer than the ring of replies can hold
constexpr double kAtRest = 0.01;          // [m/s], [rad/s] below what odometry resolves
constexpr std::chrono::milliseconds kFresh{500};

/// Whether people set or clear goals with it; the stick clears them too, but sets none.
bool is_goal(const algo::Request& request) {
  return std::holds_alternative<algo::SetGoal>(request) ||
         std::holds_alternative<algo::AddGoal>(request) ||
         std::holds_alternative<algo::SetGoals>(request) ||
         std::holds_alternative<algo::ClearGoal>(request) ||
         std::holds_alternative<algo::SetHandGoal>(request) ||
         std::holds_alternative<algo::Carry>(request);
}

bool has_goal(const algo::Intent& asked) {
  return asked.goal || asked.hand_goal || asked.carry_goal;
}

}  // namespace

Session::Session(const RunHouse& house, std::function<void()> news)
    : house_(house), recorder_(house.recorder), news_(std::move(news)) {
  state_.record.sentence = "This server keeps no record.";
  if (recorder_ != nullptr) state_.record = recorder_->status();
}

PreparedRun Session::prepare(RunSpec spec) {
  RunSpec first = spec;
  if (const auto begin_W = std::exchange(spec.begin_W, std::nullopt)) {
    first.scenario.start = *begin_W;
  }
  std::unique_ptr<algo::Robot> robot = make_robot(first);
  std::shared_ptr<RunChannel> channel;
  if (recorder_ != nullptr) channel = recorder_->begin(new_run(first, robot->spec()));
  auto live = std::make_unique<LiveRun>(
      std::move(first), std::move(robot), std::move(channel), house_, watch_, news_);
  return {std::move(spec), std::move(live)};
}

void Session::load(RunSpec spec) {
  PreparedRun next = prepare(std::move(spec));  // may throw: nothing has changed yet
  end();
  begin(std::move(next));
}

void Session::begin(PreparedRun next) {
  const RunSpec& spec = next.spec;
  const bool stopped = state_.asked.stop;
  state_.robot = next.live->robot().spec();
  state_.editable = next.live->robot().editing() != nullptr;
  state_.asked = {.parameters = spec.parameters, .obstacles = spec.scenario.obstacles};
  state_.others = sim::other_robots(spec.scenario);
  state_.outcome = algo::Outcome::Running;
  state_.lost_ticks = 0;
  state_.missed_periods = 0;
  state_.problem.reset();
  state_.hardware.reset();
  state_.running = true;
  path_.clear();
  newest_.reset();
  newest_scan_.reset();
  told_mission_ = algo::Mission::Idle;
  told_hold_ = {};
  next_obstacle_ = 1;
  credits.goal.clear();  // the scenario's own

  std::vector<algo::Request> first = first_requests(spec);
  if (spec.scenario.loop) first = {route_of(spec.scenario)};
  if (stopped) first.emplace_back(algo::Stop{true});
  for (const algo::Request& request : first) state_.asked.apply(request);
  note_goals();
  state_.spec = spec;
  if (saved_.name != spec.scenario.name) saved_ = spec.scenario;
  note_edits();
  live_ = std::move(next.live);
  live_->set_pace(state_.pace);
  live_->start(first);
  changed();
}

std::unique_ptr<LiveRun> Session::part() {
  if (!live_) return nullptr;
  live_->ask_to_end();
  newest_.reset();
  newest_scan_.reset();
  state_.running = false;
  std::unique_ptr<LiveRun> last = std::move(live_);
  answer_the_rest();
  return last;
}

void Session::end(bool cut) {
  if (live_ && cut) live_->cut();
  part().reset();
}

/// Answers the requests that the run left unanswered, so that no client waits for ever.
void Session::answer_the_rest() {
  const std::map<std::uint64_t, Pending> rest = std::exchange(pending_, {});
  for (const auto& [ticket, pending] : rest) {
    if (!pending.answer) continue;
    if (std::holds_alternative<algo::Stop>(pending.request) && ticket > stop_ticket_) {
      state_.asked.apply(pending.request);  // a release
      pending.answer(std::nullopt);
    } else {
      pending.answer("The run ended before this could be done.");
    }
  }
}

/// An id used by no obstacle, present or on its way. Ids of removed obstacles come last.
std::uint32_t Session::free_obstacle_id() {
  const auto taken = [this](std::uint32_t id) {
    const auto on_its_way = [id](const auto& entry) {
      const auto* add = std::get_if<algo::AddObstacle>(&entry.second.request);
      return add != nullptr && add->obstacle.id == id;
    };
    return std::any_of(state_.asked.obstacles.begin(),
                       state_.asked.obstacles.end(),
                       [id](const auto& o) { return o.id == id; }) ||
           std::any_of(pending_.begin(), pending_.end(), on_its_way);
  };
  std::uint32_t id = next_obstacle_;
  while (taken(id)) id = id % kMaxObstacleId + 1;
  next_obstacle_ = id % kMaxObstacleId + 1;
  return id;
}

std::optional<std::uint32_t> Session::submit(algo::Request request, Answer answer) {
  std::uint32_t id = 0;
  if (auto* add = std::get_if<algo::AddObstacle>(&request)) {
    if (add->obstacle.id == 0) add->obstacle.id = free_obstacle_id();
    id = add->obstacle.id;
  }
  const bool stop = is_stop(request);
  const bool release = !stop && std::holds_alternative<algo::Stop>(request);
  const std::uint64_t ticket = next_ticket_++;
  if (stop) {
    engage_stop(ticket, answer);
    return id;
  }
  if (!live_ || live_->finished()) {
    if (release) {
      state_.asked.apply(request);
      changed();
    }
    if (answer && release) answer(std::nullopt);
    if (answer && !release) answer("The run is over. Reset or load a scenario first.");
    return id;
  }
  // A Stop that found the ring full follows all its requests; nothing may come in between.
  if (release && live_->rings.stop_now.load()) return std::nullopt;
  if (pending_.size() >= kMaxPending || !live_->rings.requests.push({ticket, request})) {
    return std::nullopt;
  }
  pending_.emplace(ticket, Pending{std::move(request), std::move(answer)});
  live_->wake();
  return id;
}

void Session::engage_stop(std::uint64_t ticket, const Answer& answer) {
  stop_ticket_ = ticket;
  if (live_ && !live_->rings.requests.push({ticket, algo::Stop{true}})) {
    live_->rings.stop_now.store(true);
  }
  if (live_) live_->wake();
  const bool news = !std::exchange(state_.asked.stop, true);
  if (answer) answer(std::nullopt);  // before clients are told: Stop waits for nothing
  if (news) changed();
}

bool Session::standing() const {
  if (!newest_) return false;
  // For real devices an old tick proves nothing.
  const auto age = std::chrono::steady_clock::now() - newest_came_;
  if (state_.spec.hardware && age > kFresh) return false;
  const algo::Telemetry& t = newest_->telemetry;
  const algo::Twist2& moving = t.observation.odometry.twist;
  return t.command.base == algo::Twist2{} && std::abs(moving.v) < kAtRest &&
         std::abs(moving.omega) < kAtRest;
}

void Session::apply_pace() {
  if (live_) live_->set_pace(state_.pace);
  state_.pace.single_steps = 0;
  changed();
}

std::optional<std::string> Session::arm(bool on, const std::string& who) {
  if (!state_.spec.hardware) return "This robot is simulated: it has no motors to switch on.";
  algo::Arming& motors = *state_.spec.hardware->robot->arming();
  std::optional<std::string> refusal;
  if (!on) {
    arm_when_ready_ = false;
    motors.disarm(who + " has disarmed it.");
  } else if (!state_.running) {
    refusal = "The run is over. Reset first.";
  } else {
    refusal = motors.arm();
  }
  if (!refusal) {
    credits.arming = who;
    log(LogLevel::Warning, who + (on ? " has armed the motors." : " has disarmed the motors."));
  }
  state_.hardware = motors.health();
  note_arming(state_.hardware->armed, who + " has disarmed it.");
  changed();
  return refusal;
}

algo::Publishing* Session::publishing() const {
  return state_.spec.hardware ? state_.spec.hardware->robot->publishing() : nullptr;
}

std::optional<std::string> Session::pace_refusal() const {
  if (state_.spec.hardware == nullptr) return std::nullopt;
  return "This robot is real: its time cannot be paused, stepped or sped up. Press Stop to stop "
         "it.";
}

void Session::pause(bool paused) {
  state_.pace.paused = paused;
  apply_pace();
}

void Session::set_speed(double times_real_time) {
  state_.pace.speed = times_real_time;
  apply_pace();
}

void Session::single_step(std::uint32_t ticks) {
  state_.pace.paused = true;
  state_.pace.single_steps = ticks;
  apply_pace();
}

void Session::poll() {
  count_watchers();
  watch_lease();
  watch_record();
  if (!live_) return;
  drain_replies();
  drain_frames();
  watch_run();
  watch_hardware();
}

/// The store's fill level changes at every commit. Clients are told only of other changes.
void Session::watch_record() {
  if (recorder_ == nullptr || recorder_->revision() == record_seen_) return;
  record_seen_ = recorder_->revision();
  if (house_.tells_record_news) {
    for (const std::string& news : recorder_->take_news()) log(LogLevel::Warning, news);
  }
  RecordStatus mine = live_ ? live_->record_status() : RecordStatus{};
  if (mine.kind == RecordKind::Off) mine = recorder_->status();
  const RecordStatus was = std::exchange(state_.record, std::move(mine));
  const RecordStatus& now = state_.record;
  if (was.kind != now.kind || was.sentence != now.sentence || was.deleted != now.deleted) changed();
}

/// Tells clients at once of changes that move or stop the robot, and of others once a second.
void Session::watch_hardware() {
  using std::chrono::milliseconds;
  const auto now = std::chrono::steady_clock::now();
  if (!state_.spec.hardware || now - hardware_seen_ < milliseconds(100)) return;
  hardware_seen_ = now;
  algo::HealthReport report = state_.spec.hardware->robot->arming()->health();
  note_arming(report.armed, report.trouble);
  if (arm_when_ready_ && report.halt == algo::Halt::Disarmed) {
    arm_when_ready_ = false;
    if (const auto refusal = arm(true, "The option --armed")) log(LogLevel::Warning, *refusal);
    return;
  }
  const bool news = !state_.hardware || state_.hardware->armed != report.armed ||
                    state_.hardware->halt != report.halt;
  if (news && !report.trouble.empty()) log(LogLevel::Warning, report.trouble);
  if (!news && now - hardware_told_ < milliseconds(1000)) return;
  hardware_told_ = now;
  state_.hardware = std::move(report);
  changed();
}

/// Keeps the sentence of a disarming: the trouble may be over, or another, when somebody comes.
void Session::note_arming(bool armed, const std::string& why) {
  if (armed) state_.disarming.reset();
  // Without a sentence the tick that explains it is still to come.
  const bool disarmed = was_armed_ && !armed && !why.empty();
  if (disarmed) state_.disarming = {why, wall_time()};
  was_armed_ = armed || (was_armed_ && !disarmed);
}

void Session::count_viewers(std::size_t viewers) {
  state_.viewers = viewers;
  changed();
}

void Session::count_watchers() {
  const Watchers watchers = watch_.watchers(OperatorWatch::Clock::now());
  if (watchers == state_.watchers) return;
  state_.watchers = watchers;
  changed();
}

void Session::drain_replies() {
  bool different = false;
  live_->rings.replies.consume_all([&](const Reply& reply) {
    if (reply.ticket == kGoalsCleared) {
      state_.asked.apply(algo::ClearGoal{});
      log(LogLevel::Info, "The goals are cleared: the robot was disarmed or stopped.");
      different = true;
      return;
    }
    const auto it = pending_.find(reply.ticket);
    if (it == pending_.end()) return;
    const Pending pending = std::move(it->second);
    pending_.erase(it);
    if (reply.refusal) {
      // Stick requests come many times a second; only their sender is told.
      const bool stick = std::holds_alternative<algo::Joystick>(pending.request);
      if (!stick) log(LogLevel::Warning, "Refused: " + *reply.refusal);
    } else if (!std::holds_alternative<algo::Stop>(pending.request) ||
               reply.ticket > stop_ticket_) {  // a release from before the newest Stop is void
      adopt(pending.request);
      different = different || !std::holds_alternative<algo::Joystick>(pending.request);
    }
    if (pending.answer) pending.answer(reply.refusal);
  });
  if (different) changed();
}

/// Applies a request that the control thread has accepted to the mirror of its state.
void Session::adopt(const algo::Request& request) {
  const bool had_goal = has_goal(state_.asked);
  state_.asked.apply(request);
  if (is_goal(request)) note_goals();
  if (is_goal(request) || algo::is_edit(request)) note_edits();
  const bool stick = std::holds_alternative<algo::Joystick>(request);
  if (stick && had_goal && !state_.asked.goal && !state_.asked.hand_goal)
    changed();  // taking the stick cancels the goals
}

/// Advances the mirror's goal when the robot has moved on. A frame may be older than the newest
/// requests.
void Session::follow_goal(const algo::Telemetry& t) {
  algo::Intent& asked = state_.asked;
  if (!t.goal || t.goal == asked.goal) return;
  if (std::ranges::count(asked.goals_ahead, *t.goal) == 0 &&
      (!asked.loop || std::ranges::count(asked.goals_behind, *t.goal) == 0)) {
    return;
  }
  while (asked.goal != t.goal) asked.go_on();
  log(LogLevel::Info, "A waypoint is reached; the next goal is set.");
  changed();
}

void Session::drain_frames() {
  FrameRef latest;
  live_->rings.stream.consume_all([&](const FrameRef& frame) {
    const algo::Telemetry& t = frame->telemetry;
    const algo::Pose2& pose = t.ground_truth ? t.ground_truth->pose : t.observation.odometry.pose;
    path_.add(pose);
    narrate(t);
    follow_goal(t);
    if (t.scene.fresh) newest_scan_ = frame;
    latest = frame;
  });
  if (!latest) return;
  newest_ = latest;
  newest_came_ = std::chrono::steady_clock::now();
  if (on_frame) on_frame(latest);
}

/// Logs each change of hold and mission once.
void Session::narrate(const algo::Telemetry& t) {
  if (t.hold == told_hold_ && t.mission == told_mission_) return;
  const bool held = t.hold && t.hold != told_hold_;
  const bool notable = t.mission != told_mission_ &&
                       (t.mission == algo::Mission::Arrived || t.mission == algo::Mission::Stuck);
  told_hold_ = t.hold;
  told_mission_ = t.mission;
  if (!held && !notable) return;
  log(held || t.mission == algo::Mission::Stuck ? LogLevel::Warning : LogLevel::Info,
      t.words.what + ". " + t.words.why);
}

void Session::watch_run() {
  const bool ended = state_.running && live_->finished();
  const algo::Outcome outcome = ended ? live_->result().outcome : live_->outcome();
  if (ended) {
    state_.running = false;
    drain_replies();
    answer_the_rest();
    state_.lost_ticks = live_->result().lost_ticks;
    state_.missed_periods = live_->result().missed_periods;
    if (outcome == algo::Outcome::Failed) {
      state_.problem = live_->result().reason;
      log(LogLevel::Error, "The run broke off: " + live_->result().reason);
    }
  }
  if (ended || outcome != state_.outcome) {
    state_.outcome = outcome;
    // The row gets the outcome so far at once, even if the run goes on.
    if (!ended && recorder_ != nullptr && live_->id() != 0) {
      recorder_->post(
          [run = live_->id(), row = run_verdict(live_->verdict(), outcome)](db::RunStore& store) {
            if (store.recording(run)) store.set_result(run, row);
          });
    }
    changed();
  }
}

std::optional<std::string> Session::trouble_with(const algo::Request& request) {
  constexpr int kShare = 10;  // goal checks take a tenth of this thread's time
  if (const auto* given = std::get_if<algo::SetInitialPose>(&request)) {
    const bool drawn = given->pose_W && state_.spec.map && state_.spec.map->space;
    return drawn ? pose_trouble(*state_.spec.map->space, *given->pose_W) : std::nullopt;
  }
  const auto* add = std::get_if<algo::AddGoal>(&request);
  const auto* asked = add != nullptr ? &add->goal : std::get_if<algo::SetGoal>(&request);
  if (const auto* list = std::get_if<algo::SetGoals>(&request)) {
    if (!list->goals.empty()) asked = &list->goals[list->next];
  }
  if (asked == nullptr || !may_look_at_goals()) return std::nullopt;
  const auto began = std::chrono::steady_clock::now();
  std::optional<std::string> trouble = trouble_with_goal(*asked);
  const auto ended = std::chrono::steady_clock::now();
  next_look_ = ended + (kShare - 1) * (ended - began);
  return trouble;
}

std::optional<std::string> Session::trouble_with_goal(const algo::SetGoal& goal) const {
  if (state_.spec.hardware) {
    if (!newest_scan_) return std::nullopt;
    const algo::Telemetry& t = newest_scan_->telemetry;
    return goal_trouble(state_.robot, goal, t.observation.odometry.pose, t.scene.scan);
  }
  if (!newest_) return std::nullopt;
  std::vector<algo::Obstacle> standing;
  std::ranges::copy_if(state_.asked.obstacles,
                       std::back_inserter(standing),
                       [](const algo::Obstacle& obstacle) { return !obstacle.path; });
  const algo::Telemetry& t = newest_->telemetry;
  const algo::Pose2& pose = t.ground_truth ? t.ground_truth->pose : t.observation.odometry.pose;
  return goal_trouble(state_.robot, goal, pose, standing);
}

std::vector<algo::Obstacle> Session::obstacles() const {
  std::vector<algo::Obstacle> all = state_.asked.obstacles;
  all.insert(all.end(), state_.others.begin(), state_.others.end());
  return all;
}

algo::LatenessHistogram Session::lateness() const {
  return live_ ? live_->lateness() : algo::LatenessHistogram{};
}

void Session::changed() const {
  if (on_change) on_change();
}

void Session::log(LogLevel level, const std::string& text) const {
  if (on_log) on_log(level, text);
}

}  // namespace server
