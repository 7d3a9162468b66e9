// tests/bench/fleet_rows.cpp: a hundred robots in one room, each seeing and avoiding the others.
#include <algorithm>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "tests/bench/rooms.hpp"
#include "tests/bench/rows.hpp"
#include <fmt/core.h>

#include "algo/pipeline/pipeline.hpp"
#include "sim/fleet.hpp"

namespace bench {
namespace {

using sim::PhysicsKind;

constexpr std::size_t kRobots = 100;
constexpr std::uint32_t kAsMany = 180;  // obstacles of the W(K) whose room is 30 m wide
constexpr std::size_t kObstacles = 20;  // of these are kept
constexpr double kHalf = 15;            // [m] of the room

/// The room with 20 obstacles and walls.
std::vector<algo::Obstacle> hall() {
  std::vector<algo::Obstacle> world = reference::room(kAsMany);
  world.erase(world.begin() + kObstacles, world.begin() + kAsMany);
  return world;
}

/// Places in the hall at least `clear` [m] from every surface.
class Places {
 public:
  Places(const std::vector<algo::Obstacle>& world, std::uint64_t seed) : random_(seed) {
    for (const algo::Obstacle& obstacle : world) set_.add(obstacle);
  }
  algo::Vec2 next(double clear) {
    for (;;) {
      const algo::Vec2 p{reference::uniform(random_, -kHalf, kHalf),
                         reference::uniform(random_, -kHalf, kHalf)};
      if (set_.distance(p) > clear) return p;
    }
  }
  double heading() { return reference::uniform(random_, -std::numbers::pi, std::numbers::pi); }

 private:
  std::mt19937_64 random_;
  sim::ObstacleSet set_{};
};

sim::Scenario hall_scenario(PhysicsKind physics, const sim::LaserConfig& laser) {
  sim::Scenario scenario;
  scenario.name = "hall";
  scenario.physics = physics;
  scenario.period = kTick;
  scenario.obstacles = hall();
  scenario.robot.sensors.lasers = {laser};
  Places places(scenario.obstacles, 11);
  std::vector<algo::Pose2> starts;
  while (starts.size() < kRobots) {
    const algo::Vec2 p = places.next(0.5);
    const bool free = std::ranges::all_of(
        starts, [&](const algo::Pose2& other) { return (other.position() - p).norm() > 1.0; });
    if (free) starts.push_back({p.x(), p.y(), places.heading()});
  }
  scenario.start = starts.front();
  for (std::size_t k = 1; k < kRobots; ++k) scenario.robots.emplace_back().start = starts[k];
  return scenario;
}

/// All robots with their pipelines; one that has arrived, or is stuck, gets another goal.
class Crowd {
 public:
  explicit Crowd(const sim::Scenario& scenario)
      : fleet_(scenario, 1), places_(scenario.obstacles, 12) {
    algo::PipelineConfig config;
    config.parameters.set(algo::kFilterHalfWidth, 2);
    config.by_hand = false;
    ticks_.resize(fleet_.size());
    for (std::size_t k = 0; k < fleet_.size(); ++k) {
      pipelines_.emplace_back(config, fleet_.robot(k).spec());
      fleet_.read(k, ticks_[k].observation);
      pipelines_[k].reset(ticks_[k].observation.odometry.pose);
      control(k);
    }
  }
  void tick() {
    for (std::size_t k = 0; k < fleet_.size(); ++k) fleet_.write(k, ticks_[k].command);
    fleet_.advance();
    for (std::size_t k = 0; k < fleet_.size(); ++k) {
      fleet_.read(k, ticks_[k].observation);
      control(k);
    }
  }
  sim::Fleet& fleet() { return fleet_; }
  const algo::Telemetry& telemetry(std::size_t k) const { return ticks_[k]; }
  /// The number of driving robots.
  double driving() const {
    const auto drives = [](const algo::Telemetry& t) { return t.command.base != algo::Twist2{}; };
    return static_cast<double>(std::ranges::count_if(ticks_, drives)) / kRobots;
  }

