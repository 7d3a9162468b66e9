// server/experiment/worlds.cpp: one pipeline and one robot a world.
#include "server/experiment/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace server::experiment {
namespace {

constexpr double kLastWorldSeed = 0x1p53 - 1;

/// Drives as it is told.
class ToldController final : public algo::Controller {
 public:
  explicit ToldController(const algo::Twist2& twist) : twist_(twist) {}
  void reset(const algo::Pose2& /*start_W*/) override {}
  void update(const algo::ControlInput& in,
              const algo::Parameters& /*parameters*/,
              algo::ControlOutput& out) override {
    out.clear();
    if (in.goal) out.twist = twist_;
  }
  void explain(const algo::Telemetry& /*t*/, algo::Explanation& words) const override {
    words = {};
  }

 private:
  const algo::Twist2& twist_;
};

algo::ControllerCatalogue told_by(const algo::Twist2& twist) {
  return algo::ControllerCatalogue(
      {{.name = "told", .make = [&twist] { return std::make_unique<ToldController>(twist); }}});
}

algo::PipelineConfig told_config(const RunSpec& spec) {
  algo::PipelineConfig config = pipeline_config(spec);
  config.controller = "told";
  config.by_hand = false;
  return config;
}

}  // namespace

class Worlds::World {
 public:
  explicit World(RunSpec spec)
      : spec_(std::move(spec)),
        limit_(time_limit(spec_)),
        robot_(make_robot(spec_)),
        pipeline_(told_config(spec_), robot_->spec(), told_by(twist_)) {
    begin(spec_.seed);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step(const WorldAction& action) {
    if (action.seed >= 0) {
      if (action.seed > kLastWorldSeed) throw std::runtime_error("a seed is beyond 2^53 - 1");
      begin(static_cast<std::uint64_t>(action.seed));
      return;
    }
    twist_ = {action.v, action.omega};
    if (!algo::finite(twist_) || std::isnan(action.seed)) {
      throw std::runtime_error("an action is not a finite number");
    }
    pipeline_.decide(t_);
    if (!robot_->step(t_.command, t_.observation)) throw std::runtime_error("the log has ended");
    look({});
  }

  WorldState state() const {
    const algo::Odometry& odometry = t_.observation.odometry;
    const algo::Vec2 goal = t_.goal ? t_.goal->position_W : odometry.pose.position();
    return {.stamp = t_.observation.stamp,
            .x = odometry.pose.x,
            .y = odometry.pose.y,
            .heading = odometry.pose.heading,
            .v = odometry.twist.v,
            .omega = odometry.twist.omega,
            .goal_x = goal.x(),
            .goal_y = goal.y(),
            .clearance = t_.ground_truth ? t_.ground_truth->clearance : t_.clearance,
            .outcome = outcome()};
  }
  const algo::Telemetry& telemetry() const { return t_; }
  const algo::RobotSpec& robot() const { return robot_->spec(); }

 private:
  void begin(std::uint64_t seed) {
    if (seed != spec_.seed) {
      spec_.seed = seed;
      robot_ = make_robot(spec_);
    }
    robot_->reset(t_.observation);
    pipeline_.reset(t_.observation.odometry.pose);
    look(first_requests(spec_));
  }

  void look(const std::vector<algo::Request>& requests) {
    t_.requests.clear();
    for (const algo::Request& each : requests) t_.requests.push_back(each);
    pipeline_.look(t_);
    t_.ground_truth = robot_->ground_truth();
  }

  double outcome() const {
    if (t_.ground_truth && t_.ground_truth->overturned) return 5;
    if (t_.ground_truth && t_.ground_truth->fallen) return 6;
    if (t_.ground_truth && t_.ground_truth->collided) return 2;
    if (t_.mission == algo::Mission::Arrived) return 1;
    if (t_.mission == algo::Mission::Stuck) return 3;
    return limit_ > 0 && t_.observation.stamp >= limit_ ? 4 : 0;
  }

  RunSpec spec_;
  double limit_ = 0;  // [s]
  algo::Twist2 twist_{};
  std::unique_ptr<algo::Robot> robot_;
  algo::Pipeline pipeline_;
  algo::Telemetry t_{};
};

/// The first scan of a world that stands still: a scanner needs some ticks for it.
algo::LaserScan Worlds::first_scan(const RunSpec& spec) {
  constexpr double kPatience = 2;  // [s] run clock
  World world(spec);
  while (!world.telemetry().scene.fresh && world.state().stamp < kPatience) world.step({});
  return world.telemetry().scene.scan;
}

Worlds::Worlds(const RunSpec& spec, std::size_t count)
    : scan_(first_scan(spec)), states_(count), ranges_(count * scan_.size()) {
  for (std::size_t i = 0; i < count; ++i) {
    RunSpec own = spec;
    own.seed = spec.seed + i;
    worlds_.push_back(std::make_unique<World>(std::move(own)));
  }
  for (std::size_t i = 0; i < count; ++i) show(i);
}

Worlds::~Worlds() = default;

const algo::RobotSpec& Worlds::robot() const {
  return worlds_.front()->robot();
}

void Worlds::step(std::span<const WorldAction> actions) {
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    try {
      worlds_[i]->step(actions[i]);
    } catch (const std::exception& e) {
      throw std::runtime_error(fmt::format("World {}: {}.", i, e.what()));
    }
    show(i);
  }
}

void Worlds::show(std::size_t i) {
  states_[i] = worlds_[i]->state();
  const std::span<float> own = std::span(ranges_).subspan(i * scan_.size(), scan_.size());
  const algo::Telemetry& t = worlds_[i]->telemetry();
  if (t.tick == 0) std::ranges::fill(own, static_cast<float>(scan_.range_max));
  if (!t.scene.fresh) return;
  std::ranges::transform(
      t.scene.scan.ranges, own.begin(), [](double range) { return static_cast<float>(range); });
}

}  // namespace server::experiment
