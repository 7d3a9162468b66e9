#include "server/lab/reproduce/reach_study.hpp"

#include <algorithm>
#include <limits>

#include "algo/arm/reach_task.hpp"

namespace server::reproduce {
namespace {

using algo::ReachTask;

constexpr double kReachTick = 0.05;     // [s]
constexpr int kReachParts = 5;          // of a tick, after each of which the clearance counts
constexpr double kReachEnd = 150;       // [s]
constexpr std::size_t kMostDrawn = 20;  // worlds for each that is counted
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// [m] Of all links, from things and from each other.
double body_room(const algo::MobileArm& body,
                 const algo::BodyJoints& q,
                 const std::vector<algo::Solid>& solids) {
  const algo::BodyFrames frames = body_frames(body, q);
  return std::min(clearance(body, frames, solids).smallest(), self_clearance(body, frames));
}

void add(const Reach& one, ReachTrials& row) {
  ++row.worlds;
  row.plans += one.plans;
  row.clearance = std::min(row.clearance, one.clearance);
  if (one.clearance < 0) ++row.touched;
  if (one.straight_touches) ++row.straight_touched;
  if (one.reached) {
    ++row.reached;
    row.seconds += one.seconds;
    row.hand_error = std::max(row.hand_error, one.hand_error);
  } else if (one.seconds > 0) {
    ++row.given_up;
  } else {
    ++row.refused;
  }
}

/// Sums become means.
void finish(ReachTrials& row) {
  if (row.worlds > 0) row.plans /= static_cast<double>(row.worlds);
  if (row.reached > 0) row.seconds /= static_cast<double>(row.reached);
}

}  // namespace

Reach reach_in(const ReachWorld& world, std::uint64_t seed) {
  Reach result;
  const algo::MobileArm body;
  algo::BodyJoints q = algo::body_joints({}, algo::folded_arm());
  ReachTask task(body, {});
  task.begin(q, {world.hand_W}, world.solids, seed);
  answer_at_once(task, body, q, world.solids);
  result.reachable =
      !task.legs().empty() || !reach_places(body, q.head<2>(), world.hand_W, world.solids).empty();
  if (!task.legs().empty()) {
    const std::vector<algo::BodyJoints>& reach = task.legs().back().path;
    constexpr algo::ArmPlanRules kTouching{.margin = 0, .own_margin = 0};
    result.straight_touches = !is_clear(body, reach.front(), reach.back(), world.solids, kTouching);
  }
  result.clearance = body_room(body, q, world.solids);
  while (task.state() != ReachTask::State::GivenUp && result.seconds < kReachEnd) {
    const algo::BodyCommand command = task.update(q, world.solids, world.solids, kReachTick);
    answer_at_once(task, body, q, world.solids);
    if (task.state() == ReachTask::State::Arrived) break;
    for (int part = 1; part <= kReachParts; ++part) {
      const algo::BodyJoints between = moved(q, command, kReachTick * part / kReachParts);
      result.clearance = std::min(result.clearance, body_room(body, between, world.solids));
    }
    q = moved(q, command, kReachTick);
    result.seconds += kReachTick;
  }
  result.reached = task.state() == ReachTask::State::Arrived;
  result.hand_error = (body_frames(body, q).hand() - world.hand_W.translation()).norm();
  result.plans = task.plans();
  result.words = task.words();
  return result;
}

ReachTrials trials_of(std::string_view scene, std::span<const Reach> reaches) {
  ReachTrials row;
  row.scene = scene;
  row.clearance = kUnbounded;
  for (const Reach& one : reaches) {
    if (one.reachable) add(one, row);
  }
  finish(row);
  return row;
}

ReachStudy study_reach(std::size_t worlds) {
  ReachStudy study;
  std::vector<Reach> all;
  for (const ReachScene scene : kReachScenes) {
    std::vector<Reach> of_scene;
    std::size_t counted = 0;
    for (std::uint64_t seed = 0; counted < worlds && seed < kMostDrawn * worlds; ++seed) {
      const Reach& one = of_scene.emplace_back(reach_in(random_world(scene, seed), seed));
      if (!one.reached) ++study.why[one.words];
      if (one.reachable) ++counted;
    }
    study.scenes.push_back(trials_of(words(scene), of_scene));
    all.insert(all.end(), of_scene.begin(), of_scene.end());
  }
  study.all = trials_of("all", all);
  return study;
}

}  // namespace server::reproduce
