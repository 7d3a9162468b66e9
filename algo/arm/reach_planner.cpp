#include "algo/arm/reach_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "algo/arm/arm_inverse.hpp"
#include "algo/arm/elbow_circle.hpp"
#include "algo/arm/hand_path_planner.hpp"
#include "algo/grid_search.hpp"

namespace algo {
namespace {

constexpr double kStraightOn = 0.01;  // [rad] a smaller turn is left to the drive
constexpr double kNoWay = 1e-6;       // [m]
constexpr double kCheap = 0.6;        // [m] of room beyond which a cell costs no more
constexpr double kLeaves = 1e-3;      // [m] the way from the start may come nearer by this
constexpr double kDear = 3;           // that a cell without room costs more than one with it

constexpr double kBeside = 3;        // [m] of ground searched beyond start and goal
constexpr double kMostCells = 800;   // along a side of the grid: beyond, its cells grow
constexpr int kCellsBeside = 2;      // of a goal whose own cell has too little room
constexpr double kLeastRoom = 0.05;  // [m] that a base leaves which stands too near to something

/// True if the folded body has room all the way from `a` to `b`.
bool is_open(const FoldedBody& folded,
             const Vec2& a,
             const Vec2& b,
             std::span<const Solid> solids,
             const ReachRules& rules) {
  const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (rules.cell / 2))));
  for (int k = 0; k <= parts; ++k) {
    if (folded.room(a + (b - a) * k / parts, solids) < rules.base_margin) return false;
  }
  return true;
}

/// The folded base's grid about start and goal.
class BaseGrid {
 public:
  BaseGrid(const MobileArm& body,
           const Vec2& from,
           const Vec2& to,
           std::span<const Solid> solids,
           const ReachRules& rules)
      : folded_(body), solids_(solids), rules_(rules) {
    const double half = std::max(rules.room, (to - from).norm() / 2 + kBeside);
    cell_ = std::max(rules.cell, 2 * half / kMostCells);
    cells_ = static_cast<int>(std::ceil(2 * half / cell_));
    corner_ = (from + to) / 2 - Vec2::Constant(half);
    costs_.reserve(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_));
    for (int row = 0; row < cells_; ++row) {
      for (int column = 0; column < cells_; ++column) {
        const double room = folded_.room(centre({column, row}), solids);
        const double tight = std::clamp(1 - room / kCheap, 0.0, 1.0);
        costs_.push_back(room < rules.base_margin ? CostGrid::kBlocked
                                                  : static_cast<float>(1 + kDear * tight));
      }
    }
    search_.resize(costs_.size());
  }

  /// Points from `from` to `to`, both included; none if there is no way.
  std::optional<std::vector<Vec2>> way(const Vec2& from, const Vec2& to) {
    const CostGrid grid{cells_, cells_, costs_};
    const std::optional<GridCell> goal = cell_beside(grid, to);
    if (!goal) return std::nullopt;
    if (!search_.find(grid, cell_of(from), *goal)) {
      costs_[grid.index(*goal)] = CostGrid::kBlocked;  // many places share a cell: ask for it once
      return std::nullopt;
    }
    std::vector<Vec2> points{from};
    for (const GridCell& cell : search_.path()) points.push_back(centre(cell));
    points.push_back(to);
    return points;
  }

 private:
  Vec2 centre(GridCell c) const { return corner_ + cell_ * Vec2(c.column + 0.5, c.row + 0.5); }
  GridCell cell_of(const Vec2& p) const {
    const Vec2 at = (p - corner_) / cell_;
    return {whole_below(at.x()), whole_below(at.y())};
  }
  /// The cell of `p`, or the nearest from which the straight way to it is free.
  std::optional<GridCell> cell_beside(const CostGrid& grid, const Vec2& p) const {
    const GridCell own = cell_of(p);
    if (!grid.blocked(own)) return own;
    std::optional<GridCell> best;
    double least = std::numeric_limits<double>::infinity();
    for (int row = own.row - kCellsBeside; row <= own.row + kCellsBeside; ++row) {
      for (int column = own.column - kCellsBeside; column <= own.column + kCellsBeside; ++column) {
        const GridCell cell{column, row};
        const double away = (centre(cell) - p).norm();
        if (away >= least || grid.blocked(cell)) continue;
        if (!is_open(folded_, centre(cell), p, solids_, rules_)) continue;
        best = cell;
        least = away;
      }
    }
    return best;
  }

  FoldedBody folded_;
  std::span<const Solid> solids_;
  ReachRules rules_;
  int cells_ = 0;
  double cell_ = 0;
  Vec2 corner_ = Vec2::Zero();
  std::vector<float> costs_{};
  GridSearch search_{};
};

