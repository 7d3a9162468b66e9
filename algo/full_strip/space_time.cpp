// algo/full_strip/space_time.cpp: the levels, the bins, and the best few states.
#include "algo/full_strip/space_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace algo {
namespace {

constexpr std::size_t kBeam = 60;  // states kept per level
constexpr std::array<double, 11> kLevels{0.2, 0.3, 0.3, 0.4, 0.4, 0.4, 0.4, 0.5, 0.5, 0.5, 0.5};
constexpr double kHorizon = std::accumulate(kLevels.begin(), kLevels.end(), 0.0);  // [s]
constexpr double kSubstep = 0.1;                                                   // [s]
constexpr double kInstant = 1e-6;                              // [s] rounding of times
constexpr std::array<double, 5> kSpeeds{1, 0.5, 0, -0.5, -1};  // of the top speed, falling
constexpr std::array<double, 5> kTurns{1, 0.4, 0, -0.4, -1};   // of the top turn rate, falling
constexpr std::size_t kCommands = kSpeeds.size() * kTurns.size();
constexpr double kMargin = 0.08;           // [m] from moving obstacles, at present
constexpr double kMarginPerSecond = 0.25;  // since they may turn
constexpr double kStaticMargin = 0.03;     // [m] from static obstacles,
constexpr double kStaticFloor = 0.02;      // [m] below which only a way out counts
constexpr double kStaticSlack = 0.002;     // [m] by which a position may be nearer than the last
constexpr double kTimePerMetre = 0.6;      // [s/m] to the goal
constexpr double kRiskReach = 0.25;        // [m] room beyond the margin that lowers the risk,
constexpr double kRiskTime = 0.5;          // [s] plus the distance that both drive in this time
constexpr double kRisk = 3;                // [s/s] at zero room
constexpr double kTouch = 3;               // [s/s] more at zero room: it may be touched,
constexpr double kTouchReach = 0.1;        // [m] of room in which that falls to 1/e,
constexpr double kTouchPerSecond = 0.1;    // [m/s] and more, the farther the prediction
constexpr double kRiskFades = 2.5;         // [s] prediction time after which a risk counts 1/e
constexpr double kReverse = 0.15;          // [s/s] for driving into where no scanner looks
constexpr double kReach = 6.0;             // [m] tracks farther than this are ignored
constexpr double kCloser = 0.3;            // of the margins, if nothing else is clear
constexpr double kRests = 0.05;            // [m/s] below it the robot counts as at rest
constexpr double kTouched = 5;             // [s/s] for being touched at rest
constexpr double kSwerveRoom = 0.03;   // [m] of a moving obstacle beside its prediction at once,
constexpr double kSwerve = 0.5;        // [m/s] and more with time: 98 % of recorded people
constexpr int kTurnSeen = 2;           // substeps until the robot brakes for a turn
constexpr double kLacking = 5;         // [s/m] of room that lacks on the way to rest
constexpr double kBetter = 0.1;        // [s] by which a motion must be cheaper than the present
constexpr double kInterrupted = 0.25;  // [s] without a search after which its motion is dropped
constexpr double kHeld = 1.5;          // [s] of the candidate motions if none is clear
constexpr double kLater = 0.02;        // [m] bonus in room for every later substep
constexpr double kTouchedFast = 10;    // [m] of room that a touch costs, and more with speed
constexpr std::size_t kBins = 1 << 16;

Twist2 command(std::size_t index, const MotionLimits& limits) {
  return {kSpeeds[index / kTurns.size()] * limits.max_v,
          kTurns[index % kTurns.size()] * limits.max_omega};
}

/// The level of a plan that runs `since` [s] after its start.
std::size_t level_at(double since) {
  std::size_t level = 0;
  for (double end = kLevels[0]; level + 1 < kLevels.size() && since > end - kInstant;) {
    end += kLevels[++level];
  }
  return level;
}

/// [m] Distance from the hull to `p` (in R).
double to_hull(const RobotSpec& spec, const Vec2& p) {
  if (spec.half_length <= 0) return p.norm() - spec.radius;
  const double dx = std::max(0.0, std::abs(p.x()) - spec.half_length);
  const double dy = std::max(0.0, std::abs(p.y()) - spec.half_width);
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

SpaceTimeSearch::SpaceTimeSearch() : bins_(kBins), bin_round_(kBins) {
  static_assert(kLevels.size() == kLevelCount);
  stops_.resize(kCommands);
  lacks_.resize(kCommands);
  states_.reserve(kBeam * kCommands);
  next_.reserve(kBeam * kCommands);
  order_.reserve(kBeam * kCommands);
  movers_.reserve(64);
}

void SpaceTimeSearch::reset() {
  plan_since_ = kNoPlan;
  searched_at_ = kNoPlan;
}

/// True if it searched in one of the last ticks.
bool SpaceTimeSearch::goes_on(const SpaceTimeInput& in) const {
  return searched_at_ >= 0 && in.stamp - searched_at_ < kInterrupted;
}

bool SpaceTimeSearch::needed(const SpaceTimeInput& in, const NodeStrip& strip) const {
  constexpr double kStep = 0.25;    // [s]
  constexpr int kSteps = 16;        // 4 s
  constexpr double kNear = 0.5;     // [m] sufficient room,
  constexpr double kMore = 0.25;    // [m] and more once it drives,
  constexpr double kSpread = 0.15;  // [m/s] and more, the farther the prediction
  const double room = goes_on(in) ? kNear + kMore : kNear;
  const Recycled<Node>& nodes = strip.nodes();
  for (const Track& track : *in.tracks) {
    for (int k = 0; k <= kSteps; ++k) {
      const double time = k * kStep;
      const Vec2 at_W = track.position_W + track.velocity_W * time;
      const double reach = track.radius + in.spec->radius + room + kSpread * time;
      const auto near = [&](const Vec2& p_W) { return (p_W - at_W).squaredNorm() < reach * reach; };
      if (near(in.state.pose_W.position())) return true;
      // Anywhere on the strip that the robot may have reached by then.
      const double way = in.limits.max_v * time + NodeStrip::kSpacing;
      const auto end = std::min(nodes.size(), static_cast<std::size_t>(way / NodeStrip::kSpacing));
      for (std::size_t i = 0; i < end; i += 2) {
        if (near(nodes[i].position_W)) return true;
      }
    }
  }
  return false;
}

/// The tracks that the robot may meet.
void SpaceTimeSearch::gather(const SpaceTimeInput& in) {
  movers_.clear();
  const Vec2 here = in.state.pose_W.position();
  for (const Track& track : *in.tracks) {
    const double speed = track.velocity_W.norm();
    if ((track.position_W - here).norm() >= kReach + 4 * speed) continue;
    movers_.push_back({.position_W = track.position_W + track.velocity_W * in.lead,
                       .velocity_W = track.velocity_W,
                       .radius = track.radius,
                       .speed = speed,
                       .turns = kSwerve + track.velocity_spread,
                       .off = kSwerveRoom + track.position_spread});
  }
  moving_ = movers_.size();
  if (in.standing == nullptr) return;
  for (const Track& track : *in.standing) {
    if ((track.position_W - here).norm() >= kReach) continue;
    movers_.push_back({.position_W = track.position_W,
                       .radius = track.radius,
                       .turns = kSwerve,
                       .off = kSwerveRoom});
  }
}

/// At `time` [s] after the start. Moving obstacles may turn towards the robot at any moment: the
/// faster the two are, the more room the robot needs to see it and to give way.
SpaceTimeSearch::Nearness SpaceTimeSearch::nearness(const SpaceTimeInput& in,
                                                    double time,
                                                    const MotionState& at) const {
  const Vec2 ahead = direction(at.pose_W.heading);
  const double margin = margin_share_ * (kMargin + kMarginPerSecond * time);
  Nearness out{kReach, 0};
  for (std::size_t i = 0; i < moving_; ++i) {
    const Mover& mover = movers_[i];
    const double reach = kRiskReach + kRiskTime * (mover.speed + std::abs(at.twist.v));
    const Vec2 d = mover.position_W + mover.velocity_W * time - at.pose_W.position();
    const double most = reach + mover.radius + in.spec->radius + margin;
    if (d.squaredNorm() > most * most) continue;
    const Vec2 p{ahead.dot(d), cross(ahead, d)};
    const double room = to_hull(*in.spec, p) - mover.radius - margin;
    out.room = std::min(out.room, room);
    const double lacking = std::max(0.0, 1 - room / reach);
    const double soon = std::exp(-std::max(0.0, room) / (kTouchReach + kTouchPerSecond * time));
    out.risk = std::max(out.risk, kRisk * lacking * lacking + kTouch * soon);
  }
  return out;
}

/// Drives `s` on for one level. False on a collision.
bool SpaceTimeSearch::step(
    const SpaceTimeInput& in, double time, double length, const Twist2& twist, State& s) const {
  const auto substeps = static_cast<int>(std::lround(length / kSubstep));
  for (int k = 1; k <= substeps; ++k) {
    s.motion = advanced(s.motion, twist, in.limits, kSubstep);
    const double now = time + k * kSubstep;
    const Nearness near = nearness(in, now, s.motion);
    if (near.room < 0) {
      if (!may_rest_ || std::abs(s.motion.twist.v) > kRests) return false;
      s.touched = true;
      s.risk += kSubstep * kTouched;
    }
    if (in.map->distance(s.motion.pose_W.position()) < in.spec->radius + kStaticMargin &&
        in.hull->clearance(*in.map, s.motion.pose_W) < static_margin_) {
      return false;
    }
    s.risk += kSubstep * near.risk * std::exp(-now / kRiskFades);
    if (s.motion.twist.v < -0.05 && !in.looks_back) s.risk += kSubstep * kReverse;
  }
  return true;
}

/// Keeps the cheapest state of each bin of place, heading and speed; of these the best kBeam.
void SpaceTimeSearch::keep_best() {
  order_.resize(next_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
    return next_[a].cost != next_[b].cost ? next_[a].cost < next_[b].cost : a < b;
  });
  ++round_;
  states_.clear();
  for (const std::uint32_t i : order_) {
    const MotionState& m = next_[i].motion;
    const auto x =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(m.pose_W.x / 0.25)));
    const auto y =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(m.pose_W.y / 0.25)));
    const auto h =
        static_cast<std::uint32_t>(std::lround(m.pose_W.heading / (std::numbers::pi / 8)) & 15);
    const auto v = static_cast<std::uint32_t>(std::lround(m.twist.v / 0.5) & 15);
    const std::uint32_t key =
        (x * 73856093U) ^ (y * 19349663U) ^ (h * 83492791U) ^ (v * 2654435761U);
    const std::uint32_t bin = key % kBins;
    if (bin_round_[bin] == round_) continue;
    bin_round_[bin] = round_;
    states_.push_back(next_[i]);
    if (states_.size() == kBeam) break;
  }
}

