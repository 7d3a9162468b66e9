// server/lab/barn/barn_run.cpp: the benchmark's clock, ending and score.
#include "server/lab/barn/barn_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <limits>
#include <mutex>

#include "server/experiment/parallel.hpp"
#include "server/run/run_spec.hpp"

namespace server::barn {
namespace {

constexpr double kMoved = 0.1;         // [m] from the start: the clock begins
constexpr double kTimeLimit = 100;     // [s] of that clock
constexpr double kPatience = 60;       // [s] for a robot that never moves
constexpr double kOptimalSpeed = 2.0;  // [m/s]
constexpr std::size_t kTrail = 80;     // moments remembered: 4 s

/// s = OT / clip(AT, low OT, 8 OT).
double score_of(const World& world, double time, double low) {
  const double optimal = world.optimal_length / kOptimalSpeed;
  return optimal / std::clamp(time, low * optimal, 8 * optimal);
}

/// [s] That this thread has had a core: what else runs on the machine does not count.
double cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class Trial {
 public:
  Trial(const World& world, const Options& options, std::uint64_t seed)
      : world_(world), spec_(make_spec(scenario_of(world, options.conditions), {})) {
    spec_.seed = seed;
    run_.world = world.id;
    run_.seed = seed;
    run_.min_clearance = std::numeric_limits<double>::infinity();
  }

  Run execute(std::vector<float>& tick_us) {
    const std::unique_ptr<algo::Robot> robot = make_robot(spec_);
    robot->set_pace({.paused = false, .speed = 0});
    algo::Pipeline pipeline(pipeline_config(spec_), robot->spec());
    algo::Telemetry t;
    robot->reset(t.observation);
    pipeline.reset(t.observation.odometry.pose);
    for (const algo::Request& request : first_requests(spec_)) t.requests.push_back(request);
    while (true) {
      const double begin = cpu_time();
      pipeline.tick(t);
      tick_us.push_back(static_cast<float>((cpu_time() - begin) * 1e6));
      t.requests.clear();
      robot->step(t.command, t.observation);
      const algo::GroundTruth truth = *robot->ground_truth();
      remember(t.observation, truth);
      if (judge(truth, t.observation.stamp)) break;
    }
    if (run_.ending == Ending::Collision && !world_.paths.empty()) {
      run_.contact = judge_contact(spec_.scenario, robot->spec(), trail_);
    }
    return run_;
  }

 private:
  void remember(const algo::Observation& observation, const algo::GroundTruth& truth) {
    if (world_.paths.empty()) return;
    if (trail_.size() == kTrail) trail_.erase(trail_.begin());
    trail_.push_back({observation.stamp, truth.pose, observation.odometry.twist});
  }

  /// Whether the run is over.
  bool judge(const algo::GroundTruth& truth, double stamp) {
    const algo::Vec2 at_W = truth.pose.position();
    run_.path_length += (at_W - run_.end.position()).norm() * (ticks_++ > 0 ? 1 : 0);
    run_.end = truth.pose;
    run_.min_clearance = std::min(run_.min_clearance, truth.clearance);
    if (!moved_at_ && (at_W - world_.start.position()).norm() > kMoved) moved_at_ = stamp;
    run_.time = moved_at_ ? stamp - *moved_at_ : 0;
    if (truth.collided) {
      run_.ending = Ending::Collision;
      return true;
    }
    if ((at_W - world_.goal).norm() < world_.goal_radius) {
      run_.ending = Ending::Success;
      run_.score = score_of(world_, run_.time, 2);
      run_.score_quarter = score_of(world_, run_.time, 4);
      return true;
    }
    run_.ending = Ending::Timeout;
    return moved_at_ ? run_.time >= kTimeLimit : stamp >= kPatience;
  }

  const World& world_;
  RunSpec spec_{};
  Run run_{};
  std::optional<double> moved_at_{};  // [s] run clock
  std::uint64_t ticks_ = 0;
  std::vector<Moment> trail_{};  // the last seconds, for the oracle
};

double quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

}  // namespace

Result run_worlds(const std::vector<World>& worlds, const Options& options) {
  Result result;
  result.worlds = worlds.size();
  result.runs.resize(worlds.size() * options.repeats);
  std::mutex mutex;  // of the ticks and of progress
  std::size_t done = 0;
  in_parallel(result.runs.size(), options.workers, [&](std::size_t i) {
    const World& world = worlds[i / options.repeats];
    std::vector<float> tick_us;
    result.runs[i] =
        Trial(world, options, options.first_seed + i % options.repeats).execute(tick_us);
    const std::lock_guard lock(mutex);
    result.tick_us.insert(result.tick_us.end(), tick_us.begin(), tick_us.end());
    if (options.progress) options.progress(++done, result.runs.size());
  });
  return result;
}

Summary summarise(const Result& result) {
  Summary sum;
  sum.worlds = result.worlds;
  sum.runs = result.runs.size();
  double times = 0;
  for (const Run& run : result.runs) {
    sum.success += run.ending == Ending::Success ? 1 : 0;
    sum.collisions += run.ending == Ending::Collision ? 1 : 0;
    sum.timeouts += run.ending == Ending::Timeout ? 1 : 0;
    sum.avoidable += run.contact == Contact::Avoidable ? 1U : 0U;
    sum.unavoidable += run.contact == Contact::Unavoidable ? 1U : 0U;
    sum.jumped += run.contact == Contact::Jumped ? 1U : 0U;
    sum.score += run.score;
    sum.score_quarter += run.score_quarter;
    if (run.ending == Ending::Success) times += run.time;
  }
  sum.mean_time = sum.success > 0 ? times / sum.success : 0;
  const auto runs = static_cast<double>(std::max<std::size_t>(1, sum.runs));
  for (double* mean :
       {&sum.success, &sum.collisions, &sum.timeouts, &sum.score, &sum.score_quarter}) {
    *mean /= runs;
  }
  sum.tick_us_p50 = quantile(result.tick_us, 0.5);
  sum.tick_us_p99 = quantile(result.tick_us, 0.99);
  return sum;
}

}  // namespace server::barn
