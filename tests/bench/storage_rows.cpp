// tests/bench/storage_rows.cpp: an hour of ticks written, read back, and looked up.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>
#include <thread>

#include "tests/bench/driving.hpp"
#include "tests/bench/rows.hpp"
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include "db/run_reader.hpp"
#include "db/run_store.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/recorder.hpp"
#include "server/record/run_json.hpp"

namespace bench {
namespace {

constexpr std::size_t kHour = 138'461;  // ticks

struct Stored {
  std::vector<std::byte> bytes{};
  std::vector<db::Window> windows{};
  std::uint64_t tick = 0;
  double time = 0;  // [s]
};

/// Ticks of a drive through W(20), +-`noise` [m] on every beam, as the record gets them.
std::vector<Stored> ticks_of_a_drive(std::size_t count, std::size_t nodes, double noise = 0.015) {
  sim::LaserConfig laser = full_laser();
  laser.noise_shape = sim::NoiseShape::Uniform;
  laser.noise = noise;
  Driving driving(room_scenario(20, sim::PhysicsKind::Kinematic, {laser}));
  server::FrameEncoder encoder;
  std::vector<Stored> ticks;
  while (ticks.size() < count) {
    driving.tick();
    driving.t.ground_truth = driving.world().ground_truth();
    algo::Telemetry t = driving.t;
    if (nodes > 0) stretch_strip(t, nodes, 0.004);
    const auto bytes = encoder.encode(t);
    const auto windows = encoder.windows();
    ticks.push_back({{bytes.begin(), bytes.end()},
                     {windows.begin(), windows.end()},
                     ticks.size(),
                     t.observation.stamp});
  }
  return ticks;
}

/// A temporary folder.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("tautline_bench_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

db::NewRun a_run() {
  db::NewRun run;
  run.scenario = "w20";
  run.document = "{}";
  run.controller = "modified";
  run.filter = "pseudomedian";
  run.physics = "kinematic";
  return run;
}

/// Writes all ticks with one commit a simulated second. @return [s] of wall time
double write_all(const std::string& path, const std::vector<Stored>& ticks, std::uint64_t& bytes) {
  db::RunStore store(path);
  const db::RunId run = store.begin_run(a_run());
  store.commit();
  const std::uint64_t before = store.used_bytes();
  const double begin = wall();
  double second = 1;
  for (const Stored& tick : ticks) {
    if (tick.time >= second) {
      store.commit();
      second += 1;
    }
    store.append_tick(run, tick.tick, tick.time, tick.bytes, tick.windows);
  }
  db::RunEnd end;
  end.outcome = "stopped";
  store.end_run(run, end);
  store.commit();
  const double took = wall() - begin;
  bytes = store.used_bytes() - before;
  return took;
}

/// Reads everything back and compares it with the written ticks, value by value.
void check_read_back(const std::string& path, const std::vector<Stored>& ticks) {
  db::RunReader reader(path);
  std::size_t i = 0;
  reader.frames(1, 0, ticks.size() + 1, [&](std::uint64_t tick, std::span<const std::byte> frame) {
    require(i < ticks.size() && tick == i && std::ranges::equal(frame, ticks[i].bytes),
            fmt::format("P20: tick {} reads back differently", i));
    ++i;
  });
  require(i == ticks.size(), fmt::format("P20: {} of {} ticks read back", i, ticks.size()));
}

void replay(Pass& pass, const std::string& path, std::size_t count) {
  std::vector<double> all;
  for (int repetition = 0; repetition < pass.count(5, 1); ++repetition) {
    db::RunReader reader(path);
    std::size_t bytes = 0;
    const double begin = wall();
    reader.frames(1, 0, count, [&](std::uint64_t /*tick*/, std::span<const std::byte> frame) {
      bytes += frame.size();
    });
    all.push_back(wall() - begin);
    require(bytes > 0, "P21: nothing was read");
  }
  pass.add({.row = "P21",
            .name = "one hour in order",
            .value = median(all),
            .unit = "s",
            .better = Better::Lower,
            .floor = 1,
            .stretch = 0.3,
            .noise = spread(all),
            .note = "wall time, median of 5"});

  std::mt19937_64 random(5);
  db::RunReader reader(path);
  std::vector<double> seeks;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t wanted = random() % count;
    std::uint64_t found = count;
    const double begin = wall();
    reader.frames(1, wanted, 1, [&](std::uint64_t tick, std::span<const std::byte> /*frame*/) {
      found = tick;
    });
    seeks.push_back(1e3 * (wall() - begin));
    require(found == wanted, "P21: a seek found another tick");
  }
  const double middle = median(seeks);
  pass.add({.row = "P21",
            .name = "seek, p99 of 100",
            .value = quantile(seeks, 0.99),
            .unit = "ms",
            .better = Better::Lower,
            .floor = 2,
            .note = fmt::format("median {:.2f} ms", middle)});
}

/// A frame that belongs to the benchmark.
class BorrowedFrame final : public server::RecordedFrame {
 public:
  explicit BorrowedFrame(const Stored& stored) : stored_(stored) {}
  std::span<const std::byte> bytes() const override { return stored_.bytes; }
  std::span<const db::Window> windows() const override { return stored_.windows; }
  std::uint64_t tick() const override { return stored_.tick; }
  double time() const override { return stored_.time; }
  void release() noexcept override {}

