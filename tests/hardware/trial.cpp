// tests/hardware/trial.cpp: long trials of the drivers against emulated devices, in real time; each
// prints a table and ends with status 1 when something did not hold.
//
//   hardware_trial experiments FOLDER    thesis experiments 1-4, both bases, against pure
//   simulation hardware_trial faults FOLDER         the table of docs/hardware.md hardware_trial
//   soak FOLDER SECONDS   1 % of telegrams damaged: memory, and where each scan went
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "tests/hardware/bench.hpp"
#include <fmt/format.h>
#include <unistd.h>

#include "algo/laser_scan.hpp"
#include "db/run_reader.hpp"
#include "server/emulate/clock.hpp"
#include "server/scenario_library.hpp"
#include "server/wire/frame_codec.hpp"

namespace server::hardware {
namespace {

namespace fs = std::filesystem;
using emulate::BaseKind;
using emulate::machine_time;

constexpr double kMostLateral = 0.020;  // [m] from the path of the pure simulation

const char* name_of(BaseKind base) {
  return base == BaseKind::P2os ? "p2os" : "roboteq";
}

/// [m] From `p` to the nearest point of `path`.
double distance(const algo::Vec2& p, const std::vector<algo::Vec2>& path) {
  double least = (p - path.front()).norm();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const algo::Vec2 d = path[i + 1] - path[i];
    const double length = d.squaredNorm();
    const double t = length > 0 ? std::clamp((p - path[i]).dot(d) / length, 0.0, 1.0) : 0;
    least = std::min(least, (p - path[i] - t * d).norm());
  }
  return least;
}

/// The path of `scenario` in pure simulation.
std::vector<algo::Vec2> simulated(const std::string& name, std::uint64_t seed, unsigned delay) {
  const ScenarioLibrary library({}, {});
  sim::Scenario scenario = library.load(name);
  scenario.drive.delay_ticks = delay;
  const RunSpec spec = make_spec(scenario, {.seed = seed});
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  std::vector<algo::Vec2> path;
  const std::shared_ptr<FramePool> pool = FramePool::make(64);
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  robot->set_pace({.paused = false, .speed = 0});
  RunLinks links;
  links.pool = pool.get();
  links.observer = [&](const Frame& frame) {
    path.push_back(frame.telemetry.ground_truth->pose.position());
  };
  const RunPolicy policy{.until_outcome = true, .time_limit = time_limit(spec)};
  run(*robot, pipeline, first_requests(spec), policy, links, {});
  return path;
}

/// Beams of every scan that a run stored.
std::vector<std::vector<std::uint16_t>> stored_scans(const fs::path& database) {
  db::RunReader reader(database.string());
  const db::RunPage page = reader.list({}, 1);
  std::vector<std::vector<std::uint16_t>> scans;
  algo::Telemetry telemetry;
  std::optional<std::uint64_t> from = 0;
  while (from) {
    from = reader.frames(
        page.runs.front().id, *from, 1000, [&](std::uint64_t, std::span<const std::byte> bytes) {
          decode_frame(bytes, telemetry);
          for (const algo::LaserScan& scan : telemetry.observation.scans) {
            scans.emplace_back(scan.size());
            algo::beams_to_wire(scan, scans.back());
          }
        });
  }
  return scans;
}

/// How many of `stored` are among `sent`, in this order; all of them when nothing is wrong.
std::size_t found_in_order(const std::vector<std::vector<std::uint16_t>>& stored,
                           const std::vector<SentLine>& sent) {
  std::size_t found = 0;
  auto at = sent.begin();
  for (const auto& scan : stored) {
    const auto same =
        std::find_if(at, sent.end(), [&](const SentLine& line) { return line.beams == scan; });
    if (same == sent.end()) continue;
    at = same + 1;
    ++found;
  }
  return found;
}

bool experiment(const std::string& scenario, BaseKind base, const fs::path& folder) {
  Bench bench({.scenario = scenario, .base = base, .folder = folder});
  const HeadlessResult result = bench.drive({});
  const Truth truth = read_truth(bench.record());
  // A Pioneer hears a command at 9600 bit/s, which takes most of a tick.
  const auto path = simulated(scenario, 1, base == BaseKind::P2os ? 1 : 0);
  double lateral = 0;
  for (const PoseLine& pose : truth.poses) {
    lateral = std::max(lateral, distance(pose.pose_W.position(), path));
  }
  const auto stored = stored_scans(bench.database());
  const std::size_t found = found_in_order(stored, truth.scans);
  const bool reached = result.run.outcome == algo::Outcome::Reached;
  const bool held = reached && lateral <= kMostLateral && found == stored.size();
  fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {} | {} | {} |\n",
             scenario,
             name_of(base),
             algo::name(result.run.outcome),
             result.run.metrics.time,
             1000 * lateral,
             stored.size(),
             stored.size() - found,
             result.run.missed_periods);
  std::fflush(stdout);
  return held;
}

