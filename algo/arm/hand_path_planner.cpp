#include "algo/arm/hand_path_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <set>
#include <tuple>

#include "algo/arm/arm_inverse.hpp"
#include "algo/diff_drive.hpp"

namespace algo {
namespace {

constexpr std::size_t kBeam = 120;  // configurations kept at each step of the hand
// The base's arc during a step: of the step's length, and [rad].
constexpr std::array kArcLengths{0.0, 0.5, 1.0, 1.5, 2.0, -1.0};
constexpr std::array kArcTurns{0.0, 0.12, -0.12};
// [rad] Changes of the arm angle that are tried.
constexpr std::array kAngleChanges{0.0, 0.08, -0.08, 0.2, -0.2};
constexpr double kMostJointStep = 0.3;  // [rad] of a joint during a step
constexpr double kLeastLimit = 0.05;    // [rad] that is kept to a joint's limit
constexpr double kSameCell = 0.03;      // [m] one of two bases as near as this is enough,
constexpr double kSameTurn = 0.10;      // [rad] if they are turned alike

// Costs of a step [m of the base's way]:
constexpr double kTurnCost = 0.2;       // for each radian of the base,
constexpr double kJointCost = 0.1;      // and of the joint that turns farthest
constexpr double kBackCost = 0.5;       // for each metre backwards, beside the way
constexpr double kNearLimitCost = 0.2;  // for each radian that is missing to kAmpleLimit
constexpr double kAmpleLimit = 0.6;     // [rad]
constexpr double kTightStepCost = 0.5;  // for each metre that is missing to kAmpleRoom
constexpr double kAmpleRoom = 0.20;     // [m]

struct Node {
  BodyJoints q = BodyJoints::Zero();
  double psi = 0;  // [rad] arm angle
  double cost = 0;
  std::size_t before = 0;  // index in the layer before
};
using NodeLayer = std::vector<Node>;

/// Places of the hand, each piece of the path cut evenly.
std::vector<Vec3> steps_along(const Vec3& from_W, std::span<const Vec3> points_W) {
  std::vector<Vec3> steps;
  Vec3 last = from_W;
  for (const Vec3& point : points_W) {
    const int parts = static_cast<int>(std::ceil((point - last).norm() / HandPathPlan::kHandStep));
    for (int k = 1; k <= parts; ++k) steps.push_back(last + (point - last) * k / parts);
    last = point;
  }
  return steps;
}

class HandPathSearch {
 public:
  HandPathSearch(const MobileArm& body,
                 const BodyJoints& start,
                 std::span<const Solid> solids,
                 const ReachRules& rules)
      : body_(body),
        solids_(solids),
        rules_(rules.arm),
        branch_(branch_of(body.arm, arm_of(start))),
        attitude_W_(body_frames(body, start).arm_W.hand().linear()) {
    const double psi = arm_angle(body.arm, arm_frames(body.arm, arm_of(start))).value_or(0);
    layers_.push_back({Node{.q = start, .psi = psi}});
  }

  /// False if no configuration has the hand at `hand_W` after those of the last step.
  bool step(const Vec3& hand_W, double length, bool base_stays) {
    ahead_.clear();
    const NodeLayer& now = layers_.back();
    for (std::size_t i = 0; i < now.size(); ++i) {
      for (const double part : kArcLengths) {
        for (const double turn : kArcTurns) {
          if (base_stays && (part != 0 || turn != 0)) continue;
          add(i, hand_W, {part * length, turn});
        }
      }
    }
    std::ranges::stable_sort(ahead_, {}, &Node::cost);
    NodeLayer kept;
    cells_.clear();
    for (Node& node : ahead_) {
      if (kept.size() == kBeam) break;
      if (!cells_.insert(cell_of(node.q)).second) continue;
      if (!is_clear(body_, node.q, solids_, rules_)) continue;
      const double room = clearance(body_, body_frames(body_, node.q), solids_).smallest();
      node.cost += kTightStepCost * std::max(0.0, kAmpleRoom - room);
      kept.push_back(node);
    }
    if (kept.empty()) return false;
    layers_.push_back(std::move(kept));
    return true;
  }

  /// The cheapest.
  std::vector<BodyJoints> path() const {
    std::vector<BodyJoints> out(layers_.size());
    std::size_t at = static_cast<std::size_t>(
        std::ranges::min_element(layers_.back(), {}, &Node::cost) - layers_.back().begin());
    for (std::size_t n = layers_.size(); n-- > 0;) {
      out[n] = layers_[n][at].q;
      at = layers_[n][at].before;
    }
    return out;
  }

 private:
  using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  static Cell cell_of(const BodyJoints& q) {
    const auto index = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
    return {index(q[0] / kSameCell), index(q[1] / kSameCell), index(q[2] / kSameTurn)};
  }

  /// The arc's end, with the arm that has the most room to its limits there.
  void add(std::size_t before, const Vec3& hand_W, const Twist2& arc) {
    const Node& from = layers_.back()[before];
    const ArmJoints arm = arm_of(from.q);
    const Pose2 base_W = integrate_arc(base_of(from.q), arc, 1);
    const BodyFrames frames = body_frames(body_, body_joints(base_W, arm));
    Pose3 hand = Pose3::Identity();
    hand.linear() = attitude_W_;
    hand.translation() = hand_W;
    const Pose3 in_shoulder = frames.arm_W.front().inverse() * hand;
    std::optional<Node> best;
    for (const double change : kAngleChanges) {
      const auto q = arm_inverse(body_.arm, in_shoulder, from.psi + change, branch_, arm);
      if (!q) return;
      const double margin = limit_margin(body_.arm, *q);
      const double turn = (*q - arm).cwiseAbs().maxCoeff();
      if (margin < kLeastLimit || turn > kMostJointStep) continue;
      const double cost = kJointCost * turn + kNearLimitCost * std::max(0.0, kAmpleLimit - margin);
      if (best && cost >= best->cost) continue;
      best = Node{body_joints(base_W, *q), from.psi + change, cost, before};
    }
    if (!best) return;
    best->cost += from.cost + std::abs(arc.v) + kBackCost * std::max(0.0, -arc.v) +
                  kTurnCost * std::abs(arc.omega);
    ahead_.push_back(*best);
  }

  MobileArm body_;
  std::span<const Solid> solids_;
  ArmPlanRules rules_;
  ArmBranch branch_;
  Eigen::Matrix3d attitude_W_;
  std::vector<NodeLayer> layers_{};
  NodeLayer ahead_{};
  std::set<Cell> cells_{};
};

}  // namespace

HandPathPlan plan_hand_path(const MobileArm& body,
                            const BodyJoints& start,
                            std::span<const Vec3> points_W,
                            bool base_stays,
                            std::span<const Solid> solids,
                            const ReachRules& rules) {
  HandPathSearch search(body, start, solids, rules);
  Vec3 last = body_frames(body, start).hand();
  double way = 0;
  for (const Vec3& hand_W : steps_along(last, points_W)) {
    const double length = (hand_W - last).norm();
    if (!search.step(hand_W, length, base_stays)) {
      std::array<char, 100> text{};
      std::snprintf(text.data(),
                    text.size(),
                    "After %.2f m of its path the hand gets no farther clear of everything.",
                    way);
      return {.why = text.data()};
    }
    last = hand_W;
    way += length;
  }
  return {.path = search.path()};
}

}  // namespace algo
