// server/lab/crowd/crossing.cpp: people come, walk and go while the robot drives.
#include "server/lab/crowd/crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/pipeline/pipeline.hpp"
#include "server/run/run_spec.hpp"
#include "sim/world.hpp"

namespace server::crowd {
namespace {

constexpr double kEdge = 0.5;      // [m] of start and goal inside the rectangle
constexpr double kLastBegin = 60;  // [s] before the end of the recording
constexpr double kTouch = 1e-3;    // [m] at which the physics keeps bodies apart

/// The recorded people in the robot's world.
class Crowd {
 public:
  Crowd(const Recording& recording, double begin, double period)
      : recording_(recording), begin_(begin), period_(period), state_(recording.walkers.size()) {}

  /// Lets people in and out for the tick at `now` [s, run clock], before the world makes it.
  void update(sim::World& world, double now) {
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const Walker& walker = recording_.walkers[i];
      const bool there = walker.there(begin_ + now);
      if (state_[i] == State::Away && there) enter(world, i, now);
      if (state_[i] == State::Here && !there) leave(world, i, State::Away);
    }
  }

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  // [m] from hull to disc
    std::size_t walker = 0;
  };
  /// Of a robot with `hull` at `pose_W`.
  Nearest nearest(const algo::Hull& hull, const algo::Pose2& pose_W, double now) const {
    Nearest found;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      if (state_[i] != State::Here) continue;
      const algo::Vec2 p_R = algo::to_child(pose_W, recording_.walkers[i].at(begin_ + now));
      const double outline = hull.is_disc()
                                 ? p_R.norm() - hull.radius
                                 : algo::to_rectangle(p_R, hull.half_length, hull.half_width);
      if (outline - kPersonRadius < found.distance) found = {outline - kPersonRadius, i};
    }
    return found;
  }

  /// Takes somebody out until the end.
  void take_out(sim::World& world, std::size_t walker) { leave(world, walker, State::Gone); }

 private:
  enum class State : std::uint8_t { Away, Here, LeftOut, Gone };

  static std::uint32_t id_of(std::size_t walker) { return static_cast<std::uint32_t>(walker + 1); }

  void enter(sim::World& world, std::size_t i, double now) {
    const Walker& walker = recording_.walkers[i];
    const algo::Vec2 at_W = walker.at(begin_ + now);
    if ((at_W - world.pose_W().position()).norm() < kLeftOut) {
      state_[i] = State::LeftOut;
      return;
    }
    algo::Obstacle person{.id = id_of(i),
                          .pose_W = {at_W.x(), at_W.y(), 0},
                          .shape = algo::Cylinder{kPersonRadius},
                          .height = kPersonHeight};
    person.path = path_of(walker);
    if (const auto why = world.edit(algo::AddObstacle{person})) throw std::runtime_error(*why);
    state_[i] = State::Here;
  }

  /// The world's clock begins with the crossing.
  algo::ObstaclePath path_of(const Walker& walker) const {
    algo::ObstaclePath path{.period = walker.until() - begin_ + 2 * period_};
    path.keys.push_back({0, walker.at(begin_)});
    for (const auto& key : walker.keys) {
      if (key.time > begin_) path.keys.push_back({key.time - begin_, key.position_W});
    }
    return path;
  }

  void leave(sim::World& world, std::size_t i, State next) {
    if (const auto why = world.edit(algo::RemoveObstacle{id_of(i)})) throw std::runtime_error(*why);
    state_[i] = next;
  }

  const Recording& recording_;
  double begin_;
  double period_;
  std::vector<State> state_;
};

RunSpec run_of(RunSpec run, const Way& way) {
  sim::Scenario& scene = run.scenario;
  scene.obstacles.clear();
  scene.robots.clear();
  scene.waypoints.clear();
  scene.start = way.start_W;
  scene.goal = algo::SetGoal{way.goal_W, std::nullopt};
  return run;
}

