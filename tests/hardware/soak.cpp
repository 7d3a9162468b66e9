// tests/hardware/soak.cpp: half an hour of damaged telegrams: memory, and the fate of each scan.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <stop_token>
#include <thread>

#include "tests/hardware/bench.hpp"
#include "tests/hardware/stored.hpp"
#include "tests/hardware/trials.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "server/emulate/clock.hpp"

namespace server::hardware {
namespace {

using emulate::machine_time;

constexpr double kMostGrowth = 2.0;  // [MB]
constexpr double kWarm = 60;         // [s] buffers grow to what they need

/// [MB] of memory in use.
double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

struct Memory {
  double low = 0;
  double high = 0;
};

/// Prints a line per minute, which shows growth.
Memory watch(double seconds) {
  Memory memory;
  const double begin = machine_time();
  double told = begin;
  while (machine_time() - begin < seconds) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double now = resident_megabytes();
    if (machine_time() - told >= 60) {
      told += 60;
      fmt::print("{:.0f} s: {:.2f} MB\n", machine_time() - begin, now);
      std::fflush(stdout);
    }
    if (machine_time() - begin < kWarm) continue;
    memory.low = memory.low == 0 ? now : std::min(memory.low, now);
    memory.high = std::max(memory.high, now);
  }
  return memory;
}

std::uint64_t fact(const algo::HealthReport& report, std::string_view wanted) {
  for (const auto& [name, value] : report.devices.front().facts) {
    if (name == wanted) return std::stoull(value);
  }
  return 0;
}

}  // namespace

bool soak(const std::filesystem::path& folder, double seconds) {
  // A goal too far to reach in the time, so that one run drives throughout.
  const algo::Vec2 far_W{100, 0};
  Memory memory;
  std::uint64_t sent = 0;  // intact, when the drivers are queried; the emulator goes on afterwards
  std::uint64_t received = 0;
  std::uint64_t replaced = 0;
  StoredRun stored;
  {
    Bench bench({.scenario = "exp1", .folder = folder, .damage = 0.01, .goal_W = far_W});
    std::stop_source stop;
    std::jthread driving([&] { bench.drive(stop.get_token()); });
    memory = watch(seconds);
    stop.request_stop();
    driving.join();
    const algo::HealthReport report = bench.robot().health();
    for (const auto& device : report.devices) {
      for (const auto& [name, value] : device.facts) {
        fmt::print("{} {}: {}\n", device.name, name, value);
      }
    }
    received = fact(report, "scans");
    replaced = fact(report, "scans never read");
    const std::string counts = bench.emulation().truth();
    fmt::print("{}\n", counts);
    sent = nlohmann::json::parse(counts).at("scanner").at("sent");
    stored = read_stored(bench.database());
  }
  const Truth truth = read_truth(folder / "truth");
  std::map<std::string, std::size_t> fates;
  for (const SentLine& scan : truth.scans) ++fates[scan.fate];
  for (const auto& [fate, count] : fates) fmt::print("scans {}: {}\n", fate, count);
  const std::size_t found = found_in_order(stored.scans, truth.scans);
  const std::size_t kept = stored.scans.size();
  fmt::print("scans received: {}, stored: {}, of them not as sent: {}, never read: {}\n",
             received,
             kept,
             kept - found,
             replaced);
  fmt::print("memory after the first minute: {:.2f} to {:.2f} MB\n", memory.low, memory.high);
  // Between the two reports a few more scans were sent and received, before and after the run.
  const bool all_there = received - (kept + replaced) <= 20 && sent - received <= 20;
  return memory.high - memory.low <= kMostGrowth && found == kept && all_there;
}

}  // namespace server::hardware
