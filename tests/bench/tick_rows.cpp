// tests/bench/tick_rows.cpp: whole ticks of the simulated robot, and the control tick alone.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/algo/allocations.hpp"
#include "tests/bench/driving.hpp"
#include "tests/bench/rows.hpp"
#include "tests/sim/bullet_room.hpp"
#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <sched.h>

#include "sim/random.hpp"

namespace bench {
namespace {

using sim::PhysicsKind;

/// The same robot, its scan taken by Bullet's rays: from one pose, then the same noise and
/// rounding.
class ReferenceDriving {
 public:
  explicit ReferenceDriving(PhysicsKind physics)
      : scenario_(room_scenario(20, physics, {})),
        driving_(scenario_),
        room_(scenario_.obstacles) {}

  void tick() {
    driving_.sense();
    scan(driving_.truth(), kNoise, driving_.t.observation);
    driving_.control();
  }
  /// Puts Bullet's scan from `pose` into `observation`.
  void scan(const algo::Pose2& pose, double noise, algo::Observation& observation) {
    observation.scans.clear();
    algo::LaserScan& scan = observation.scans.append();
    scan.mount_R = {};
    scan.stamp = observation.stamp;
    scan.angle_min = bearing(0);
    scan.angle_increment = half_turn().angle_increment;
    scan.range_max = kNearRange;
    scan.turn_period = 0;
    scan.turns = 1;
    scan.resize(kBeams);
    random_.fill_normal(draws_);
    for (std::size_t i = 0; i < kBeams; ++i) {
      const double range =
          room_.range(pose.position(), pose.heading + bearing(i), kNearRange) + noise * draws_[i];
      if (range < kNearRange) {
        scan.set_ok(i, range);
      } else {
        scan.set_free(i);
      }
    }
    algo::quantise(scan);
  }

 private:
  static constexpr double kNoise = 0.005;  // [m]
  sim::Scenario scenario_;
  Driving driving_;
  reference::BulletRoom room_;
  sim::Random random_{1};
  std::vector<double> draws_ = std::vector<double>(kBeams);
};

/// With an ideal scanner both have the same scans and commands, tick by tick.
void check_ticks(PhysicsKind physics, int ticks, const std::string& row) {
  sim::LaserConfig ideal = sim::LaserConfig::ideal(0.5);
  ideal.height = kPlane;
  Driving ours(room_scenario(20, physics, {ideal}));
  ReferenceDriving theirs(physics);
  algo::Pipeline pipeline = make_pipeline(ours.world().spec());
  pipeline.reset(ours.t.observation.odometry.pose);
  algo::Telemetry t;
  int beams_off = 0;
  int commands_off = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    ours.tick();
    t.observation = ours.t.observation;
    t.requests = ours.t.requests;
    theirs.scan(ours.truth(), 0, t.observation);
    const auto& a = ours.t.observation.scans[0].ranges;
    const auto& b = t.observation.scans[0].ranges;
    for (std::size_t i = 0; i < kBeams; ++i) beams_off += std::abs(a[i] - b[i]) > 0.0011 ? 1 : 0;
    pipeline.tick(t);
    const algo::Twist2& mine = ours.t.command.base;
    const algo::Twist2& other = t.command.base;
    if (std::abs(mine.v - other.v) + std::abs(mine.omega - other.omega) > 0.02) ++commands_off;
  }
  require(beams_off <= ticks,
          fmt::format("{}: {} beams differ in {} ticks", row, beams_off, ticks));
  require(commands_off <= ticks / 50,
          fmt::format("{}: {} of {} commands differ", row, commands_off, ticks));
}

/// A world driven in a circle by a fixed command, to time it without control.
class Circling {
 public:
  explicit Circling(const sim::Scenario& scenario) : world_(scenario, 1) { world_.reset(seen_); }
  void step() { world_.step({{0.3, 0.6}}, seen_); }
  algo::Pose2 pose() const { return seen_.odometry.pose; }