double SpaceTimeSearch::cost(const SpaceTimeInput& in, const State& s) const {
  const Vec2 to = in.carrot_W - s.motion.pose_W.position();
  // A heading away from the direction to go costs a turn first.
  const double error = std::abs(wrap_angle(std::atan2(to.y(), to.x()) - s.motion.pose_W.heading));
  return s.risk + kTimePerMetre * (to.norm() + in.beyond) + 0.15 * error / in.limits.max_omega;
}

Twist2 SpaceTimeSearch::search(const SpaceTimeInput& in, Weighing& out) {
  if (!goes_on(in)) plan_since_ = kNoPlan;
  searched_at_ = in.stamp;
  gather(in);
  // Already too close to a static obstacle: come no closer.
  const double standing = in.hull->clearance(*in.map, in.state.pose_W) - kStaticSlack;
  static_margin_ = std::clamp(standing, kStaticFloor, kStaticMargin);
  static_room_ = std::min(kStaticFloor, standing);
  for (std::size_t c = 0; c < kCommands; ++c) {
    const Twist2 twist = command(c, in.limits);
    stops_[c] = stops_clear(in, twist) ? 1 : 0;
    lacks_[c] = lacking(in, twist);
  }
  if (attempt(in, true, out) || attempt(in, false, out)) return planned(in);
  plan_since_ = kNoPlan;
  return least_bad(in);
}

