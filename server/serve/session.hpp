// server/serve/session.hpp: one robot and everything that belongs to it; a server may hold many
// sessions.
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
#include "server/serve/control_lease.hpp"
#include "server/serve/credits.hpp"
#include "server/serve/live_run.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/path_trail.hpp"
#include "server/serve/scene_json.hpp"
#include "server/serve/stick_watch.hpp"

namespace server {

/// Why and when real hardware was disarmed last.
struct Disarming {
  std::string why{};  // a sentence
  std::string at{};   // ISO 8601, UTC
};

/// The state of a session that clients see, besides its frames. Io thread only.
struct SessionState {
  RunSpec spec{};
  algo::RobotSpec robot{};
  bool editable = false;  // obstacles can be added, moved and removed
  Pace pace{};
  algo::Intent asked{};    // the sum of all accepted requests
  algo::SetGoals route{};  // the goals as last set; driving by hand does not clear it
  std::optional<algo::SetHandGoal> hand_goal{};  // of an arm, in the same way
  std::optional<algo::SetGoal> carry_goal{};
  bool edited = false;                   // the world differs from the scenario as loaded or saved
  std::vector<algo::Obstacle> others{};  // the scenario's other robots, at their starts
  algo::Outcome outcome = algo::Outcome::Running;
  bool running = false;  // the run is in progress
  std::uint64_t lost_ticks = 0;
  std::uint64_t missed_periods = 0;
  std::optional<std::string> problem{};
  RecordStatus record{};
  std::optional<algo::HealthReport> hardware{};  // as last reported to clients
  std::optional<Disarming> disarming{};          // nothing while armed, and before it ever was
  Watchers watchers{};
  std::size_t viewers = 0;  // WebSocket clients
};

/// The next run, built but not begun.
struct PreparedRun {
  RunSpec spec{};
  std::unique_ptr<LiveRun> live{};
};

/// Io thread only, except prepare(). Several pages may use it at once: the last writer wins and all
/// see it.
class Session {
 public:
  using Answer = std::function<void(const std::optional<std::string>& refusal)>;

  /// `news` is called from any thread when poll() has work; it may be empty.
  explicit Session(const RunHouse& house, std::function<void()> news = {});

  /// Does the slow part: builds the world, or opens the log or the record. Throws std::exception
  /// with a sentence. Any thread except the io thread.
  PreparedRun prepare(RunSpec spec);
  /// Asks the current run to end and returns it; null without a run. Its destructor waits for the
  /// last tick.
  std::unique_ptr<LiveRun> part();
  /// Begins a run after the last one is destroyed. An engaged Stop stays engaged: loading and
  /// resetting must not set a stopped robot in motion.
  void begin(PreparedRun next);
  /// Does all of these steps and waits: before there is an io thread, and for tests. If it throws,
  /// the current run goes on unchanged.
  void load(RunSpec spec);
  /// Ends the run; the session can be loaded again. `cut`: the program ends, so a run without an
  /// outcome counts as interrupted.
  void end(bool cut = false);

  /// Hands `request` to the control thread; a later poll() calls `answer`. Returns the id given to
  /// an obstacle without one, and 0 for other requests. Returns nothing if the control thread
  /// cannot take more now: try again later.
  ///
  /// A Stop holds from this call on, even if the run ends, and is answered within the call. It
  /// needs no tick and no room in the ring, and it cancels a release on its way.
  std::optional<std::uint32_t> submit(algo::Request request, Answer answer);
  /// True if the newest tick shows a robot at rest with a command to stay at rest.
  bool standing() const;

  /// Switches the motors of real hardware on or off, for `who`. Returns the reason for a refusal,
  /// as a sentence.
  std::optional<std::string> arm(bool on, const std::string& who = "Somebody");
  /// Takes the readings that a process beside the robot publishes; null if the robot expects none.
  algo::Publishing* publishing() const;
  /// Arms the robot as soon as its devices are ready for the first time.
  void arm_when_ready() { arm_when_ready_ = true; }
  /// Signs of life of the operators who could stop the robot.
  OperatorWatch& watch() { return watch_; }
  void count_viewers(std::size_t viewers);

  /// Who has the controls. After a change call pass_controls() or tell().
  ControlLease& lease() { return lease_; }
  const ControlLease& lease() const { return lease_; }
  const StickWatch& sticks() const { return sticks_; }
  /// Other hands have the controls, or nobody: the stick is let go.
  void pass_controls();
  /// Clients are told that state() has changed.
  void tell() const { changed(); }
  /// As StickWatch::refusal().
  std::optional<std::string> judge(std::uint64_t client,
                                   const algo::Joystick& stick,
                                   const StickStamp& stamp);
  void count_unreadable_stick();
  void client_came(std::uint64_t client);
  /// The link of a client is lost, and with it the controls.
  void client_gone(std::uint64_t client);

