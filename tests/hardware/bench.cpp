// tests/hardware/bench.cpp: setting up both ends of the cables.
#include "tests/hardware/bench.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "tests/folders.hpp"
#include <fmt/format.h>

#include "drivers/open_robot.hpp"
#include "server/cli/cli.hpp"
#include "server/emulate/clock.hpp"
#include "server/record/recorder.hpp"
#include "server/record/run_json.hpp"
#include "server/run/scenario_library.hpp"

namespace server::hardware {
namespace {

namespace fs = std::filesystem;

/// The keys of [base] for this kind only.
std::string base_keys(const BenchOptions& options) {
  switch (options.base) {
    case emulate::BaseKind::P2os:
      return "type = \"pioneer\"\nwatchdog = 2.0\nbattery_low = 11\n";
    case emulate::BaseKind::Analog:
      return fmt::format(
          "type = \"analog\"\nwatchdog = 0.2\nlibrary = \"{}\"\nwheel_radius = 0.1\n"
          "counts_per_turn = 2000\nspeed_per_volt = 0.1\nrelay_closed_line = 1\nstop_line = 2\n"
          "fault_line = 3\nbumper_lines = [4]\nenable_line = 5\n",
          tests::emulated_comedi().string());
    default:
      return fmt::format(
          "type = \"roboteq\"\nwatchdog = {}\nbattery_low = 22\nwheel_radius = 0.1\ngear = 20\n"
          "encoder_lines = 500\nfull_speed_rpm = 1000\nbumper_inputs = [1]\n"
          "rear_bumper_inputs = [2]\n",
          options.watchdog);
  }
}

std::string robot_file(const BenchOptions& options, const sim::Scenario& scenario) {
  return fmt::format(
             "name = \"emulated\"\nperiod = {}\n[hull]\nradius = 0.35\n[limits]\nspeed = 0.1\n"
             "turn = 1.0\nacceleration = 2.0\nturn_acceleration = 20.0\n"
             "[[laser]]\nname = \"front laser\"\nport = \"{}\"\nrate = 500000\nstep_deg = 0.5\n"
             "x = {}\n[base]\nport = \"{}\"\ntrack = 0.5\n",
             scenario.period,
             (options.folder / "scanner").string(),
             scenario.robot.sensors.lasers.front().mount_R.x,
             (options.folder / "base").string()) +
         base_keys(options);
}

/// `point` of W in the robot's own odometry frame, which begins at its start.
algo::Vec2 from_start(const algo::Pose2& start, const algo::Vec2& point) {
  const algo::Vec2 d = point - start.position();
  const double c = std::cos(start.heading);
  const double s = std::sin(start.heading);
  return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
}

}  // namespace

Truth read_truth(const fs::path& record) {
  Truth truth;
  std::ifstream file(record);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "scan") {
      SentLine scan;
      std::string device;
      int part = 0;
      words >> device >> scan.number >> scan.time >> scan.fate >> part;
      for (std::uint16_t beam = 0; words >> beam;) scan.beams.push_back(beam);
      truth.scans.push_back(std::move(scan));
    } else if (kind == "wheels") {
      WheelLine wheels;
      words >> wheels.time >> wheels.left >> wheels.right;
      truth.wheels.push_back(wheels);
    } else if (kind == "pose") {
      PoseLine pose;
      words >> pose.time >> pose.pose_W.x >> pose.pose_W.y >> pose.pose_W.heading;
      pose.pose_W.x /= 1000;
      pose.pose_W.y /= 1000;
      pose.pose_W.heading /= 1000;
      truth.poses.push_back(pose);
    }
  }
  return truth;
}

Bench::Bench(const BenchOptions& options) : options_(options) {
  fs::create_directories(options_.folder);
  const ScenarioLibrary library({}, {});
  emulate::EmulationOptions emulation;
  emulation.scenario = library.load(options_.scenario);
  if (options_.goal_W) emulation.scenario.goal = algo::SetGoal{.position_W = *options_.goal_W};
  emulation.seed = options_.seed;
  emulation.record = record();
  emulation.scanner_links = {options_.folder / "scanner"};
  emulation.base = options_.base;
  emulation.base_link = options_.folder / "base";
  emulation.near_wrap = true;
  emulation.faults.damage = options_.damage;
  spec_ = make_spec(emulation.scenario, {.seed = options_.seed});
  if (spec_.scenario.goal) {
    spec_.scenario.goal->position_W =
        from_start(spec_.scenario.start, spec_.scenario.goal->position_W);
  }
  emulation_ = std::make_unique<emulate::Emulation>(emulation);
  emulation_->start();
  robot_ = drivers::open_robot(
      drivers::parse_robot(robot_file(options_, emulation.scenario), "emulated.toml"));
}

Bench::~Bench() = default;

bool Bench::wait_for(const std::function<bool()>& condition, double seconds) {
  const double end = emulate::machine_time() + seconds;
  while (!condition()) {
    if (emulate::machine_time() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

bool Bench::arm(double seconds) {
  return wait_for(
      [this] { return robot_->health().halt == algo::Halt::Disarmed && !robot_->arm(); }, seconds);
}

HeadlessResult Bench::drive(const std::stop_token& stop) {
  Recorder recorder(database().string(), recorder_options());
  HeadlessOptions headless;
  headless.pace = 1;
  headless.record = recorder.open(new_run(spec_, robot_->spec()));
  const std::jthread arming([this](const std::stop_token& done) {
    std::string said;
    bool moved = false;
    while (!done.stop_requested()) {
      // Until its first motion; a later disarming has a cause of its own.
      moved = moved || robot_->health().halt == algo::Halt::None;
      if (!moved) arm(0.1);
      // Prints each change of the hold reason, for readers of the trial's figures.
      const algo::HealthReport report = robot_->health();
      if (report.trouble != said) fmt::print(stderr, "{}: {}\n", options_.scenario, report.trouble);
      said = report.trouble;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  HeadlessResult result = run_headless(spec_, *robot_, headless, stop);
  robot_->disarm("");
  recorder.flush();
  return result;
}

}  // namespace server::hardware
