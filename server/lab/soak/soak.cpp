// server/lab/soak/soak.cpp: one world watched tick by tick.
#include "server/lab/soak/soak.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "algo/driving.hpp"
#include "algo/explain.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "server/experiment/parallel.hpp"
#include "server/lab/soak/random_world.hpp"
#include "server/run/run_spec.hpp"

namespace server::soak {
namespace {

constexpr double kTimeLimit = 300;  // [s]
constexpr double kStands = 20;      // [s] without way or turn: it stands
constexpr double kWay = 0.05;       // [m]
constexpr double kTurn = 0.2;       // [rad]
constexpr double kToSpare = 0.10;   // [m] of the way that surely exists

bool finite(const algo::Telemetry& t) {
  return std::isfinite(t.output.twist.v) && std::isfinite(t.output.twist.omega) &&
         std::isfinite(t.command.base.v) && std::isfinite(t.command.base.omega) &&
         t.hold != algo::Hold::NotFinite;
}

/// What a robot may say while it stands. All else promises motion.
bool gives_reason(const algo::Telemetry& t) {
  if (t.mission == algo::Mission::Stuck || t.mission == algo::Mission::Held) return true;
  switch (t.output.manner) {
    case algo::Manner::NoWay:
    case algo::Manner::GoalTaken:
    case algo::Manner::Blocked:
    case algo::Manner::NoPlan:
    case algo::Manner::Walled:
    case algo::Manner::NoWindow:
    case algo::Manner::Cornered:
      return true;
    default:
      return false;
  }
}

/// How long the robot has been where it is.
class Standing {
 public:
  double seconds(const algo::Pose2& pose, double stamp) {
    const bool moved = (pose.position() - at_.position()).norm() > kWay ||
                       std::abs(algo::wrap_angle(pose.heading - at_.heading)) > kTurn;
    if (moved || since_ < 0) {
      at_ = pose;
      since_ = stamp;
    }
    return stamp - since_;
  }

 private:
  algo::Pose2 at_{};
  double since_ = -1;
};

class Watch {
 public:
  Watch(std::uint64_t seed, const std::string& controller)
      : spec_(make_spec(random_world(seed, controller), {})) {
    spec_.seed = seed;
    outcome_.seed = seed;
    outcome_.min_clearance = std::numeric_limits<double>::infinity();
  }

  Outcome execute() {
    const std::unique_ptr<algo::Robot> robot = make_robot(spec_);
    robot->set_pace({.paused = false, .speed = 0});
    outcome_.has_way = reachable(spec_.scenario,
                                 spec_.scenario.start.position(),
                                 spec_.scenario.goal->position_W,
                                 robot->spec().radius + kToSpare,
                                 spec_.parameters[algo::kGoalReach]);
    algo::Pipeline pipeline(pipeline_config(spec_), robot->spec());
    algo::Telemetry t;
    robot->reset(t.observation);
    pipeline.reset(t.observation.odometry.pose);
    for (const algo::Request& request : first_requests(spec_)) t.requests.push_back(request);
    do {
      pipeline.tick(t);
      t.requests.clear();
      robot->step(t.command, t.observation);
    } while (!judge(t, *robot->ground_truth()));
    outcome_.why = algo::explain(t).why;
    return outcome_;
  }

 private:
  /// Whether the run is over.
  bool judge(const algo::Telemetry& t, const algo::GroundTruth& truth) {
    outcome_.time = t.observation.stamp;
    outcome_.end = truth.pose;
    outcome_.min_clearance = std::min(outcome_.min_clearance, truth.clearance);
    reason_ = gives_reason(t) ? t.observation.stamp : reason_;
    if (!finite(t)) return ends(Ending::NotFinite);
    if (truth.collided) return ends(Ending::Collision);
    if (t.mission == algo::Mission::Arrived) return ends(Ending::Reached);
    if (standing_.seconds(truth.pose, t.observation.stamp) > kStands) {
      // Said at some time while it stood: between two attempts it may speak of the attempt.
      return ends(t.observation.stamp - reason_ < kStands ? Ending::GaveReason : Ending::Silent);
    }
    return t.observation.stamp > kTimeLimit;
  }
  bool ends(Ending ending) {
    outcome_.ending = ending;
    return true;
  }

  RunSpec spec_{};
  Outcome outcome_{};
  Standing standing_{};
  double reason_ = -kStands;  // [s] when it last gave one
};

}  // namespace

std::string_view name(Ending ending) {
  switch (ending) {
    case Ending::Reached:
      return "reached";
    case Ending::GaveReason:
      return "gave a reason";
    case Ending::OutOfTime:
      return "out of time";
    case Ending::Silent:
      return "silent";
    case Ending::Collision:
      return "collision";
    case Ending::NotFinite:
      return "not finite";
  }
  return "";
}

bool is_fault(Ending ending) {
  return ending == Ending::Silent || ending == Ending::Collision || ending == Ending::NotFinite;
}

Outcome run_world(std::uint64_t seed, const std::string& controller) {
  return Watch(seed, controller).execute();
}

std::vector<Outcome> run_worlds(const Options& options) {
  std::vector<Outcome> outcomes(options.worlds);
  std::mutex mutex;  // of progress
  std::size_t done = 0;
  in_parallel(outcomes.size(), options.workers, [&](std::size_t i) {
    outcomes[i] = run_world(options.first_seed + i, options.controller);
    const std::lock_guard lock(mutex);
    if (options.progress) options.progress(++done, outcomes.size());
  });
  return outcomes;
}

}  // namespace server::soak
