// tests/hardware/faults.cpp: each fault in turn while the robot drives, and what it did.
#include <cmath>
#include <cstdio>
#include <optional>
#include <stop_token>
#include <thread>

#include "tests/hardware/bench.hpp"
#include "tests/hardware/fault_table.hpp"
#include "tests/hardware/stored.hpp"
#include "tests/hardware/trials.hpp"
#include <fmt/format.h>

#include "server/emulate/clock.hpp"

namespace server::hardware {
namespace {

namespace fs = std::filesystem;
using emulate::BaseKind;
using emulate::machine_time;

// Ticks take 26 ms. A scan takes 26.7 ms and 14.6 ms on the line.
constexpr double kTick = 0.026;
constexpr double kLine = 0.015;
constexpr double kAwake = 0.02;  // for a thread to wake up

struct Timing {
  double report = 0;    // [s] between two reports of what is wrong, and the way of one
  double watchdog = 0;  // [s] of the base
};
Timing timing(BaseKind base) {
  return base == BaseKind::P2os ? Timing{.report = 0.1 + 0.065, .watchdog = 2.0}
                                : Timing{.report = 0.12 + 0.005, .watchdog = 0.5};
}

/// [s] from the fault to zero wheels, at most; nothing when they must go on.
std::optional<double> limit(Expected expected, BaseKind base) {
  const Timing times = timing(base);
  switch (expected) {
    case Expected::GoOn:
      return std::nullopt;
    case Expected::AfterScans:
      return 3 * 0.0267 + drivers::SerialRobot::kArrivalJitter + kTick + kLine;
    case Expected::AfterBase:
      return drivers::SerialRobot::kBaseTimeout + kTick + kAwake;
    case Expected::AfterReport:
      return times.report + kTick + kAwake;
    case Expected::AfterBattery:
      return 3.0 + times.report + kTick + kAwake;
    case Expected::AfterStorm:
      return 2.0;
    case Expected::AfterBlind:
      return 1.0;
    case Expected::AfterWatchdog:
      return times.watchdog + 0.1;
  }
  return std::nullopt;
}

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

/// What was seen of one fault.
struct Seen {
  std::string said = "never moved";
  std::string recovered = "no";
  double begin = 0;  // [s] of the fault
  double end = 0;    // [s] until which it lasted, or was looked at
};

Seen provoke(const Fault& fault, BaseKind base, Bench& bench) {
  constexpr double kSettled = 0.7;  // [s] after the limit
  Seen seen;
  drivers::SerialRobot& robot = bench.robot();
  const auto moves = [&] { return robot.report().halt == algo::Halt::None; };
  if (!Bench::wait_for(moves, 60)) return seen;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  seen.begin = machine_time();
  bench.emulation().command(fault.command);
  const double window = limit(fault.expected, base).value_or(2.0) + kSettled;
  const bool stopped = Bench::wait_for([&] { return !moves(); }, window);
  if (stopped) std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const drivers::HardwareReport report = robot.report();
  seen.said = report.trouble;
  while (machine_time() < seen.begin + window) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  seen.end = machine_time();
  if (fault.recovery[0] != '\0') bench.emulation().command(fault.recovery);
  if (fault.expected == Expected::GoOn) {
    seen.recovered = "";
  } else if (Bench::wait_for(moves, 5)) {
    seen.recovered = "by itself";
  } else if (bench.arm(30) && Bench::wait_for(moves, 5)) {
    seen.recovered = "armed again";
  }
  return seen;
}

/// `sentence` with the ports of this trial as they might be called elsewhere.
std::string told(std::string sentence, const fs::path& folder) {
  const std::string here = folder.string() + "/";
  for (auto at = sentence.find(here); at != std::string::npos; at = sentence.find(here)) {
    sentence.replace(at, here.size(), "/dev/");
  }
  return sentence;
}

bool trial(const Fault& fault, BaseKind base, const fs::path& folder) {
  Bench bench({.scenario = "exp4", .base = base, .folder = folder});
  std::stop_source stop;
  std::jthread driving([&] { bench.drive(stop.get_token()); });
  Seen seen = provoke(fault, base, bench);
  stop.request_stop();
  driving.join();
  if (seen.said.empty()) {  // the robot's port had nothing against it: what had the pipeline?
    for (const std::string& hold : read_stored(bench.database()).holds) {
      if (hold != "halted") seen.said = "Held: " + hold + ".";
    }
  }
  const auto zero = time_to_zero(read_truth(bench.record()), seen.begin, seen.end);
  const std::optional<double> most = limit(fault.expected, base);
  const bool held = most ? zero && *zero <= *most : seen.begin > 0 && !zero;
  fmt::print("| {} | {} | {} | {} | {} | {} |\n",
             fault.name,
             name_of(base),
             told(seen.said, folder),
             zero ? fmt::format("{:.0f} ms", 1000 * *zero) : "goes on",
             most ? fmt::format("{:.0f} ms", 1000 * *most) : "",
             seen.recovered);
  if (!held) fmt::print(stderr, "{}, {}: not as expected\n", fault.name, name_of(base));
  std::fflush(stdout);
  return held;
}

}  // namespace

bool faults(const fs::path& folder, const std::string& only) {
  fmt::print(
      "| fault | base | what the robot says | zero wheels after | at most | goes on |\n"
      "|---|---|---|---|---|---|\n");
  bool held = true;
  for (const BaseKind base : {BaseKind::Roboteq, BaseKind::P2os}) {
    if (!only.empty() && only != name_of(base)) continue;
    int number = 0;
    for (const Fault& fault : kFaults) {
      const std::string name = fmt::format("fault-{}-{}", name_of(base), number++);
      held = trial(fault, base, folder / name) && held;
    }
  }
  return held;
}

}  // namespace server::hardware