 private:
  const Stored& stored_;
};

/// Number of involuntary context switches of this thread.
long preemptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

/// Pushes everything through the recorder at full speed, and finds the longest push. Pushes during
/// which the system ran another thread are left out.
void stalls(Pass& pass, const std::string& path, const std::vector<Stored>& ticks) {
  std::vector<BorrowedFrame> frames;
  frames.reserve(ticks.size());
  for (const Stored& tick : ticks) frames.emplace_back(tick);
  double longest = 0;
  double longest_of_all = 0;
  const double begin = wall();
  {
    server::Recorder recorder(path);
    const auto channel = recorder.open(a_run());
    for (BorrowedFrame& frame : frames) {
      server::FrameHandle handle(&frame);
      bool taken = false;
      while (!taken) {
        const long before = preemptions();
        const double start = wall();
        taken = channel->push(handle);
        const double took = wall() - start;
        longest_of_all = std::max(longest_of_all, took);
        if (preemptions() == before) longest = std::max(longest, took);
        if (!taken) std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
    }
    db::RunEnd end;
    end.outcome = "stopped";
    channel->close(end);
    recorder.flush();
    require(!channel->failed(), "P19: the recorder failed: " + channel->problem());
  }
  const double took = wall() - begin;
  check_read_back(path, ticks);
  pass.add({.row = "P19",
            .name = "longest stall of the control thread",
            .value = 1e3 * longest,
            .unit = "ms",
            .better = Better::Lower,
            .floor = 0.2,
            .note = fmt::format("of {} pushes; {:.2f} ms with those the system interrupted",
                                ticks.size(),
                                1e3 * longest_of_all)});
  pass.add({.row = "P19",
            .name = "through the recorder's thread",
            .value = static_cast<double>(ticks.size()) / took,
            .unit = "rows/s"});
}

/// [MB] per hour for this many bytes per tick.
double hourly(std::uint64_t bytes, std::size_t ticks) {
  return static_cast<double>(bytes) / 1e6 * static_cast<double>(kHour) / static_cast<double>(ticks);
}

/// The size of an hour without noise.
void storage_without_noise(Pass& pass, const Folder& folder, std::size_t count) {
  std::uint64_t bytes = 0;
  write_all(folder.file("quiet.db"), ticks_of_a_drive(count, 0, 0.0), bytes);
  pass.add_detail("P20", "the same without noise", hourly(bytes, count), "MB");
}

}  // namespace

void storage(Pass& pass) {
  const Folder folder;
  const std::size_t count = pass.count<std::size_t>(kHour, 1500);
  std::uint64_t bytes = 0;
  {
    const auto ticks = ticks_of_a_drive(count, 50);
    write_all(folder.file("long.db"), ticks, bytes);
    check_read_back(folder.file("long.db"), ticks);
    pass.add({.row = "P20",
              .name = "an hour, strip of 50 nodes",
              .value = hourly(bytes, count),
              .unit = "MB",
              .better = Better::Lower,
              .floor = 75,
              .stretch = 55,
              .note = "padded: about what `strip` lays"});
  }
  const auto ticks = ticks_of_a_drive(count, 0);
  std::vector<double> rates;
  for (int repetition = 0; repetition < pass.count(5, 1); ++repetition) {
    const std::string path = folder.file(fmt::format("hour{}.db", repetition));
    rates.push_back(static_cast<double>(count) / write_all(path, ticks, bytes));
  }
  check_read_back(folder.file("hour0.db"), ticks);
  pass.add({.row = "P19",
            .name = "storing an hour",
            .value = median(rates),
            .unit = "rows/s",
            .floor = 20'000,
            .stretch = 60'000,
            .noise = spread(rates),
            .note = "WAL, FULL, a commit a simulated second; wall time, median of 5"});
  stalls(pass, folder.file("recorded.db"), ticks);
  pass.add({.row = "P20",
            .name = "an hour, the controller's strip",
            .value = hourly(bytes, count),
            .unit = "MB",
            .better = Better::Lower,
            .floor = 75,
            .stretch = 55,
            .note = "read back and compared value by value"});
  storage_without_noise(pass, folder, count);
  replay(pass, folder.file("hour0.db"), count);
}

}  // namespace bench