  /// Why this robot's time cannot be paused, stepped or sped up (real hardware), as a sentence.
  std::optional<std::string> pace_refusal() const;
  void pause(bool paused);
  void set_speed(double times_real_time);  // 0: as fast as possible
  void single_step(std::uint32_t ticks);

  /// Takes answers and frames from the control thread. Call it on news and at intervals.
  void poll();

  const SessionState& state() const { return state_; }
  /// Everything in the world: the obstacles, then the other robots as obstacles.
  std::vector<algo::Obstacle> obstacles() const;
  db::RunId run_id() const { return live_ ? live_->id() : 0; }
  /// A known problem of a goal or of a pose on the map, as a sentence. Nothing for other requests,
  /// or when there is no time to check.
  std::optional<std::string> trouble_with(const algo::Request& request);
  /// True if there is time to check a goal: among thousands of obstacles a check takes
  /// milliseconds, and this thread carries Stop.
  bool may_look_at_goals() const { return std::chrono::steady_clock::now() >= next_look_; }
  /// The newest frame; null before the first.
  const FrameRef& newest() const { return newest_; }
  /// The newest frame with a scan: not every tick brings one.
  const FrameRef& newest_scan() const { return newest_scan_; }
  const PathTrail& path() const { return path_; }
  /// Lateness of the run's ticks against their deadlines, except for hardware.
  algo::LatenessHistogram lateness() const;
  /// The world as it stands, as a scenario: also with the edits, goals and gains of people.
  sim::Scenario as_scenario() const;
  /// The run to begin on a reset, and on a load that names no scenario: the same world.
  RunSpec again() const;
  /// Moves the start, at which the robot stands after the next reset. Returns the reason for a
  /// refusal, as a sentence.
  std::optional<std::string> set_start(const algo::Pose2& start_W);
  /// The world has been saved as `scenario`, which is the session's scenario from now on.
  void saved(const sim::Scenario& scenario);

  Credits credits{};  // set by credit() and by callers that change the pace

  std::function<void()> on_change{};                // state() has changed
  std::function<void(const FrameRef&)> on_frame{};  // the newest frame of each poll
  std::function<void(LogLevel, const std::string&)> on_log{};

 private:
  struct Pending {
    algo::Request request{};
    Answer answer{};
  };

  void engage_stop(std::uint64_t ticket, const Answer& answer);
  void adopt(const algo::Request& request);
  void note_goals();
  void note_edits();
  std::uint32_t free_obstacle_id();
  void drain_replies();
  void drain_frames();
  void answer_the_rest();
  void watch_run();
  std::optional<std::string> trouble_with_goal(const algo::SetGoal& goal) const;
  void watch_record();
  void watch_hardware();
  void watch_lease();
  void after(const std::function<bool()>& end);
  void note_arming(bool armed, const std::string& why);
  void count_watchers();
  void narrate(const algo::Telemetry& t);
  void follow_goal(const algo::Telemetry& t);
  void apply_pace();
  void changed() const;
  void log(LogLevel level, const std::string& text) const;

  RunHouse house_;
  sim::Scenario saved_{};  // as loaded or last saved
  Recorder* recorder_;
  std::function<void()> news_;
  OperatorWatch watch_{};  // outlives the runs
  ControlLease lease_{};
  bool told_silent_ = false;  // that others may take over
  StickWatch sticks_{};
  SessionState state_{};
  FrameRef newest_{};
  std::chrono::steady_clock::time_point newest_came_{};
  FrameRef newest_scan_{};
  std::chrono::steady_clock::time_point next_look_{};  // earliest time of the next goal check
  PathTrail path_{};
  std::map<std::uint64_t, Pending> pending_{};
  std::uint64_t next_ticket_ = 1;
  std::uint64_t stop_ticket_ = 0;  // ticket of the newest Stop
  std::uint32_t next_obstacle_ = 1;
  algo::Mission told_mission_ = algo::Mission::Idle;
  algo::Hold told_hold_{};
  bool arm_when_ready_ = false;
  bool was_armed_ = false;
  std::uint64_t record_seen_ = 0;                          // last seen revision of the recorder
  std::chrono::steady_clock::time_point hardware_seen_{};  // when hardware was last checked
  std::chrono::steady_clock::time_point hardware_told_{};  // when clients were last told of it
  std::unique_ptr<LiveRun> live_{};
};

}  // namespace server