/// Searches with all the margins, or with a share of them; a robot at rest may then be touched. The
/// motion that it follows is kept unless the new one is better. False if there is none.
bool SpaceTimeSearch::attempt(const SpaceTimeInput& in, bool strict, Weighing& out) {
  margin_share_ = strict ? 1 : kCloser;
  may_rest_ = !strict;
  states_.assign(1, State{.motion = in.state});
  std::array<bool, kCommands> alive{};
  double time = 0;
  for (std::size_t level = 0; level < kLevels.size() && !states_.empty(); ++level) {
    next_.clear();
    for (const State& from : states_) expand(in, level, time, from);
    if (level == 0) {
      for (const State& s : next_) alive[s.way[0]] = true;
    }
    keep_best();
    time += kLevels[level];
  }
  const std::optional<State> present = follow_plan(in);
  bool found = present.has_value();
  clear_ = found && !present->touched;
  if (!states_.empty() && (!present || states_.front().cost < present->cost - kBetter)) {
    plan_ = states_.front().way;
    plan_since_ = in.stamp;
    clear_ = !states_.front().touched;
    found = true;
  }
  const Twist2 best = found ? planned(in) : Twist2{};
  out.candidates.clear();
  for (std::size_t c = 0; c < kCommands; ++c) {
    const Twist2 twist = command(c, in.limits);
    out.candidates.push_back({twist, kLevels[0], alive[c], found && twist == best});
  }
  return found;
}

