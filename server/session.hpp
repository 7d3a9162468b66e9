// server/session.hpp: one robot and everything that belongs to it; the server may hold many.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "algo/metrics.hpp"
#include "drivers/serial_robot.hpp"
#include "server/frame_pool.hpp"
#include "server/recorder.hpp"
#include "server/run_spec.hpp"
#include "server/runner.hpp"
#include "server/wire/scene_json.hpp"

namespace server {

/// What people see of a session apart from its frames. Kept on the io thread only.
struct SessionState {
  RunSpec spec{};
  algo::RobotSpec robot{};
  algo::Pace pace{};
  bool stop = false;
  std::optional<algo::SetGoal> goal{};
  std::vector<algo::SetGoal> goals_ahead{};  // after that one, in order
  std::vector<algo::Obstacle> obstacles{};
  algo::Parameters parameters{};
  algo::Outcome outcome = algo::Outcome::Running;
  bool running = false;  // the run's control thread is at work
  std::uint64_t lost_ticks = 0;
  std::uint64_t missed_periods = 0;
  std::optional<std::string> problem{};
  std::optional<drivers::HardwareReport> hardware{};  // as people were last told
};

/// One call of run() with its thread, rings and frames. Made and ended by the io thread.
class LiveRun {
 public:
  LiveRun(RunSpec spec,
          std::unique_ptr<algo::Robot> robot,
          std::vector<algo::Request> first,
          std::shared_ptr<RunChannel> channel);
  ~LiveRun();  // asks the loop to end and waits for it: at most one period of the robot

  Rings rings{};
  algo::Robot& robot() { return *robot_; }
  algo::Outcome outcome() const { return outcome_.load(std::memory_order_relaxed); }
  /// The figures when the outcome last changed.
  algo::Metrics metrics() const;
  bool finished() const { return finished_.load(std::memory_order_acquire); }
  /// Only once finished() is true.
  const RunResult& result() const { return result_; }
  db::RunId id() const { return channel_ ? channel_->run() : 0; }

 private:
  void control(const std::stop_token& stop);

  RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  algo::Pipeline pipeline_;
  std::vector<algo::Request> first_;
  std::shared_ptr<RunChannel> channel_;
  std::shared_ptr<FramePool> pool_;
  RunResult result_{};
  mutable std::mutex mutex_{};
  algo::Metrics metrics_{};  // guarded by mutex_, which is taken only when the outcome changes
  std::atomic<algo::Outcome> outcome_{algo::Outcome::Running};
  std::atomic<bool> finished_{false};
  std::jthread thread_;  // last: starts when all above is there
};

/// All calls from the io thread. Two pages at once work: the last writer wins and both see it.
class Session {
 public:
  using Answer = std::function<void(const std::optional<std::string>& refusal)>;

  /// `recorder` may be null: nothing is kept.
  explicit Session(Recorder* recorder);

  /// Ends the present run and begins the next. Throws std::exception with a sentence when the
  /// robot cannot be made; the present run then goes on untouched. An engaged Stop stays engaged:
  /// loading and resetting must not set a stopped robot in motion.
  void load(RunSpec spec);
  void reset() { load(state_.spec); }
  /// Ends the run for good; the session can be loaded again.
  void end();

  /// Hands `request` to the control thread; `answer` is called from a later poll(). An obstacle
  /// without an id gets one, which is returned (0 for other requests). Nothing when the control
  /// thread cannot take more just now: try again later.
  std::optional<std::uint32_t> submit(algo::Request request, Answer answer);

  /// Switches the motors of real hardware on or off. Returns why not, as a sentence.
  std::optional<std::string> arm(bool on);
  /// The same as soon as its devices are well for the first time.
  void arm_when_ready() { arm_when_ready_ = true; }

  void pause(bool paused);
  void set_speed(double times_real_time);  // 0: as fast as it goes
  void single_step(std::uint32_t ticks);

  /// Takes answers and frames over from the control thread; call it often.
  void poll();

  const SessionState& state() const { return state_; }
  db::RunId run_id() const { return live_ ? live_->id() : 0; }
  /// The newest frame, null before the first.
  const FrameRef& newest() const { return newest_; }
  const std::vector<algo::Pose2>& path() const { return path_; }
  /// The world as it stands, as a scenario of its own.
  sim::Scenario as_scenario(const std::string& name, const std::string& title) const;

  std::function<void()> on_change{};                // state() is different now
  std::function<void(const FrameRef&)> on_frame{};  // the newest of those drained in one poll
  std::function<void(LogLevel, const std::string&)> on_log{};

 private:
  struct Pending {
    algo::Request request{};
    Answer answer{};
  };

  void set_goals(const std::optional<algo::SetGoal>& goal);
  void adopt(const algo::Request& request);
  std::uint32_t free_obstacle_id();
  void drain_replies();
  void drain_frames();
  void answer_the_rest();
  void watch_run();
  void watch_hardware();
  void narrate(const algo::Telemetry& t);
  void follow_goal(const algo::Telemetry& t);
  void apply_pace();
  void changed() const;
  void log(LogLevel level, const std::string& text) const;

  Recorder* recorder_;
  SessionState state_{};
  FrameRef newest_{};
  std::vector<algo::Pose2> path_{};
  std::map<std::uint64_t, Pending> pending_{};
  std::uint64_t next_ticket_ = 1;
  std::uint32_t next_obstacle_ = 1;
  algo::Mission told_mission_ = algo::Mission::Idle;
  algo::Hold told_hold_ = algo::Hold::None;
  bool arm_when_ready_ = false;
  std::chrono::steady_clock::time_point hardware_seen_{};  // when it was last looked at
  std::chrono::steady_clock::time_point hardware_told_{};  // when people were last told of it
  std::unique_ptr<LiveRun> live_{};
};

}  // namespace server