 private:
  void control(std::size_t k) {
    algo::Telemetry& t = ticks_[k];
    t.requests.clear();
    if (t.mission != algo::Mission::Driving) {
      t.requests.push_back(algo::SetGoal{places_.next(0.6), std::nullopt});
    }
    pipelines_[k].tick(t);
  }

  sim::Fleet fleet_;
  Places places_;
  std::vector<algo::Pipeline> pipelines_{};
  std::vector<algo::Telemetry> ticks_{};
};

/// With an ideal scanner every robot sees obstacles and robots at their true positions.
void check_sight(int ticks) {
  sim::LaserConfig ideal = sim::LaserConfig::ideal(0.5);
  ideal.height = kPlane;
  const sim::Scenario scenario = hall_scenario(PhysicsKind::Kinematic, ideal);
  Crowd crowd(scenario);
  std::size_t off = 0;
  std::size_t met = 0;  // beams that end at a robot
  for (int tick = 0; tick < ticks; ++tick) {
    crowd.tick();
    std::vector<algo::Obstacle> all = scenario.obstacles;
    for (std::size_t k = 0; k < kRobots; ++k) {
      const algo::Pose2& pose_W = crowd.fleet().robot(k).pose_W();
      all.push_back(sim::robot_body(scenario.robot, pose_W));
    }
    for (std::size_t k = static_cast<std::size_t>(tick) % 7; k < kRobots; k += 7) {
      const algo::Pose2& pose_W = crowd.fleet().robot(k).pose_W();
      std::vector<algo::Obstacle> others = all;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(scenario.obstacles.size() + k));
      const algo::LaserScan& scan = crowd.telemetry(k).observation.scans[0];
      for (std::size_t i = 0; i < kBeams; i += 5) {
        const double angle = pose_W.heading + bearing(i);
        const double range =
            scan.status[i] == algo::Beam::Ok ? scan.ranges[i] : static_cast<double>(kNearRange);
        if (!reference::agrees(others, pose_W.position(), angle, kNearRange, range, 1e-3)) ++off;
        const double empty =
            reference::range(scenario.obstacles, pose_W.position(), angle, kNearRange);
        if (range < empty - 0.01) ++met;
      }
    }
  }
  require(off == 0, fmt::format("P10: {} beams differ from the true range", off));
  require(met > 100, fmt::format("P10: only {} beams meet a robot", met));
}

/// [s] of the run clock per second of CPU time.
void add_rate(Pass& pass, Figure figure, const Timing& tick, const Crowd& crowd) {
  figure.value = kTick / tick.seconds;
  figure.unit = "s/s";
  figure.noise = tick.spread;
  figure.note = fmt::format("{} a robot and tick, one thread; {:.0f} % of them drive",
                            duration(tick.seconds / kRobots),
                            100 * crowd.driving());
  pass.add(std::move(figure));
}

}  // namespace

void fleets(Pass& pass) {
  check_sight(pass.count(60, 8));
  Crowd full(hall_scenario(PhysicsKind::Bullet, full_laser()));
  Crowd flat(hall_scenario(PhysicsKind::Kinematic, full_laser()));
  for (int tick = 0; tick < pass.count(150, 3); ++tick) {  // until all are driving
    full.tick();
    flat.tick();
  }
  const auto times =
      pass.time("P10", {{"full", [&] { full.tick(); }}, {"kinematic", [&] { flat.tick(); }}});
  add_rate(pass,
           {.row = "P10", .name = "100 robots, full physics", .floor = 3, .stretch = 6},
           times[0],
           full);
  add_rate(pass,
           {.row = "P10", .name = "100 robots, kinematic", .floor = 15, .stretch = 40},
           times[1],
           flat);
}

}  // namespace bench