/// Adds the states to which the commands lead from `from` within a level.
void SpaceTimeSearch::expand(const SpaceTimeInput& in,
                             std::size_t level,
                             double time,
                             const State& from) {
  // Commands beyond the speeds within reach lead to the same state.
  const double length = kLevels[level];
  const double dv = in.limits.acceleration * length;
  const double dw = in.limits.angular_acceleration * length;
  const Twist2& now = from.motion.twist;
  const auto same = [&](double a, double b, double at, double reach) {
    return std::clamp(a, at - reach, at + reach) == std::clamp(b, at - reach, at + reach);
  };
  Twist2 last{};
  for (std::size_t c = 0; c < kCommands; ++c) {
    const Twist2 twist = command(c, in.limits);
    const bool first_turn = c % kTurns.size() == 0;
    if (!first_turn && same(twist.omega, last.omega, now.omega, dw)) continue;
    last = twist;
    if (c >= kTurns.size() && same(twist.v, command(c - kTurns.size(), in.limits).v, now.v, dv)) {
      c += kTurns.size() - 1;
      continue;
    }
    if (level == 0 && stops_[c] == 0) continue;
    State s = from;
    s.way[level] = static_cast<std::uint8_t>(c);
    if (level == 0) s.risk = kLacking * lacks_[c];
    if (!step(in, time, length, twist, s)) continue;
    s.cost = cost(in, s);
    next_.push_back(s);
  }
}

/// The command of the motion that it follows, now.
Twist2 SpaceTimeSearch::planned(const SpaceTimeInput& in) const {
  return command(plan_[level_at(in.stamp - plan_since_)], in.limits);
}

/// The rest of the motion that it follows, its last command held to the end of the horizon; nothing
/// if it is no longer clear.
std::optional<SpaceTimeSearch::State> SpaceTimeSearch::follow_plan(const SpaceTimeInput& in) const {
  if (plan_since_ < 0) return std::nullopt;
  const Twist2 first = planned(in);
  if (!stops_clear(in, first)) return std::nullopt;
  State s{.motion = in.state, .risk = kLacking * lacking(in, first)};
  const double since = in.stamp - plan_since_;
  const int steps = static_cast<int>(std::lround(kHorizon / kSubstep));
  for (int k = 0; k < steps; ++k) {
    const double time = k * kSubstep;
    const Twist2 twist = command(plan_[level_at(since + time)], in.limits);
    if (!step(in, time, kSubstep, twist, s)) return std::nullopt;
  }
  s.cost = cost(in, s);
  return s;
}

/// True if `twist` for one step, then braking, keeps static_room_ from static obstacles.
bool SpaceTimeSearch::stops_clear(const SpaceTimeInput& in, const Twist2& twist) const {
  MotionState state = in.state;
  for (int k = 1; k * kSubstep <= kLevels[0]; ++k) {
    state = advanced(state, twist, in.limits, kSubstep);
    if (in.hull->clearance(*in.map, state.pose_W) < static_room_) return false;
  }
  return rests_clear(*in.map, *in.hull, state, in.limits, kSubstep, static_room_);
}

/// [m] Room that lacks between the robot and where a moving obstacle may turn, while the robot
/// brakes to rest after `twist`.
double SpaceTimeSearch::lacking(const SpaceTimeInput& in, const Twist2& twist) const {
  constexpr int kMost = 40;
  MotionState state = in.state;
  double most = 0;
  for (int k = 1; k <= kMost; ++k) {
    state = advanced(state, k <= kTurnSeen ? twist : Twist2{}, in.limits, kSubstep);
    if (std::abs(state.twist.v) < kRests) {
      if (k < kTurnSeen) continue;
      break;
    }
    const double time = k * kSubstep;
    const Vec2 ahead = direction(state.pose_W.heading);
    for (const Mover& mover : movers_) {
      const Vec2 d = mover.position_W + mover.velocity_W * time - state.pose_W.position();
      const double need = mover.radius + mover.off + mover.turns * time;
      const double reach = need + in.spec->radius;
      if (d.squaredNorm() > reach * reach) continue;
      const double along = ahead.dot(d);
      // Braking does not help against somebody who comes from behind.
      if (along * std::copysign(1.0, state.twist.v) < -in.spec->radius) continue;
      most = std::max(most, need - to_hull(*in.spec, {along, cross(ahead, d)}));
    }
  }
  return most;
}

/// The command that, held for a while, keeps the most room; if all are touched, the one that is
/// slowest then. Never drives into static obstacles for the sake of a predicted motion.
Twist2 SpaceTimeSearch::least_bad(const SpaceTimeInput& in) {
  margin_share_ = 0;
  Twist2 best{};
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < kCommands; ++c) {
    if (stops_[c] == 0) continue;
    const Twist2 twist = command(c, in.limits);
    MotionState state = in.state;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 1; k * kSubstep <= kHeld; ++k) {
      state = advanced(state, twist, in.limits, kSubstep);
      const double standing = in.hull->clearance(*in.map, state.pose_W);
      const double room = nearness(in, k * kSubstep, state).room;
      // Later approaches may still be avoided.
      const double later = kLater * k;
      if (room < 0) {
        least = later - kTouchedFast * (1 + std::abs(state.twist.v));
        break;
      }
      least = std::min(least, std::min(standing, room) + later);
    }
    if (least <= most) continue;
    most = least;
    best = twist;
  }
  return best;
}

}  // namespace algo
