// server/lab/mapping/locate_study.cpp: drives along the ways of the drawings, and judges the poses.
#include "server/lab/mapping/locate_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/mapping/map_localizer.hpp"
#include "algo/perceive.hpp"
#include "server/record/headless.hpp"

namespace server::mapping {
namespace {

using algo::Vec2;

constexpr double kFalsePose = 0.5;     // [m]
constexpr double kTrackSpacing = 0.2;  // [m]
constexpr double kScannerRange = 30;   // [m] as the scanner LMS200 has it in centimetres
constexpr double kTimeLimit = 600;     // [s]
constexpr double kLostTime = 60;       // [s] after which a robot that was never located gives up

/// What believed poses are worth.
struct Judged {
  double ticks = 0, located = 0, within = 0;
  double worst = 0;       // [m]
  double false_time = 0;  // [s]

  void judge(bool is_located, const Vec2& off, double variance, double period) {
    ticks += 1;
    if (!is_located) return;
    located += 1;
    worst = std::max(worst, off.norm());
    const bool told = off.norm() <= 3 * std::sqrt(variance);
    if (off.norm() > kFalsePose && !told) false_time += period;
    if (told) within += 1;
  }
};

/// Rides along with the scans and wheels of a robot, and looks for its own place.
class Passenger {
 public:
  explicit Passenger(const KnownMap& map) : localizer_(map.walls) {}

  void ride(const algo::Telemetry& t) {
    const algo::LaserScan* scan = algo::front_scan(t.observation);
    const Vec2 truth_W = t.ground_truth->pose.position();
    if (last_W_) way_ += (truth_W - *last_W_).norm();
    last_W_ = truth_W;
    if (scan == nullptr || !t.observation.map_pose) return;
    const double period = t.observation.stamp - last_scan_;
    last_scan_ = t.observation.stamp;
    localizer_.take(*scan, t.observation.map_pose->wheels);
    if (!localizer_.located()) return;
    if (found_ < 0) found_ = way_;
    const Vec2 off = localizer_.best().pose_M().position() - truth_W;
    if (off.norm() > kFalsePose) false_time_ += period;
  }
  double found() const { return found_; }
  double false_time() const { return false_time_; }

 private:
  algo::MapLocalizer localizer_;
  std::optional<Vec2> last_W_{};
  double last_scan_ = 0;   // [s]
  double way_ = 0;         // [m]
  double found_ = -1;      // [m]
  double false_time_ = 0;  // [s]
};

void drive(const RunSpec& spec, LocateRun& run) {
  const auto robot = make_robot(spec);
  Judged judged;
  std::optional<Passenger> passenger;
  if (run.by == DrivesBy::Map) passenger.emplace(*spec.map);
  bool found = false;
  HeadlessOptions options;
  options.watch = [&](const algo::Telemetry& t) -> std::optional<Ending> {
    const Vec2 truth_W = t.ground_truth->pose.position();
    if (run.track_W.empty() || (truth_W - run.track_W.back()).norm() >= kTrackSpacing) {
      run.track_W.push_back(truth_W);
    }
    if (passenger) passenger->ride(t);
    const auto& at = t.observation.map_pose;
    if (!at) return std::nullopt;
    found = found || at->located();
    const Vec2 off = t.observation.odometry.pose.position() - truth_W;
    judged.judge(at->located(), off, at->xx + at->yy, spec.scenario.period);
    if (found || t.observation.stamp < kLostTime) return std::nullopt;
    return Ending{algo::Outcome::Stuck, "It was never located."};
  };
  run.outcome = run_headless(spec, *robot, options, {}).run.outcome;
  run.goal_off = (robot->ground_truth()->pose.position() - spec.scenario.goal->position_W).norm();
  run.worst_off = judged.worst;
  run.false_time = judged.false_time;
  if (judged.ticks > 0) run.located = judged.located / judged.ticks;
  if (judged.located > 0) run.within_3 = judged.within / judged.located;
  if (!passenger) return;
  run.passenger_found = passenger->found();
  run.passenger_false = passenger->false_time();
}

}  // namespace

sim::Scenario scenario_of(const Drawing& drawing) {
  sim::Scenario scenario;
  scenario.name = drawing.name;
  scenario.controller = "strip";
  scenario.physics = sim::PhysicsKind::Kinematic;
  scenario.time_limit = kTimeLimit;
  scenario.drive = {
      .yaw_slip = 0.05, .odometry_scale = 0.05, .odometry_noise = 0.02, .odometry_slip = 0.05};
  for (sim::LaserConfig& laser : scenario.robot.sensors.lasers) {
    laser.unit = sim::LaserUnit::Centimetre;
    laser.range_max = kScannerRange;
  }
  const Vec2& start = drawing.way_W[0];
  const Vec2 first = drawing.way_W[1] - start;
  scenario.start = {start.x(), start.y(), std::atan2(first.y(), first.x())};
  for (std::size_t k = 1; k + 1 < drawing.way_W.size(); ++k) {
    scenario.waypoints.push_back({drawing.way_W[k], std::nullopt});
  }
  scenario.goal = algo::SetGoal{drawing.way_W.back(), std::nullopt};
  for (const Piece& piece : drawing.pieces) {
    scenario.obstacles.push_back(piece.obstacle);
    scenario.obstacles.back().id = static_cast<std::uint32_t>(scenario.obstacles.size());
  }
  return scenario;
}

std::vector<LocateRun> study_locate(const LocateOptions& options) {
  constexpr std::array kBy{DrivesBy::Wheels, DrivesBy::Map, DrivesBy::MapLost};
  const std::size_t buildings = kDrawings.size() * options.seeds;
  std::vector<LocateRun> runs(buildings * kBy.size());
  for_each(runs.size(), options.pool, [&](std::size_t i, const std::stop_token& /*stop*/) {
    LocateRun& run = runs[i];
    const std::size_t building = i / kBy.size();
    run.by = kBy[i % kBy.size()];
    run.seed = options.first_seed + building % options.seeds;
    const Drawing drawing = drawing_of(kDrawings[building / options.seeds], run.seed);
    run.drawing = drawing.name;
    RunOverrides overrides;
    overrides.seed = run.seed;
    overrides.lost = run.by == DrivesBy::MapLost;
    if (run.by != DrivesBy::Wheels) {
      overrides.map = map_of(outdated(drawing, options.wrong, run.seed), drawing, true);
    }
    drive(make_spec(scenario_of(drawing), overrides), run);
  });
  return runs;
}

}  // namespace server::mapping
