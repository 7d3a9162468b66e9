// server/lab/mapping/dead_ends.cpp: drives to goals that lie behind dead ends, with the map for the
// planner and without.
#include <utility>

#include "server/lab/mapping/locate_study.hpp"
#include "server/record/headless.hpp"

namespace server::mapping {
namespace {

using algo::Vec2;

constexpr double kLongDrive = 1800;    // [s]
constexpr double kDrawnSpacing = 0.2;  // [m] between points of a track

void drive_dead_end(const RunSpec& spec, DeadEndRun& run) {
  const auto robot = make_robot(spec);
  HeadlessOptions options;
  options.watch = [&run](const algo::Telemetry& t) -> std::optional<Ending> {
    const Vec2 truth_W = t.ground_truth->pose.position();
    const double step = run.track_W.empty() ? 0 : (truth_W - run.track_W.back()).norm();
    if (run.track_W.empty() || step >= kDrawnSpacing) {
      run.track_W.push_back(truth_W);
      run.way += step;
    }
    run.time = t.observation.stamp;
    return std::nullopt;
  };
  run.outcome = run_headless(spec, *robot, options, {}).run.outcome;
  run.goal_off = (robot->ground_truth()->pose.position() - spec.scenario.goal->position_W).norm();
}

}  // namespace

Drawing dead_end_of(const std::string& name, std::uint64_t seed) {
  Drawing drawing = drawing_of(name, seed);
  CorridorWalls more(seed);
  if (name == "offices") {
    more.wall({68.7, 11}, {71.3, 11});
    drawing.way_W = {{2, 0}, {70, 22}};
  } else if (name == "hall") {
    more.wall({9, 18}, {72, 18});
    drawing.way_W = {{14, 3}, {66, 33}};
  } else {
    drawing.way_W = {{3, 0}, {3, 30}};
  }
  drawing.pieces.insert(drawing.pieces.end(), more.pieces().begin(), more.pieces().end());
  return drawing;
}

std::vector<DeadEndRun> study_dead_ends(const LocateOptions& options) {
  const std::size_t buildings = kDrawings.size() * options.seeds;
  std::vector<DeadEndRun> runs(2 * buildings);
  for_each(runs.size(), options.pool, [&](std::size_t i, const std::stop_token& /*stop*/) {
    DeadEndRun& run = runs[i];
    run.planned = i % 2 == 1;
    run.drawing = kDrawings.at(i / 2 / options.seeds);
    run.seed = options.first_seed + i / 2 % options.seeds;
    const Drawing drawing = dead_end_of(run.drawing, run.seed);
    RunOverrides overrides;
    overrides.seed = run.seed;
    overrides.map = map_of(outdated(drawing, options.wrong, run.seed), drawing, run.planned);
    sim::Scenario scenario = scenario_of(drawing);
    scenario.time_limit = kLongDrive;
    drive_dead_end(make_spec(std::move(scenario), overrides), run);
  });
  return runs;
}

}  // namespace server::mapping
