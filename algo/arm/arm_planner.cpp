#include "algo/arm/arm_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace algo {
namespace {

/// Numbers in [0, 1) that follow from the seed alone: SplitMix64 (Steele, Lea and Flood 2014).
class JointDice {
 public:
  explicit JointDice(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }
  std::size_t below(std::size_t count) {
    return std::min(static_cast<std::size_t>((*this)() * static_cast<double>(count)), count - 1);
  }

 private:
  std::uint64_t state_;
};

/// Configurations of the arm, each with the one from which it was reached.
struct ArmTree {
  std::vector<ArmJoints> q{};
  std::vector<std::size_t> parent{};

  void add(const ArmJoints& joints, std::size_t from) {
    q.push_back(joints);
    parent.push_back(from);
  }
  std::size_t nearest(const ArmJoints& to) const {
    std::size_t best = 0;
    double least = (q[0] - to).squaredNorm();
    for (std::size_t i = 1; i < q.size(); ++i) {
      const double distance = (q[i] - to).squaredNorm();
      if (distance < least) {
        least = distance;
        best = i;
      }
    }
    return best;
  }
  /// From node `i` to the root.
  std::vector<ArmJoints> to_root(std::size_t i) const {
    std::vector<ArmJoints> way{q[i]};
    while (i != 0) way.push_back(q[i = parent[i]]);
    return way;
  }
};

/// One search by two trees (RRT-Connect).
class ArmSearch {
 public:
  ArmSearch(const MobileArm& body,
            const Pose2& base_W,
            std::span<const Solid> solids,
            const ArmPlanRules& rules,
            std::uint64_t seed)
      : body_(body), base_W_(base_W), solids_(solids), rules_(rules), uniform_(seed) {}

  std::optional<std::vector<ArmJoints>> find(const ArmJoints& from, const ArmJoints& to) {
    if (clear(from, to)) return std::vector<ArmJoints>{from, to};
    std::array<ArmTree, 2> trees;
    trees[0].add(from, 0);
    trees[1].add(to, 0);
    std::size_t grown = 0;  // the tree that grows first; they take turns
    for (int n = 0; n < rules_.samples; ++n, grown = 1 - grown) {
      const auto reached = grow(trees[grown], sample());
      if (!reached) continue;
      const auto met = connect(trees[1 - grown], trees[grown].q[*reached]);
      if (!met) continue;
      std::vector<ArmJoints> first = trees[grown].to_root(*reached);
      std::vector<ArmJoints> second = trees[1 - grown].to_root(*met);
      std::ranges::reverse(first);
      first.insert(first.end(), second.begin() + 1, second.end());
      if (grown == 1) std::ranges::reverse(first);
      return shortened(std::move(first));
    }
    return std::nullopt;
  }

 private:
  bool clear(const ArmJoints& from, const ArmJoints& to) const {
    return is_clear(body_, body_joints(base_W_, from), body_joints(base_W_, to), solids_, rules_);
  }
  ArmJoints sample() {
    ArmJoints q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = body_.arm.limits[i] * (2 * uniform_() - 1);
    }
    return q;
  }
  /// A new node one stride towards `to`, if the motion is clear.
  std::optional<std::size_t> grow(ArmTree& tree, const ArmJoints& to) {
    const std::size_t from = tree.nearest(to);
    const ArmJoints way = to - tree.q[from];
    const double length = way.norm();
    const ArmJoints next =
        length <= rules_.stride ? to : tree.q[from] + rules_.stride / length * way;
    if (!clear(tree.q[from], next)) return std::nullopt;
    tree.add(next, from);
    return tree.q.size() - 1;
  }
  /// Strides towards `to` until it is reached, which gives its node, or the way is blocked.
  std::optional<std::size_t> connect(ArmTree& tree, const ArmJoints& to) {
    for (;;) {
      const auto node = grow(tree, to);
      if (!node) return std::nullopt;
      if (tree.q[*node] == to) return node;
    }
  }
  std::vector<ArmJoints> shortened(std::vector<ArmJoints> way) {
    for (int n = 0; n < rules_.shortcuts && way.size() > 2; ++n) {
      const std::size_t a = uniform_.below(way.size());
      const std::size_t b = uniform_.below(way.size());
      const auto [first, last] = std::minmax(a, b);
      if (last - first < 2 || !clear(way[first], way[last])) continue;
      way.erase(way.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                way.begin() + static_cast<std::ptrdiff_t>(last));
    }
    return way;
  }

  const MobileArm& body_;
  Pose2 base_W_;
  std::span<const Solid> solids_;
  const ArmPlanRules& rules_;
  JointDice uniform_;
};

}  // namespace

bool is_clear(const MobileArm& body,
              const BodyJoints& q,
              std::span<const Solid> solids,
              const ArmPlanRules& rules) {
  const BodyFrames frames = body_frames(body, q);
  if (self_clearance(body, frames) < rules.own_margin) return false;
  for (std::size_t k = 0; k < kBodyLinks; ++k) {
    const LinkAxis link = link_axis(body, frames, static_cast<BodyLink>(k));
    for (const Solid& solid : solids) {
      if (nearest(link, solid).distance < rules.margin) return false;
    }
  }
  return true;
}

bool is_clear(const MobileArm& body,
              const BodyJoints& from,
              const BodyJoints& to,
              std::span<const Solid> solids,
              const ArmPlanRules& rules) {
  const int parts =
      std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff() / rules.look)));
  for (int k = 0; k <= parts; ++k) {
    if (!is_clear(body, from + (to - from) * k / parts, solids, rules)) return false;
  }
  return true;
}

std::optional<std::vector<ArmJoints>> plan_arm(const MobileArm& body,
                                               const Pose2& base_W,
                                               const ArmJoints& from,
                                               const ArmJoints& to,
                                               std::span<const Solid> solids,
                                               std::uint64_t seed,
                                               const ArmPlanRules& rules) {
  const auto stands_clear = [&](const ArmJoints& q) {
    return is_clear(body, body_joints(base_W, q), solids, rules);
  };
  if (!stands_clear(from) || !stands_clear(to)) return std::nullopt;
  return ArmSearch(body, base_W, solids, rules, seed).find(from, to);
}

}  // namespace algo
