// server/serve/session.hpp: one robot and everything that belongs to it; the server may hold many.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/intent.hpp"
#include "algo/metrics.hpp"
#include "server/record/record_status.hpp"
#include "server/record/recorder.hpp"
#include "server/run/frame_pool.hpp"
#include "server/run/run_spec.hpp"
#include "server/serve/live_run.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/path_trail.hpp"
#include "server/serve/scene_json.hpp"

namespace server {

/// What people see of a session apart from its frames. Kept on the io thread only.
struct SessionState {
  RunSpec spec{};
  algo::RobotSpec robot{};
  bool editable = false;  // obstacles can be added, moved, removed
  Pace pace{};
  algo::Intent asked{};                  // all requests that were accepted
  std::vector<algo::Obstacle> others{};  // the scenario's other robots, at their starts
  algo::Outcome outcome = algo::Outcome::Running;
  bool running = false;  // the run's control thread is at work
  std::uint64_t lost_ticks = 0;
  std::uint64_t missed_periods = 0;
  std::optional<std::string> problem{};
  RecordStatus record{};
  std::optional<algo::HealthReport> hardware{};  // as people were last told
  Watchers watchers{};
};

/// The next run, made but not begun.
struct PreparedRun {
  RunSpec spec{};
  std::unique_ptr<LiveRun> live{};
};

/// All calls from the io thread, but for prepare(). Two pages at once work: the last writer wins
/// and both see it.
class Session {
 public:
  using Answer = std::function<void(const std::optional<std::string>& refusal)>;

  /// `news` is called from any thread when poll() has something to do; it may be empty.
  explicit Session(const RunHouse& house, std::function<void()> news = {});

  /// Builds the world or opens the log or the record: whatever takes time. Throws std::exception
  /// with a sentence. Any thread but the io thread.
  PreparedRun prepare(RunSpec spec);
  /// Asks the present run to end and hands it over. Its destructor waits for the last tick.
  /// Null without one.
  std::unique_ptr<LiveRun> part();
  /// Begins a run once the last has gone. An engaged Stop stays engaged: loading and resetting must
  /// not set a stopped robot in motion.
  void begin(PreparedRun next);
  /// All of it, waiting: before there is an io thread, and for tests. When it throws, the present
  /// run goes on untouched.
  void load(RunSpec spec);
  /// Ends the run for good; the session can be loaded again. `cut`: because the program ends, so
  /// that a run without an outcome is interrupted.
  void end(bool cut = false);

  /// Hands `request` to the control thread; `answer` is called from a later poll(). An obstacle
  /// without an id gets one, which is returned (0 for other requests). Nothing when the control
  /// thread cannot take more just now: try again later.
  ///
  /// A Stop holds from this call on, whatever becomes of the run, and is answered in it: it needs
  /// no tick and no room in the ring, and takes back a release on its way.
  std::optional<std::uint32_t> submit(algo::Request request, Answer answer);
  /// True when the newest tick shows a robot at rest that was told to stay so.
  bool standing() const;

  /// Switches the motors of real hardware on or off. Returns why not, as a sentence.
  std::optional<std::string> arm(bool on);
  /// The same as soon as its devices are well for the first time.
  void arm_when_ready() { arm_when_ready_ = true; }
  /// Signs of life of those who could stop the robot.
  OperatorWatch& watch() { return watch_; }

  /// Why this robot's time cannot be paused, stepped or sped up, as a sentence: it is real.
  std::optional<std::string> pace_refusal() const;
  void pause(bool paused);
  void set_speed(double times_real_time);  // 0: as fast as it goes
  void single_step(std::uint32_t ticks);

  /// Takes answers and frames over from the control thread; call it on news, and now and then.
  void poll();

  const SessionState& state() const { return state_; }
  /// All that stands or moves in the world: obstacles, then the other robots as such.
  std::vector<algo::Obstacle> obstacles() const;
  db::RunId run_id() const { return live_ ? live_->id() : 0; }
  /// What is known to be wrong with a goal now, as a sentence; nothing for other requests, nor when
  /// there is no time to look.
  std::optional<std::string> trouble_with(const algo::Request& request);
  /// Whether there is time to look at a goal: in a world of thousands of things a look takes some
  /// milliseconds, and this thread carries Stop.
  bool may_look_at_goals() const { return std::chrono::steady_clock::now() >= next_look_; }
  /// The newest frame, null before the first.
  const FrameRef& newest() const { return newest_; }
  /// The newest frame that brought a scan: not every tick does.
  const FrameRef& newest_scan() const { return newest_scan_; }
  const PathTrail& path() const { return path_; }
  /// How late the ticks of its run were for their deadlines, unless it is hardware.
  algo::LatenessHistogram lateness() const;
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

  void engage_stop(std::uint64_t ticket, const Answer& answer);
  void adopt(const algo::Request& request);
  std::uint32_t free_obstacle_id();
  void drain_replies();
  void drain_frames();
  void answer_the_rest();
  void watch_run();
  std::optional<std::string> trouble_with_goal(const algo::SetGoal& goal) const;
  void watch_record();
  void watch_hardware();
  void count_watchers();
  void narrate(const algo::Telemetry& t);
  void follow_goal(const algo::Telemetry& t);
  void apply_pace();
  void changed() const;
  void log(LogLevel level, const std::string& text) const;

  RunHouse house_;
  Recorder* recorder_;
  std::function<void()> news_;
  OperatorWatch watch_{};  // outlives the runs
  SessionState state_{};
  FrameRef newest_{};
  std::chrono::steady_clock::time_point newest_came_{};
  FrameRef newest_scan_{};
  std::chrono::steady_clock::time_point next_look_{};  // at a goal
  PathTrail path_{};
  std::map<std::uint64_t, Pending> pending_{};
  std::uint64_t next_ticket_ = 1;
  std::uint64_t stop_ticket_ = 0;  // of the newest Stop
  std::uint32_t next_obstacle_ = 1;
  algo::Mission told_mission_ = algo::Mission::Idle;
  algo::Hold told_hold_{};
  bool arm_when_ready_ = false;
  std::uint64_t record_seen_ = 0;                          // revision of the recorder
  std::chrono::steady_clock::time_point hardware_seen_{};  // when it was last looked at
  std::chrono::steady_clock::time_point hardware_told_{};  // when people were last told of it
  std::unique_ptr<LiveRun> live_{};
};

}  // namespace server