/// Straightens `points` where the folded body has room.
std::vector<Vec2> straightened(const MobileArm& body,
                               const std::vector<Vec2>& points,
                               std::span<const Solid> solids,
                               const ReachRules& rules) {
  const FoldedBody folded(body);
  std::vector<Vec2> out{points.front()};
  for (std::size_t i = 0; i + 1 < points.size();) {
    std::size_t far = i + 1;
    for (std::size_t k = points.size() - 1; k > i + 1; --k) {
      if (is_open(folded, points[i], points[k], solids, rules)) {
        far = k;
        break;
      }
    }
    out.push_back(points[far]);
    i = far;
  }
  return out;
}

/// A plan that grows leg by leg.
class Legs {
 public:
  explicit Legs(const BodyJoints& start) : last_(start) {}

  void turn(double heading) {
    const double way = wrap_angle(heading - last_[2]);
    if (std::abs(way) < kStraightOn) return;
    BodyJoints to = last_;
    to[2] += way;
    add(ReachLeg::Kind::Turn, to, 1);
  }
  /// Straight to `point_W`, after a turn towards it.
  void drive(const Vec2& point_W, double spacing) {
    const Vec2 way = point_W - last_.head<2>();
    if (way.norm() < kNoWay) return;
    turn(std::atan2(way.y(), way.x()));
    BodyJoints to = last_;
    to.head<2>() = point_W;
    add(ReachLeg::Kind::Drive, to, static_cast<int>(std::ceil(way.norm() / spacing)));
  }
  void arm(const std::vector<ArmJoints>& way, double stride) {
    ReachLeg leg{ReachLeg::Kind::Arm, {last_}};
    for (const ArmJoints& q : way) {
      BodyJoints to = last_;
      to.tail<static_cast<int>(kArmJoints)>() = q;
      const double longest =
          (to - last_).tail<static_cast<int>(kArmJoints)>().cwiseAbs().maxCoeff();
      append(leg, to, static_cast<int>(std::ceil(longest / stride)));
    }
    if (leg.path.size() > 1) legs_.push_back(std::move(leg));
  }
  std::vector<ReachLeg> done() { return std::move(legs_); }

 private:
  void append(ReachLeg& leg, const BodyJoints& to, int parts) {
    const BodyJoints from = last_;
    for (int k = 1; k <= parts; ++k) leg.path.push_back(from + (to - from) * k / parts);
    if (parts > 0) last_ = to;
  }
  void add(ReachLeg::Kind kind, const BodyJoints& to, int parts) {
    ReachLeg leg{kind, {last_}};
    append(leg, to, parts);
    legs_.push_back(std::move(leg));
  }

  BodyJoints last_;
  std::vector<ReachLeg> legs_{};
};

std::vector<ReachLeg> legs_of(const BodyJoints& start,
                              const std::vector<ArmJoints>& fold,
                              const std::vector<Vec2>& corners,
                              const ReachPlace& place,
                              const std::vector<ArmJoints>& reach,
                              const ReachRules& rules) {
  Legs legs(start);
  legs.arm(fold, rules.arm.stride);
  for (const Vec2& corner : corners) legs.drive(corner, rules.spacing);
  legs.turn(place.base_W.heading);
  legs.arm(reach, rules.arm.stride);
  return legs.done();
}

/// Where the body stands nearer to something than `rules` allow, it may leave from there.
ArmPlanRules leaving(const MobileArm& body,
                     const BodyJoints& start,
                     std::span<const Solid> solids,
                     const ArmPlanRules& rules) {
  const BodyFrames frames = body_frames(body, start);
  const double room = clearance(body, frames, solids).smallest() - kLeaves;
  const double own_room = self_clearance(body, frames) - kLeaves;
  ArmPlanRules nearer = rules;
  nearer.margin = std::min(rules.margin, std::max(room, rules.margin / 2));
  nearer.own_margin = std::min(rules.own_margin, std::max(own_room, 0.0));
  return nearer;
}