int experiments(const fs::path& folder, const std::string& only) {
  fmt::print(
      "| experiment | base | outcome | time [s] | lateral [mm] | scans stored | of them not as "
      "sent "
      "| missed periods |\n|---|---|---|---|---|---|---|---|\n");
  bool held = true;
  for (const char* scenario : {"exp1", "exp2", "exp3", "exp4"}) {
    for (const BaseKind base : {BaseKind::Roboteq, BaseKind::P2os}) {
      const std::string name = fmt::format("{}-{}", scenario, name_of(base));
      if (!only.empty() && name != only) continue;
      held = experiment(scenario, base, folder / name) && held;
    }
  }
  return held ? 0 : 1;
}

// ---- faults ------------------------------------------------------------------------------------

struct Fault {
  const char* name;
  const char* command;   // that brings it
  const char* recovery;  // that takes it away; empty: it passes by itself
  double limit = 0;      // [s] from the fault to the zero wheel command
};

/// [s] From `begin` to the first command of zero wheels that no other follows until `end`.
std::optional<double> time_to_zero(const Truth& truth, double begin, double end) {
  std::optional<double> zero;
  for (const WheelLine& wheels : truth.wheels) {
    if (wheels.time < begin || wheels.time > end) continue;
    const bool still = std::abs(wheels.left) < 0.05 && std::abs(wheels.right) < 0.05;
    if (still && !zero) zero = wheels.time - begin;
    if (!still) zero.reset();
  }
  return zero;
}

bool trial(const Fault& fault, BaseKind base, const fs::path& folder) {
  Bench bench({.scenario = "exp4", .base = base, .folder = folder});
  std::stop_source stop;
  std::jthread driving([&] { bench.drive(stop.get_token()); });
  drivers::SerialRobot& robot = bench.robot();
  const auto moves = [&] { return robot.report().halt == algo::Halt::None; };
  std::string said = "never moved";
  std::string recovered = "no";
  double begin = 0;
  double end = 0;
  if (Bench::wait_for(moves, 60)) {
    std::this_thread::sleep_for(std::chrono::seconds(3));
    begin = machine_time();
    bench.emulation().command(fault.command);
    Bench::wait_for([&] { return !moves(); }, 10);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const drivers::HardwareReport report = robot.report();
    said = std::string(algo::name(report.halt)) + ": " + report.trouble;
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    end = machine_time();
    if (fault.recovery[0] != '\0') bench.emulation().command(fault.recovery);
    if (Bench::wait_for(moves, 4)) {
      recovered = "by itself";
    } else if (bench.arm(30) && Bench::wait_for(moves, 5)) {
      recovered = "armed again";
    }
    recovered += fmt::format(", {:.1f} s after", machine_time() - end);
  }
  stop.request_stop();
  driving.join();
  const auto zero = time_to_zero(read_truth(bench.record()), begin, end);
  const bool held = zero && *zero <= fault.limit;
  fmt::print("| {} | {} | {} | {} | {:.0f} ms | {} |\n",
             fault.name,
             name_of(base),
             said,
             zero ? fmt::format("{:.0f} ms", 1000 * *zero) : "never",
             1000 * fault.limit,
             recovered);
  std::fflush(stdout);
  return held;
}

