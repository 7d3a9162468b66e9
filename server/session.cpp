// server/session.cpp: the io thread's side of a run.
#include "server/session.hpp"

#include <algorithm>
#include <chrono>
#include <type_traits>
#include <utility>
#include <variant>

#include "algo/explain.hpp"
#include "server/record_sink.hpp"
#include "server/run_json.hpp"
#include "server/scenario_json.hpp"

namespace server {
namespace {

constexpr std::size_t kMaxPending = 900;     // fewer than the ring of replies holds
constexpr double kPathSpacing = 0.02;        // [m]
constexpr std::size_t kPathPoints = 20'000;  // then every second one goes

}  // namespace

LiveRun::LiveRun(RunSpec spec,
                 std::unique_ptr<algo::Robot> robot,
                 std::vector<algo::Request> first,
                 std::shared_ptr<RunChannel> channel)
    : spec_(std::move(spec)),
      robot_(std::move(robot)),
      pipeline_(pipeline_config(spec_), robot_->spec()),
      first_(std::move(first)),
      channel_(std::move(channel)),
      pool_(FramePool::make(kPoolFrames)),
      thread_([this](const std::stop_token& stop) { control(stop); }) {}

LiveRun::~LiveRun() {
  thread_.request_stop();
  robot_->set_pace({.paused = false, .speed = 0});  // wakes a robot that waits for its time
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
  links.on_outcome = [this](algo::Outcome outcome, const algo::Metrics& metrics) {
    {
      const std::lock_guard lock(mutex_);
      metrics_ = metrics;
    }
    outcome_.store(outcome, std::memory_order_relaxed);
  };
  result_ = run(*robot_, pipeline_, first_, {}, links, stop);
  if (result_.outcome == algo::Outcome::Running) result_.outcome = algo::Outcome::Stopped;
  outcome_.store(result_.outcome, std::memory_order_relaxed);
  if (channel_) channel_->close(run_end(result_));
  finished_.store(true, std::memory_order_release);
}

algo::Metrics LiveRun::metrics() const {
  const std::lock_guard lock(mutex_);
  return metrics_;
}

Session::Session(Recorder* recorder) : recorder_(recorder) {}

void Session::load(RunSpec spec) {
  // Both may throw: nothing has changed yet.
  std::unique_ptr<algo::Robot> robot = make_robot(spec);
  std::shared_ptr<RunChannel> channel;
  if (recorder_ != nullptr) channel = recorder_->open(new_run(spec, robot->spec()));
  end();

  state_.robot = robot->spec();
  set_goals(std::nullopt);
  state_.obstacles = spec.scenario.obstacles;
  state_.parameters = spec.parameters;
  state_.outcome = algo::Outcome::Running;
  state_.lost_ticks = 0;
  state_.missed_periods = 0;
  state_.problem.reset();
  state_.hardware.reset();
  state_.running = true;
  path_.clear();
  newest_.reset();
  told_mission_ = algo::Mission::Idle;
  told_hold_ = algo::Hold::None;
  next_obstacle_ = 1;

  std::vector<algo::Request> first = first_requests(spec);
  if (state_.stop) first.push_back(algo::Stop{true});
  for (const algo::Request& request : first) adopt(request);
  state_.spec = spec;
  robot->set_pace(state_.pace);
  live_ = std::make_unique<LiveRun>(
      std::move(spec), std::move(robot), std::move(first), std::move(channel));
  changed();
}

void Session::end() {
  if (!live_) return;
  newest_.reset();
  live_.reset();
  state_.running = false;
  answer_the_rest();
}

/// What the run did not get round to is answered here, so that nobody waits for ever.
void Session::answer_the_rest() {
  const std::map<std::uint64_t, Pending> rest = std::exchange(pending_, {});
  for (const auto& [ticket, pending] : rest) {
    if (!pending.answer) continue;
    if (std::holds_alternative<algo::Stop>(pending.request)) {
      adopt(pending.request);
      pending.answer(std::nullopt);
    } else {
      pending.answer("The run ended before this could be done.");
    }
  }
}

/// One that neither an obstacle nor one on its way has. The ids of those removed come last.
std::uint32_t Session::free_obstacle_id() {
  const auto taken = [this](std::uint32_t id) {
    const auto on_its_way = [id](const auto& entry) {
      const auto* add = std::get_if<algo::AddObstacle>(&entry.second.request);
      return add != nullptr && add->obstacle.id == id;
    };
    return std::any_of(state_.obstacles.begin(),
                       state_.obstacles.end(),
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
  // Stop holds from this moment on, whatever becomes of the request: it belongs to the session.
  const auto* stop = std::get_if<algo::Stop>(&request);
  if (stop != nullptr && stop->engaged && !state_.stop) {
    state_.stop = true;
    changed();
  }
  if (!live_ || live_->finished()) {
    if (stop != nullptr) adopt(request);
    if (answer && stop != nullptr) answer(std::nullopt);
    if (answer && stop == nullptr) answer("The run is over. Reset or load a scenario first.");
    if (stop != nullptr) changed();
    return id;
  }
  const std::uint64_t ticket = next_ticket_++;
  const bool full =
      pending_.size() >= kMaxPending || !live_->rings.requests.push({ticket, request});
  if (full && stop != nullptr && stop->engaged) {
    live_->rings.stop_now.store(true);
    if (answer) answer(std::nullopt);
    return id;
  }
  if (full) return std::nullopt;
  pending_.emplace(ticket, Pending{std::move(request), std::move(answer)});
  return id;
}

void Session::apply_pace() {
  if (live_) live_->robot().set_pace(state_.pace);
  state_.pace.single_steps = 0;
  changed();
}

std::optional<std::string> Session::arm(bool on) {
  drivers::SerialRobot* robot = state_.spec.hardware.get();
  if (robot == nullptr) return "This robot is simulated: it has no motors to switch on.";
  std::optional<std::string> refusal;
  if (!on) {
    arm_when_ready_ = false;
    robot->disarm("Somebody has disarmed it.");
  } else if (!state_.running) {
    refusal = "The run is over. Reset first.";
  } else {
    refusal = robot->arm();
  }
  if (!refusal) log(LogLevel::Warning, on ? "The motors are armed." : "The motors are disarmed.");
  state_.hardware = robot->report();
  changed();
  return refusal;
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
  if (!live_) return;
  drain_replies();
  drain_frames();
  watch_run();
  watch_hardware();
}

/// People are told at once of what moves or stops the robot, of the rest once a second.
void Session::watch_hardware() {
  using std::chrono::milliseconds;
  drivers::SerialRobot* robot = state_.spec.hardware.get();
  const auto now = std::chrono::steady_clock::now();
  if (robot == nullptr || now - hardware_seen_ < milliseconds(100)) return;
  hardware_seen_ = now;
  drivers::HardwareReport report = robot->report();
  if (arm_when_ready_ && report.halt == algo::Halt::Disarmed) {
    arm_when_ready_ = false;
    if (const auto refusal = arm(true)) log(LogLevel::Warning, *refusal);
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

void Session::drain_replies() {
  bool different = false;
  live_->rings.replies.consume_all([&](const Reply& reply) {
    const auto it = pending_.find(reply.ticket);
    if (it == pending_.end()) return;
    const Pending pending = std::move(it->second);
    pending_.erase(it);
    if (reply.refusal) {
      log(LogLevel::Warning, "Refused: " + *reply.refusal);
    } else {
      adopt(pending.request);
      different = different || !std::holds_alternative<algo::Joystick>(pending.request);
    }
    if (pending.answer) pending.answer(reply.refusal);
  });
  if (different) changed();
}

/// Brings the mirror up to date with a request the control thread has accepted.
void Session::adopt(const algo::Request& request) {
  const auto find = [&](std::uint32_t id) {
    return std::find_if(state_.obstacles.begin(), state_.obstacles.end(), [id](const auto& o) {
      return o.id == id;
    });
  };
  std::visit(
      [&](const auto& r) {
        using R = std::decay_t<decltype(r)>;
        if constexpr (std::is_same_v<R, algo::SetGoal>) {
          set_goals(r);
        } else if constexpr (std::is_same_v<R, algo::AddGoal>) {
          if (state_.goal) {
            state_.goals_ahead.push_back(r.goal);
          } else {
            set_goals(r.goal);
          }
        } else if constexpr (std::is_same_v<R, algo::ClearGoal>) {
          set_goals(std::nullopt);
        } else if constexpr (std::is_same_v<R, algo::AddObstacle>) {
          state_.obstacles.push_back(r.obstacle);
        } else if constexpr (std::is_same_v<R, algo::MoveObstacle>) {
          if (const auto it = find(r.id); it != state_.obstacles.end()) it->pose_W = r.pose_W;
        } else if constexpr (std::is_same_v<R, algo::RemoveObstacle>) {
          if (const auto it = find(r.id); it != state_.obstacles.end()) state_.obstacles.erase(it);
        } else if constexpr (std::is_same_v<R, algo::Stop>) {
          state_.stop = r.engaged;
        } else if constexpr (std::is_same_v<R, algo::SetParameter>) {
          state_.parameters.set(r.parameter, r.value);
        } else {
          static_assert(std::is_same_v<R, algo::Joystick>);
          if (r != algo::Joystick{} && state_.goal) {  // taking the stick cancels the goal
            set_goals(std::nullopt);
            changed();
          }
        }
      },
      request);
}

void Session::set_goals(const std::optional<algo::SetGoal>& goal) {
  state_.goal = goal;
  state_.goals_ahead.clear();
}

/// Moves on in the mirror when the robot has: a frame may be older than what was asked for since.
void Session::follow_goal(const algo::Telemetry& t) {
  if (t.goal == state_.goal) return;
  auto& ahead = state_.goals_ahead;
  const auto found = std::find(ahead.begin(), ahead.end(), t.goal);
  if (found == ahead.end()) return;
  state_.goal = *found;
  ahead.erase(ahead.begin(), found + 1);
  log(LogLevel::Info, "A waypoint is reached; the next goal is set.");
  changed();
}

void Session::drain_frames() {
  FrameRef latest;
  live_->rings.stream.consume_all([&](const FrameRef& frame) {
    const algo::Telemetry& t = frame->telemetry;
    const algo::Pose2& pose = t.ground_truth ? t.ground_truth->pose : t.observation.odometry.pose;
    if (path_.empty() || (pose.position() - path_.back().position()).norm() > kPathSpacing) {
      path_.push_back(pose);
    }
    narrate(t);
    follow_goal(t);
    latest = frame;
  });
  if (path_.size() > kPathPoints) {
    for (std::size_t i = 0; 2 * i < path_.size(); ++i) path_[i] = path_[2 * i];
    path_.resize(path_.size() / 2);
  }
  if (!latest) return;
  newest_ = latest;
  if (on_frame) on_frame(latest);
}

/// Says in the log what changed for the robot, once per change.
void Session::narrate(const algo::Telemetry& t) {
  if (t.hold == told_hold_ && t.mission == told_mission_) return;
  const bool held = t.hold != algo::Hold::None && t.hold != told_hold_;
  const bool notable = t.mission != told_mission_ &&
                       (t.mission == algo::Mission::Arrived || t.mission == algo::Mission::Stuck);
  told_hold_ = t.hold;
  told_mission_ = t.mission;
  if (!held && !notable) return;
  const algo::Explanation words = algo::explain(t);
  log(held || t.mission == algo::Mission::Stuck ? LogLevel::Warning : LogLevel::Info,
      words.what + ". " + words.why);
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
    // The row says at once how a run that goes on has come out so far.
    if (!ended && recorder_ != nullptr && live_->id() != 0) {
      recorder_->post(
          [run = live_->id(), outcome, metrics = live_->metrics()](db::RunStore& store) {
            if (!store.recording(run)) return;
            const bool over = outcome != algo::Outcome::Running;
            store.set_result(run, algo::name(outcome), "", over ? to_json(metrics).dump() : "");
          });
    }
    changed();
  }
}

sim::Scenario Session::as_scenario(const std::string& name, const std::string& title) const {
  sim::Scenario out = state_.spec.scenario;
  out.name = name;
  out.title = title;
  out.goal = state_.goal;
  out.waypoints.clear();
  if (!state_.goals_ahead.empty()) {
    out.waypoints.push_back(*state_.goal);
    out.waypoints.insert(
        out.waypoints.end(), state_.goals_ahead.begin(), state_.goals_ahead.end() - 1);
    out.goal = state_.goals_ahead.back();
  }
  out.obstacles = state_.obstacles;
  out.parameters.clear();
  for (const algo::ParameterInfo& p : algo::parameter_table()) {
    if (state_.parameters[p.id] != p.initial) {
      out.parameters.emplace_back(p.id, state_.parameters[p.id]);
    }
  }
  return out;
}

void Session::changed() const {
  if (on_change) on_change();
}

void Session::log(LogLevel level, const std::string& text) const {
  if (on_log) on_log(level, text);
}

}  // namespace server
