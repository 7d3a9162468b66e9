// algo/full_strip/narrow_place.cpp: where a manoeuvre may end, and when to search for one.
#include "algo/full_strip/narrow_place.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kSearchEvery = 1.0;       // [s] after a search that found nothing
constexpr int kManeuverExpansions = 150;   // in a tick
constexpr double kManeuverMargin = 0.031;  // [m] of room on the way
constexpr std::size_t kNearest = 4;        // nodes ahead: a manoeuvre ends from here to kFarthest;
constexpr std::size_t kFarthest = 11;
constexpr std::size_t kAimedNode = 7;  // its search aims here
constexpr double kOnStrip = 0.10;      // [m]
constexpr double kAlongStrip = 0.35;   // [rad]
constexpr double kAtRestBelow = 0.05;  // [m/s]

/// True if `pose_W` lies on the strip ahead and points along it.
bool on_strip(const Recycled<Node>& nodes, const Pose2& pose_W) {
  const std::size_t end = std::min(nodes.size() - 1, kFarthest);
  for (std::size_t i = std::min(end - 1, kNearest); i < end; ++i) {
    const Vec2 way = nodes[i + 1].position_W - nodes[i].position_W;
    if ((nodes[i].position_W - pose_W.position()).squaredNorm() > kOnStrip * kOnStrip) continue;
    const double error = std::atan2(way.y(), way.x()) - pose_W.heading;
    if (std::abs(wrap_angle(error)) < kAlongStrip) return true;
  }
  return false;
}

}  // namespace

void NarrowPlace::reset() {
  search_.reset();
  drive_.reset();
}

bool NarrowPlace::worth_waiting(double now) const {
  return search_.state() == ManeuverSearch::State::Searching && now < next_search_;
}

void NarrowPlace::look(
    const StageInput& stage, const HullCheck& hull, const Pose2& here_W, double speed, double now) {
  const Recycled<Node>& nodes = stage.strip->nodes();
  if (nodes.size() < 3) return;
  if (search_.state() == ManeuverSearch::State::NoWay && now < next_search_) return;
  if (search_.state() != ManeuverSearch::State::Searching) {
    if (std::abs(speed) > kAtRestBelow) return;
    const std::size_t aim = std::min(nodes.size() - 1, kAimedNode);
    search_.start(here_W, nodes[aim].position_W, kManeuverMargin);
    next_search_ = now + kSearchEvery;
  }
  const auto arrived = [&](const Pose2& pose_W) { return on_strip(nodes, pose_W); };
  if (search_.search(*stage.map, hull, arrived, kManeuverExpansions) ==
      ManeuverSearch::State::Found) {
    drive_.start(search_.pieces());
    search_.reset();
  }
}

std::optional<Twist2> NarrowPlace::next(const StageInput& stage,
                                        const VelocityStage& proof,
                                        Weighing& out) {
  if (const auto wanted = drive_.next(stage.state.pose_W, stage.limits)) {
    if (const auto twist = proof.proven(stage, *wanted, out)) return twist;
  }
  drive_.reset();
  return std::nullopt;
}

}  // namespace algo