int faults(const fs::path& folder, const std::string& only) {
  // A scan takes 26.6 ms and 14.6 ms on the line; a tick 26 ms; a report of the Pioneer 100 ms, of
  // the Roboteq 140 ms for seven queries of 20 ms in turn.
  constexpr double kScans = 3 * 0.0267 + 0.020 + 0.026 + 0.015;
  constexpr double kBase = 0.3 + 0.026 + 0.02;
  constexpr double kReport = 0.14 + 0.026 + 0.02;
  const std::vector<Fault> rows{
      {"scanner says nothing for 2 s", "scanner silence 2", "", kScans},
      {"scanner restarts, 3 s", "scanner restart 3", "", kScans},
      {"scanner's plug is pulled for 2 s", "scanner unplug 2", "", kScans},
      {"scanner dazzled", "dazzle on", "dazzle off", 1.0},
      {"scanner reports an error", "health 3", "health 0", kScans},
      {"half of the scanner's telegrams damaged", "scanner damage 0.7", "scanner damage 0", 2.0},
      {"base says nothing for 2 s", "base silence 2", "", kBase},
      {"base restarts, 2 s", "base restart 2", "", kBase},
      {"base's plug is pulled for 2 s", "base unplug 2", "", 0.6},
      {"stop button", "stop on", "stop off", kReport},
      {"bumper", "bumper on", "bumper off", kReport},
      {"battery low", "battery 10", "battery 25", 3.0 + kReport},
      {"controller reports a fault", "faults 8", "faults 0", kReport},
  };
  fmt::print(
      "| fault | base | what the robot says | zero wheel command after | at most | goes on "
      "|\n|---|---|---|---|---|---|\n");
  bool held = true;
  int number = 0;
  for (const BaseKind base : {BaseKind::Roboteq, BaseKind::P2os}) {
    if (!only.empty() && only != name_of(base)) continue;
    for (const Fault& fault : rows) {
      held = trial(fault, base, folder / fmt::format("fault{}", number++)) && held;
    }
  }
  return held ? 0 : 1;
}

// ---- soak --------------------------------------------------------------------------------------

/// [bytes] of memory in use that are not shared with a file.
double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

int soak(const fs::path& folder, double seconds) {
  double low = 0;
  double high = 0;
  Truth truth;
  std::vector<std::vector<std::uint16_t>> stored;
  {
    // The robot stands at its goal after a while; its devices go on.
    Bench bench({.scenario = "exp1", .folder = folder, .damage = 0.01});
    std::stop_source stop;
    std::jthread driving([&] {
      while (!stop.stop_requested()) bench.drive(stop.get_token());
    });
    const double begin = machine_time();
    while (machine_time() - begin < seconds) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
      const double now = resident_megabytes();
      if (machine_time() - begin < 60) continue;  // buffers grow to what they need
      low = low == 0 ? now : std::min(low, now);
      high = std::max(high, now);
    }
    stop.request_stop();
    driving.join();
    for (const auto& device : bench.robot().report().devices) {
      for (const auto& [fact, value] : device.facts) {
        fmt::print("{} {}: {}\n", device.name, fact, value);
      }
    }
    fmt::print("{}\n", bench.emulation().truth());
    stored = stored_scans(bench.database());
  }
  truth = read_truth(folder / "truth");
  std::map<std::string, std::size_t> fates;
  for (const SentLine& scan : truth.scans) ++fates[scan.fate];
  const std::size_t found = found_in_order(stored, truth.scans);
  for (const auto& [fate, count] : fates) fmt::print("scans {}: {}\n", fate, count);
  fmt::print("scans stored in the last run: {}, of them not as sent: {}\n",
             stored.size(),
             stored.size() - found);
  fmt::print("memory: {:.1f} to {:.1f} MB after the first minute\n", low, high);
  return high - low <= 2 && found == stored.size() ? 0 : 1;
}

int main_of(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  const std::string more = argc > 3 ? argv[3] : "";
  if (what == "experiments") return experiments(argv[2], more);
  if (what == "faults") return faults(argv[2], more);
  if (what == "soak" && !more.empty()) return soak(argv[2], std::stod(more));
  fmt::print(stderr,
             "hardware_trial experiments FOLDER [exp1-roboteq]\n"
             "hardware_trial faults FOLDER [roboteq]\n"
             "hardware_trial soak FOLDER SECONDS\n");
  return 1;
}

}  // namespace
}  // namespace server::hardware

int main(int argc, char** argv) {
  try {
    return server::hardware::main_of(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "hardware_trial: {}\n", e.what());
    return 1;
  }
}