/// The same of the base on its way.
ReachRules base_leaving(const MobileArm& body,
                        const Vec2& from,
                        std::span<const Solid> solids,
                        ReachRules rules) {
  const double room = FoldedBody(body).room(from, solids) - kLeaves;
  rules.base_margin = std::min(rules.base_margin, std::max(room, kLeastRoom));
  return rules;
}

ReachPlan no_plan(std::string why) {
  ReachPlan plan;
  plan.why = std::move(why);
  return plan;
}

/// Why the hand gets to `hand_W` from no place of the base, or not from `base_W`.
std::optional<std::string> out_of_reach(const MobileArm& body,
                                        const Pose3& hand_W,
                                        const std::optional<Pose2>& base_W) {
  const BodyFrames frames =
      body_frames(body, body_joints(base_W.value_or(Pose2{}), ArmJoints::Zero()));
  Pose3 in_shoulder = frames.arm_W.front().inverse() * hand_W;
  if (!base_W) {  // where the wrist is straight above or below the shoulder, it is nearest
    const Vec3 wrist = in_shoulder.translation() - body.arm.hand * in_shoulder.linear().col(2);
    if (std::abs(wrist.z()) <= wrist_reach(body.arm).farthest) return std::nullopt;
    in_shoulder.translation() -= Vec3(wrist.x(), wrist.y(), 0);
  }
  return unreachable(body.arm, in_shoulder);
}

/// True if the hand can follow its path from `there`.
bool goes_on(const MobileArm& body, const BodyJoints& there, const ReachQuestion& question) {
  return !plan_hand_path(body, there, question.path_W, false, question.solids, question.rules)
              .path.empty();
}

}  // namespace

std::string_view name(ReachLeg::Kind kind) {
  switch (kind) {
    case ReachLeg::Kind::Arm:
      return "moves its arm";
    case ReachLeg::Kind::Turn:
      return "turns";
    case ReachLeg::Kind::Drive:
      return "drives";
    case ReachLeg::Kind::Follow:
      return "follows its path with the hand";
  }
  return "";
}

ReachPlan plan_reach(const MobileArm& body,
                     const BodyJoints& start,
                     const Pose3& hand_W,
                     std::span<const Solid> solids,
                     std::uint64_t seed,
                     const ReachRules& rules,
                     std::span<const Vec3> path_W) {
  const ArmPlanRules nearer = leaving(body, start, solids, rules.arm);
  if (!is_clear(body, start, solids, nearer)) {
    return no_plan("The robot stands too near to something to move its arm.");
  }
  const auto fold =
      plan_arm(body, base_of(start), arm_of(start), body.folded, solids, seed, nearer);
  if (!fold) return no_plan("The arm finds no way to fold itself at the start.");
  const Vec2 from = start.head<2>();
  std::vector<ReachPlace> places = reach_places(body, from, hand_W, solids, rules);
  if (places.empty()) {
    return no_plan("From no place of the base does the hand reach its goal clear of everything.");
  }
  const ReachRules driving = base_leaving(body, from, solids, rules);
  BaseGrid grid(body, from, hand_W.translation().head<2>(), solids, driving);
  int tried = 0;
  std::string why;
  std::ranges::rotate(places,
                      places.begin() + static_cast<std::ptrdiff_t>(rules.skip % places.size()));
  for (const ReachPlace& place : places) {
    if (tried == rules.places) break;
    const auto way = grid.way(from, place.base_W.position());
    if (!way) continue;
    ++tried;
    const auto reach = plan_arm(body, place.base_W, body.folded, place.q, solids, seed, rules.arm);
    if (!reach) continue;
    const BodyJoints there = body_joints(place.base_W, place.q);
    const HandPathPlan onwards = plan_hand_path(body, there, path_W, false, solids, rules);
    if (onwards.path.empty()) {
      why = onwards.why;
      continue;
    }
    return {.legs = legs_of(
                start, *fold, straightened(body, *way, solids, driving), place, *reach, rules)};
  }
  if (!why.empty()) return no_plan(std::move(why));
  return no_plan(tried > 0
                     ? "The arm finds no way between the obstacles to its goal."
                     : "The base finds no way to a place from which the hand reaches its goal.");
}

