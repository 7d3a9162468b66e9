#include "server/lab/reproduce/session_reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "algo/arm/reach_task.hpp"
#include "server/record/headless.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/run_spec.hpp"

namespace server::reproduce {
namespace {

constexpr double kSessionEnd = 150;  // [s]

algo::Obstacle piece_of(const algo::Solid& solid, std::uint32_t id) {
  algo::Obstacle piece;
  piece.id = id;
  piece.pose_W = {
      solid.centre_W.x(), solid.centre_W.y(), std::atan2(solid.axis_W.y(), solid.axis_W.x())};
  if (solid.half.isZero()) {
    piece.shape = algo::Cylinder{solid.rounding};
  } else {
    piece.shape = algo::Box{2 * solid.half.x(), 2 * solid.half.y()};
  }
  piece.height = solid.top;
  piece.bottom = solid.bottom;
  return piece;
}

bool is_reachable(const ReachWorld& world) {
  return !algo::reach_places({}, algo::Vec2::Zero(), world.hand_W, world.solids).empty();
}

/// Where the arm's last leg in `ghost` begins: from there on the base stands.
std::optional<algo::BodyJoints> last_stand(const algo::Recycled<algo::GhostPose>& ghost) {
  if (ghost.empty()) return std::nullopt;
  std::size_t first = ghost.size() - 1;
  const auto stands = [&](std::size_t i) {
    return std::equal(ghost[i].begin(), ghost[i].begin() + 3, ghost.back().begin());
  };
  while (first > 0 && stands(first - 1)) --first;
  return algo::BodyJoints(Eigen::Map<const algo::BodyJoints>(ghost[first].data()));
}

}  // namespace

sim::Scenario reach_scenario(const ReachWorld& world) {
  sim::Scenario scenario;
  scenario.name = "reach";
  scenario.robot = builtin_robot("silvermate_arm");
  scenario.time_limit = kSessionEnd;
  for (const algo::Solid& solid : world.solids) {
    const auto id = static_cast<std::uint32_t>(scenario.obstacles.size() + 1);
    scenario.obstacles.push_back(piece_of(solid, id));
  }
  const Eigen::Quaterniond turned(world.hand_W.linear());
  algo::SetHandGoal& goal = scenario.hand_goal.emplace();
  goal.position_W = world.hand_W.translation();
  goal.attitude_W = {turned.w(), turned.x(), turned.y(), turned.z()};
  return scenario;
}

Reach session_reach_in(const ReachWorld& world, std::uint64_t seed) {
  RunOverrides overrides;
  overrides.seed = seed;
  const RunSpec spec = make_spec(reach_scenario(world), overrides);
  const auto robot = make_robot(spec);
  const algo::MobileArm body = algo::mobile_arm(*robot->spec().arm, robot->spec().radius);
  Reach result;
  const algo::BodyJoints start = algo::body_joints({}, body.folded);
  result.reachable = is_reachable(world);
  result.clearance = std::numeric_limits<double>::infinity();
  std::optional<algo::BodyJoints> stand;
  algo::BodyJoints end = start;
  HeadlessOptions options;
  options.watch = [&](const algo::Telemetry& t) -> std::optional<Ending> {
    result.seconds = t.observation.stamp;
    result.clearance = std::min(result.clearance, t.ground_truth->clearance);
    result.words = t.words.why;
    result.plans = static_cast<int>(t.arm.plan);
    if (t.arm.plan_fresh) stand = last_stand(t.arm.ghost);
    const algo::ArmJoints q = algo::joints_of(t.observation.joints->position);
    end = algo::body_joints(t.ground_truth->pose, q);
    result.clearance = std::min(result.clearance, self_clearance(body, body_frames(body, end)));
    return std::nullopt;
  };
  const HeadlessResult run = run_headless(spec, *robot, options, {});
  result.reached = run.run.outcome == algo::Outcome::Reached;
  if (run.run.outcome == algo::Outcome::Collided)
    result.clearance = std::min(result.clearance, -1e-9);
  if (!stand) result.seconds = 0;  // refused before the first motion
  result.hand_error = (body_frames(body, end).hand() - world.hand_W.translation()).norm();
  if (stand && result.reached) {
    constexpr algo::ArmPlanRules kTouching{.margin = 0, .own_margin = 0};
    const algo::BodyJoints there = algo::body_joints(algo::base_of(*stand), algo::arm_of(end));
    result.straight_touches = !is_clear(body, *stand, there, world.solids, kTouching);
  }
  return result;
}

ReachStudy study_session_reach(std::size_t worlds, const experiment::PoolOptions& options) {
  std::vector<std::uint64_t> seeds;
  for (const ReachScene scene : kReachScenes) {
    const std::size_t before = seeds.size();
    for (std::uint64_t seed = 0; seeds.size() < before + worlds; ++seed) {
      if (is_reachable(random_world(scene, seed))) seeds.push_back(seed);
    }
  }
  std::vector<Reach> all(seeds.size());
  experiment::for_each(all.size(), options, [&](std::size_t i, const std::stop_token&) {
    all[i] = session_reach_in(random_world(kReachScenes[i / worlds], seeds[i]), seeds[i]);
  });
  ReachStudy study;
  for (std::size_t s = 0; s < kReachScenes.size(); ++s) {
    study.scenes.push_back(
        trials_of(words(kReachScenes[s]), std::span(all).subspan(s * worlds, worlds)));
  }
  study.all = trials_of("all", all);
  for (const Reach& one : all) {
    if (!one.reached) ++study.why[one.words];
  }
  return study;
}

}  // namespace server::reproduce