 private:
  sim::World world_;
  algo::Observation seen_{};
};

/// The parts of our tick's time: the world with fewer and fewer scanner effects, driven in a
/// circle. Beside Bullet's physics the scanner's parts are less than the noise of the machine.
void shares(Pass& pass, PhysicsKind physics, const std::string& row, double whole) {
  const auto share = [&](const std::string& name, double seconds) {
    pass.add_detail(
        row, name, 1e6 * seconds, "us", fmt::format("{:.0f} % of the tick", 100 * seconds / whole));
  };
  sim::LaserConfig smooth = full_laser();
  smooth.noise = 0;
  sim::LaserConfig clean = smooth;
  clean.mixed_pixels = false;
  clean.dropout = 0;
  Circling full(room_scenario(20, physics, {full_laser()}));
  Circling silent(room_scenario(20, physics, {smooth}));
  Circling bare(room_scenario(20, physics, {clean}));
  Circling blind(room_scenario(20, physics, {}));
  const auto times = pass.time(row + " share",
                               {{"full", [&] { full.step(); }},
                                {"silent", [&] { silent.step(); }},
                                {"bare", [&] { bare.step(); }},
                                {"blind", [&] { blind.step(); }}});
  share("of it vehicle and odometry", times[3].seconds);
  if (physics == PhysicsKind::Bullet) return;
  share("of it scan, rolling sweep", times[2].seconds - times[3].seconds);
  share("of it scan, spots and mixed pixels", times[1].seconds - times[2].seconds);
  share("of it scan, noise", times[0].seconds - times[1].seconds);
  share("of it filter and control", whole - times[0].seconds);
}

void time_tick(Pass& pass, PhysicsKind physics, Figure figure) {
  check_ticks(physics, pass.count(600, 100), figure.row);
  Driving ours(room_scenario(20, physics, {full_laser()}));
  ReferenceDriving theirs(physics);
  const auto times =
      pass.time(figure.row, {{"ours", [&] { ours.tick(); }}, {"bullet", [&] { theirs.tick(); }}});
  const std::string row = figure.row;
  pass.add_ratio(std::move(figure), times[0], times[1]);
  if (!pass.quick()) shares(pass, physics, row, times[0].seconds);
}

void many_obstacles(Pass& pass) {
  Circling few(room_scenario(20, PhysicsKind::Bullet, {}));
  Circling many(room_scenario(1000, PhysicsKind::Bullet, {}));
  for (int tick = 0; tick < pass.count(800, 100); ++tick) {
    few.step();
    many.step();
    require((few.pose().position() - many.pose().position()).norm() < 1e-6,
            "P11: far obstacles change how the robot drives");
  }
  const auto times =
      pass.time("P11", {{"many", [&] { many.step(); }}, {"few", [&] { few.step(); }}});
  pass.add(
      {.row = "P11",
       .name = "step in W(1000) over W(20)",
       .value = times[0].seconds / times[1].seconds,
       .unit = "x",
       .better = Better::Lower,
       .floor = 1.5,
       .stretch = 1.1,
       .noise = times[0].spread + times[1].spread,
       .note = fmt::format("{} over {}", duration(times[0].seconds), duration(times[1].seconds))});
}

/// Pins the thread to its present processor while this object exists.
class Pinned {
 public:
  Pinned() {
    held_ = sched_getaffinity(0, sizeof before_, &before_) == 0;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(std::max(0, sched_getcpu())), &one);
    held_ = held_ && sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~Pinned() {
    if (held_) sched_setaffinity(0, sizeof before_, &before_);
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;
  bool held() const { return held_; }

 private:
  cpu_set_t before_{};
  bool held_ = false;
};

/// Ticks of a drive with their commands, to feed to a fresh pipeline.
struct Recording {
  explicit Recording(std::size_t count) {
    Driving driving(room_scenario(20, PhysicsKind::Kinematic, {full_laser()}));
    spec = driving.world().spec();
    start = driving.t.observation.odometry.pose;
    for (std::size_t i = 0; i < count; ++i) {
      ticks.push_back(driving.t);
      commands.push_back(driving.t.command);
      driving.tick();
    }
  }
  algo::RobotSpec spec{};
  algo::Pose2 start{};
  std::vector<algo::Telemetry> ticks{};
  std::vector<algo::Command> commands{};
};

}  // namespace

void ticks(Pass& pass) {
  time_tick(pass,
            PhysicsKind::Bullet,
            {.row = "P6",
             .name = "tick, full physics",
             .floor = 9,
             .stretch = 14,
             .note = "full sensor model, the controller's 3-node strip"});
  time_tick(pass,
            PhysicsKind::Kinematic,
            {.row = "P7",
             .name = "tick, kinematic",
             .floor = 100,
             .stretch = 220,
             .note = "full sensor model, the controller's 3-node strip"});
  many_obstacles(pass);
}

void control(Pass& pass) {
  using Clock = std::chrono::steady_clock;
  Recording record(300);
  algo::Pipeline pipeline = make_pipeline(record.spec);
  const auto total = pass.count<std::size_t>(1'000'000, 1500);
  std::vector<double> seconds(total);
  std::size_t allocated = 0;
  double cpu = 0;
  constexpr std::size_t kWarm = 10;  // after a reset the first scans grow the buffers
  // A live run's ticks come from a pool with grown buffers; one pass grows these too.
  pipeline.reset(record.start);
  for (algo::Telemetry& t : record.ticks) pipeline.tick(t);
  const Pinned pinned;
  for (std::size_t done = 0; done < total;) {
    pipeline.reset(record.start);
    std::size_t before = 0;
    const double cpu_before = thread_cpu();
    for (std::size_t i = 0; i < record.ticks.size() && done < total; ++i, ++done) {
      if (i == kWarm) before = allocations::count();
      const auto begin = Clock::now();
      pipeline.tick(record.ticks[i]);
      seconds[done] = std::chrono::duration<double>(Clock::now() - begin).count();
      if (record.ticks[i].command != record.commands[i]) {
        throw Disagreement("P13: a recorded tick fed again gives another command");
      }
    }
    cpu += thread_cpu() - cpu_before;
    allocated += allocations::count() - before;
  }
  require(allocated == 0, fmt::format("P13: {} heap allocations in the control tick", allocated));
  const std::string how = pinned.held() ? "pinned" : "not pinned, which the system did not allow";
  const std::string note = "N = 2, the controller's 3-node strip, " + how;
  pass.add({.row = "P13",
            .name = "control tick, mean CPU",
            .value = 1e6 * cpu / static_cast<double>(total),
            .unit = "us",
            .better = Better::Lower,
            .floor = 5,
            .stretch = 1.5,
            .note = note});
  const double middle = median(seconds);
  const double p999 = quantile(seconds, 0.999);
  pass.add({.row = "P13",
            .name = "control tick, p99.9",
            .value = 1e6 * p999,
            .unit = "us",
            .better = Better::Lower,
            .floor = 50,
            .note = fmt::format("of {} ticks, wall time; p50 {}", total, duration(middle))});
  pass.add({.row = "P13",
            .name = "control tick, heap allocations",
            .value = static_cast<double>(allocated),
            .unit = "",
            .better = Better::Lower,
            .floor = 0,
            .stretch = 0,
            .note = "counted by a replaced operator new"});
}

}  // namespace bench
