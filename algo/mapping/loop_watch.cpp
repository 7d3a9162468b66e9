// algo/mapping/loop_watch.cpp: matches scans to the old map until enough of them agree.
#include "algo/mapping/loop_watch.hpp"

#include <cmath>

#include "algo/mapping/step_edges.hpp"

namespace algo {
namespace {

constexpr double kShare = 0.7;           // of a scan's points on the walls of the old map
constexpr double kFittedWay = 1.0;       // [m] after which it is believed,
constexpr double kFittedWayPerMove = 3;  // and more for each metre that the map has to move
constexpr double kMissedWay = 1.1;       // [m] after which it is forgotten
constexpr double kSearchEvery = 0.5;     // [m]
constexpr double kSameMove = 0.1;        // [m] between the moves by two scans that agree
constexpr double kSameMoveTurn = 0.03;   // [rad]
constexpr SearchGrid kSearched{.window = 1.6, .step = 0.2, .turn_window = 0.12, .turn_step = 0.03};

bool fits(const ScanMatch& match) {
  return match.share >= kShare && complete(match_information(match));
}

}  // namespace

void LoopWatch::reset() {
  *this = {};
}

std::optional<Pose2> LoopWatch::see(const ScanMatcher& matcher,
                                    const OccupancyMap& old,
                                    const Pose2& pose_W,
                                    double way,
                                    bool search,
                                    const MatchPrior& prior) {
  fitted_ += way;
  missed_ += way;
  unsearched_ += way;
  if (missed_ > kMissedWay) move_.reset();
  ScanMatch match = matcher.match(old, move_ ? compose(*move_, pose_W) : pose_W, prior);
  if (!fits(match) && search && unsearched_ >= kSearchEvery) {
    unsearched_ = 0;
    match = matcher.match(old, matcher.search(old, pose_W, kSearched), prior);
  }
  if (!fits(match)) return std::nullopt;
  const Pose2 move = compose(match.pose_W, pose_step(pose_W, {}));
  const Vec2 here_W = pose_W.position();
  const bool agrees = move_ &&
                      (to_parent(move, here_W) - to_parent(*move_, here_W)).norm() <= kSameMove &&
                      std::abs(wrap_angle(move.heading - move_->heading)) <= kSameMoveTurn;
  missed_ = 0;
  if (!agrees) {
    move_ = move;
    fitted_ = 0;
  }
  const double far = (match.pose_W.position() - here_W).norm();
  if (fitted_ < kFittedWay + kFittedWayPerMove * far) return std::nullopt;
  return match.pose_W;
}

}  // namespace algo