std::optional<ReachLeg> plan_last_reach(const MobileArm& body,
                                        const BodyJoints& now,
                                        const Pose3& hand_W,
                                        std::span<const Solid> solids,
                                        std::uint64_t seed,
                                        const ReachRules& rules) {
  const auto q = reaching_joints(body, base_of(now), hand_W, solids, rules.arm, rules.arm_angle);
  if (!q) return std::nullopt;
  const ArmPlanRules nearer = leaving(body, now, solids, rules.arm);
  const auto way = plan_arm(body, base_of(now), arm_of(now), *q, solids, seed, nearer);
  if (!way) return std::nullopt;
  Legs legs(now);
  legs.arm(*way, rules.arm.stride);
  std::vector<ReachLeg> one = legs.done();
  if (one.empty()) return std::nullopt;
  return std::move(one.front());
}

ReachPlan plan_return(const MobileArm& body,
                      const BodyJoints& start,
                      const SetGoal& goal,
                      std::span<const Solid> solids,
                      std::uint64_t seed,
                      const ReachRules& rules) {
  const ArmPlanRules nearer = leaving(body, start, solids, rules.arm);
  const auto fold =
      plan_arm(body, base_of(start), arm_of(start), body.folded, solids, seed, nearer);
  if (!fold) return no_plan("The arm finds no way to fold itself where the base stands.");
  const Vec2 from = start.head<2>();
  const ReachRules driving = base_leaving(body, from, solids, rules);
  BaseGrid grid(body, from, goal.position_W, solids, driving);
  const auto way = grid.way(from, goal.position_W);
  if (!way) return no_plan("The base finds no way to its goal.");
  Legs legs(start);
  legs.arm(*fold, rules.arm.stride);
  for (const Vec2& corner : straightened(body, *way, solids, driving)) {
    legs.drive(corner, rules.spacing);
  }
  if (goal.heading) legs.turn(*goal.heading);
  return {.legs = legs.done()};
}

ReachPlan plan_carry(const BodyJoints& start, const SetGoal& goal, const ReachRules& rules) {
  Legs legs(start);
  legs.drive(goal.position_W, rules.spacing);
  if (goal.heading) legs.turn(*goal.heading);
  std::vector<ReachLeg> all = legs.done();
  if (all.empty()) all.push_back({ReachLeg::Kind::Turn, {start, start}});  // it is there
  return {.legs = std::move(all)};
}

ReachPlan answer(const MobileArm& body, const ReachQuestion& question) {
  if (question.kind == ReachQuestion::Kind::Carry) {
    return plan_carry(question.now, question.base_goal, question.rules);
  }
  if (question.kind == ReachQuestion::Kind::Return) {
    return plan_return(
        body, question.now, question.base_goal, question.solids, question.seed, question.rules);
  }
  if (question.kind == ReachQuestion::Kind::Follow) {
    HandPathPlan found = plan_hand_path(
        body, question.now, question.path_W, question.base_stays, question.solids, question.rules);
    if (found.path.empty()) return no_plan(std::move(found.why));
    return {.legs = {{ReachLeg::Kind::Follow, std::move(found.path)}}};
  }
  const bool stays = question.kind == ReachQuestion::Kind::Last;
  const auto place = stays ? std::optional(base_of(question.now)) : std::nullopt;
  if (auto why = out_of_reach(body, question.hand_W, place)) return no_plan(std::move(*why));
  if (stays || question.rules.here_first) {
    auto last = plan_last_reach(
        body, question.now, question.hand_W, question.solids, question.seed, question.rules);
    if (last && (stays || goes_on(body, last->path.back(), question))) {
      return {.legs = {std::move(*last)}};
    }
  }
  if (stays) return no_plan("From where the base stands, the hand does not get to its goal.");
  return plan_reach(body,
                    question.now,
                    question.hand_W,
                    question.solids,
                    question.seed,
                    question.rules,
                    question.path_W);
}

}  // namespace algo