/// One tick's share of a crossing's figures. @return true if the crossing is over
bool judge(Crossing& end,
           const Crowd::Nearest& nearest,
           double speed,
           double period,
           sim::World& world,
           Crowd& crowd) {
  if (nearest.distance < kIntrusion) end.intrusion += period;
  if (nearest.distance < kPersonalSpace) end.personal += period;
  if (std::isinf(nearest.distance)) return false;  // the last one has gone in this tick
  // Bodies that touch within a tick may have bounced apart at its end.
  if (nearest.distance > kTouch && !world.ground_truth()->collided) return false;
  if (speed >= kMovingSpeed) {
    end.moving_contact = true;
    return true;
  }
  ++end.contacts_at_rest;
  crowd.take_out(world, nearest.walker);
  return false;
}

/// Way `k` at the begin of the recording.
Way way_through(const Recording& recording, std::size_t k) {
  const algo::Vec2 size = recording.high - recording.low;
  if (size.minCoeff() < 4 * kEdge) {
    throw std::runtime_error(
        fmt::format("{}: its people stay within {:.1f} x {:.1f} m; a crossing needs {:.0f} m",
                    recording.name,
                    size.x(),
                    size.y(),
                    4 * kEdge));
  }
  const algo::Vec2 middle = (recording.low + recording.high) / 2;
  const double heading = std::numbers::pi / 2 * static_cast<double>(k % 4);
  const std::array<algo::Vec2, 4> ways{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  const algo::Vec2& ahead = ways.at(k % 4);
  const algo::Vec2 half = ahead * (std::abs(ahead.dot(size)) / 2 - kEdge);
  const algo::Vec2 start = middle - half;
  return {.start_W = {start.x(), start.y(), algo::wrap_angle(heading)},
          .goal_W = middle + half,
          .begin = recording.from};
}

}  // namespace

Way first_way(const Recording& recording) {
  return way_through(recording, 0);
}

Way way_of(const Recording& recording, std::size_t k) {
  Way way = way_through(recording, k);
  const double span = recording.until - recording.from - kLastBegin;
  if (span < 0) {
    throw std::runtime_error(fmt::format("{} lasts {:.0f} s; the crossings need {:.0f} s",
                                         recording.name,
                                         recording.until - recording.from,
                                         kLastBegin));
  }
  way.begin += static_cast<double>(k) * span / (kCrossings - 1);
  return way;
}

Crossing cross(const Recording& recording, const Way& way, const RunSpec& robot, Driver driver) {
  const RunSpec run = run_of(robot, way);
  sim::World world(run.scenario, run.seed);
  algo::Pipeline pipeline(pipeline_config(run), world.spec());
  const double period = world.spec().period;
  Crowd crowd(recording, way.begin, period);
  algo::Telemetry t;
  world.reset(t.observation);
  pipeline.reset(t.observation.odometry.pose);
  if (driver != Driver::Alone) crowd.update(world, 0);
  world.read(t.observation);
  t.requests.push_back(*run.scenario.goal);
  Crossing end;
  end.track_W.push_back(world.pose_W());
  double speed = 0;  // [m/s] of the tick before: somebody who walks into a robot also pushes it
  double room = std::numeric_limits<double>::infinity();  // [m] to the nearest person
  while (end.time < kMostTime) {
    pipeline.tick(t);
    t.requests.clear();
    const bool stands = driver == Driver::Standing && room < kStandingRoom;
    const double now = end.time + period;
    if (driver != Driver::Alone) crowd.update(world, now);
    world.step(stands ? algo::Command{} : t.command, t.observation);
    end.time = t.observation.stamp;
    const algo::Pose2 before_W = end.track_W.back();
    end.track_W.push_back(world.pose_W());
    const Crowd::Nearest nearest = crowd.nearest(world.hull(), world.pose_W(), end.time);
    if (judge(end, nearest, speed, period, world, crowd)) break;
    room = nearest.distance;
    speed = (world.pose_W().position() - before_W.position()).norm() / period;
    end.crossed = (world.pose_W().position() - way.goal_W).norm() <= kGoalReach;
    if (end.crossed) break;
  }
  return end;
}

}  // namespace server::crowd
